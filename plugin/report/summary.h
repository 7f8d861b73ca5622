#pragma once

/// The summary of a session, in numbers and in words.

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/fields/field_source.h"
#include "io/geometry.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"
#include "plugin/recording/recording.h"

namespace palpate::plugin {

/// A period of ticks in which one surface mainly held the proxy.
struct HeldStretch {
  std::size_t mode = 0;  ///< index into the scene's modes
  double begin_s = 0;
  double end_s = 0;
  glm::dvec3 contact_mm{0};  ///< the proxy at its start, patient space
  double value = 0;          ///< of the scan there
  double peak_n = 0;         ///< largest force of the coupling in it
  /// At 95 of 100 places the true boundary is within this of contact_mm (io/fields/boundary_uncertainty.h), mm. None if
  /// it was not requested or cannot be computed.
  std::optional<double> known_to_mm = std::nullopt;
};

/// The nearest approach of the proxy to a structure, or its greatest depth in it.
struct Approach {
  std::size_t structure = 0;  ///< index into the scene's structures
  double distance_mm = 0;     ///< the largest of the session; positive inside the structure
  double time_s = 0;          ///< the time of this distance
};

struct Percentiles {
  double median = 0, p99 = 0, p999 = 0, largest = 0;
};

struct Summary {
  double duration_s = 0;
  std::size_t ticks = 0;
  std::vector<ScanFrame> scan_frames;  ///< the felt frames of the series
  std::vector<HeldStretch> holds;
  std::vector<Approach> approaches;             ///< one for each structure of the scene
  std::vector<RegisteredStructure> registered;  ///< those placed on the scan by a registration
  double peak_sent_n = 0;
  std::array<std::size_t, 64> solver_ticks{};  ///< by solver::SolverType::number
  std::size_t capped = 0, refused = 0;         ///< ticks
  double largest_error_bound_m = 0;
  double largest_residual_m = 0;    ///< |residual| / k
  Percentiles tick_us;              ///< all stages together
  std::uint64_t missed = 0;         ///< deadlines that passed without a tick
  std::uint64_t lost = 0;           ///< ticks missing from the recording
  std::vector<std::string> faults;  ///< of the safety filter, in words
};

/// The total time of a tick, microseconds.
double tick_us(const TickRecord& tick);

Percentiles percentiles_of(std::vector<double> values);

Summary summarize(const Recording& recording, const modes::Plan& plan);

/// The uncertainty of a felt boundary's position at this place, mm. None if the source has no gradient, or if the value
/// does not rise there.
std::optional<double> known_to_mm(const io::FieldSource& source, const io::Geometry& geometry,
                                  const modes::Scene& scene, const glm::dvec3& place_mm);
/// "; known to 0.2 mm", or nothing.
std::string known_to_text(const std::optional<double>& mm);
/// Fills HeldStretch::known_to_mm.
void add_uncertainty(Summary& summary, const modes::Scene& scene, const io::FieldSource& source,
                     const io::Geometry& geometry);

/// The summary for people. `scan` describes the scan without naming the patient.
std::string to_text(const Summary& summary, const modes::Scene& scene, const std::string& scan,
                    const std::string& device);
std::string to_json(const Summary& summary, const modes::Scene& scene);

/// "2.1 mm from liver", "3.0 mm inside liver": `distance_mm` is positive inside.
std::string distance_in_words(double distance_mm, const std::string& structure);

/// The displayed name of a mode: its own name; without one, that of its structure, or its type.
std::string display_name(const modes::Scene& scene, std::size_t mode);
/// "L 12.3 P 4.0 H 88.1 mm"
std::string patient_coordinates(const glm::dvec3& position_mm);

}  // namespace palpate::plugin
