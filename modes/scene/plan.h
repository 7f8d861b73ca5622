#pragma once

/// A plan: what a scene needs on a scan and no more, and in words what was left out. It is made outside the tick, and
/// the tick runs it.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/fields/field_options.h"
#include "io/fields/field_source.h"
#include "modes/scene/scene.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {

/// Something that was left out of a plan: never computed, kept in memory or called.
struct LeftOut {
  std::string what;                            ///< "friction", "Hessian", "exact solver", ...
  std::string why;                             ///< "strength is zero everywhere"
  std::string saves;                           ///< "one gradient a tick", ...
  io::FieldSet field = io::FieldSet::none;     ///< where it is a field: which
  std::optional<std::size_t> mode = {};        ///< where it is a mode: which of the scene's
  const solver::SolverType* solver = nullptr;  ///< where it is a solver: which
  std::optional<io::SliceRange> slices = {};   ///< where it is slices of the scan: which
};

/// Immutable once made: sessions share it between threads by pointer.
struct Plan {
  io::FieldSet fields = io::FieldSet::none;  ///< sampled once a sub-step
  std::vector<ActiveMode> modes;             ///< in the scene's order
  solver::SolverSet solvers;                 ///< those that a tick of this scene can need
  double stiffness_n_per_m = 0;
  Workspace workspace;
  Subdivision subdivision;
  /// Structures whose distance is read, in the order of Sample::distance: index in the scene's structures.
  std::vector<std::size_t> structures;
  std::array<bool, io::most_structures> holds_structure{};  ///< whether a surface is at that one's edge
  bool holds_iso_surface = false;                           ///< whether a surface mode needs the anchor (anchor.h)
  io::SliceRange slices;  ///< whose fields are computed ahead and kept (reach.h); by default all
  std::vector<LeftOut> left_out;
};

/// "value", "gradient", "vector field", "Hessian", "low and high": the names of a plan's fields for people.
std::vector<std::string> names_of(io::FieldSet fields);

/// Throws std::invalid_argument, naming the key, where the scene is not valid. A mode whose field the scan does not
/// have is left out, with that reason.
Plan make_plan(const Scene& scene, io::FieldSet available, const Workspace& workspace);

}  // namespace palpate::modes
