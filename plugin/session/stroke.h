#pragma once

/// The force felt along a straight stroke, computed without a stylus: the probe itself moves at constant speed, one
/// tick a millisecond.

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/fields/field_source.h"
#include "modes/scene/plan.h"
#include "solver/primitive.h"
#include "solver/solution.h"

namespace palpate::plugin {

/// All vectors along patient axes (LPS); mm and N.
struct StrokePoint {
  glm::dvec3 position_mm{0};  ///< of the probe
  glm::dvec3 proxy_mm{0};
  glm::dvec3 force_n{0};
  double value = 0;                                       ///< of the scan at the proxy; NaN outside it
  std::array<double, io::most_structures> distance_mm{};  ///< of the proxy, from each of the plan's structures
  double value_passed = 0;                                ///< of the scan at the probe; NaN outside it
  const solver::SolverType* solver = nullptr;
  double error_bound_m = 0;
  std::optional<std::size_t> boundary;             ///< the scene's mode that pushes most, if any does
  std::optional<solver::PrimitiveType> primitive;  ///< the type of primitive that it pushes with; set if boundary is
};

/// What is read beside the forces: all of StrokePoint, or neither values nor distances.
enum class StrokeDetail { all, forces_alone };

/// Throws std::runtime_error if the stroke has no length or more than 10 000 000 ticks.
std::vector<StrokePoint> run_stroke(const modes::Plan& plan, const io::FieldSource& source, const glm::dvec3& from_mm,
                                    const glm::dvec3& to_mm, double speed_mm_per_s,
                                    StrokeDetail detail = StrokeDetail::all);

/// A stretch of the stroke in which one boundary holds the proxy back.
struct Contact {
  std::size_t boundary = 0;  ///< index into the scene's modes
  std::size_t first = 0;     ///< point at which the proxy was first held
  std::size_t last = 0;      ///< last point before it yielded or the proxy left it
  double peak_n = 0;
  double strength_n = 0;       ///< the largest force that it resists along this stretch and beyond its end
  double full_strength_n = 0;  ///< the largest force of its transfer function
};

/// N: a boundary that pushes less is not reported.
constexpr double met_n = 0.05;

/// The surfaces met along a stroke, in order: each stretch on which a surface mode pushes with more than threshold_n.
std::vector<Contact> contacts_of(std::span<const StrokePoint> stroke, const modes::Plan& plan, double threshold_n);
/// Fills strength_n and full_strength_n from what the boundary's mode reads at the proxy, and beyond the place where it
/// was last held (strength_ahead_n()).
void add_strengths(std::span<Contact> contacts, std::span<const StrokePoint> stroke, const modes::Plan& plan,
                   const io::FieldSource& source);
/// "; 0.31 of its 2.5 N: thin or faint there" if a boundary resists less than three quarters of its full strength.
std::string strength_to_text(const Contact& contact);
std::string strength_to_text(double strength_n, double full_strength_n);

}  // namespace palpate::plugin
