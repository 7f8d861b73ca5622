#pragma once

/// A plan: what a scene needs on a scan and no more, with a list of what was left out and why. It is made outside the
/// tick, and the tick runs it.

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
  io::FieldSet field = io::FieldSet::none;     ///< the field, if a field was left out
  std::optional<std::size_t> mode = {};        ///< the index in the scene, if a mode was left out
  const solver::SolverType* solver = nullptr;  ///< the solver, if a solver was left out
  std::optional<io::SliceRange> slices = {};   ///< the slices of the scan, if slices were left out
};

/// Immutable once made: sessions share it between threads by pointer.
struct Plan {
  io::FieldSet fields = io::FieldSet::none;  ///< sampled once a sub-step
  std::vector<ActiveMode> modes;             ///< in the scene's order
  solver::SolverSet solvers;                 ///< the solvers that a tick of this scene can need
  double stiffness_n_per_m = 0;
  Workspace workspace;
  Subdivision subdivision;
  /// Structures whose distance is read, in the order of Sample::distance: indices in the scene's structures.
  std::vector<std::size_t> structures;
  std::array<bool, io::most_structures> holds_structure{};  ///< whether a surface follows its edge
  bool holds_iso_surface = false;                           ///< whether a surface mode needs the anchor (anchor.h)
  io::SliceRange slices;  ///< the slices whose fields are computed ahead and kept (reach.h); by default all
  std::vector<LeftOut> left_out;
};

/// "value", "gradient", "vector field", "Hessian", "low and high": the names of a plan's fields for people.
std::vector<std::string> names_of(io::FieldSet fields);

/// Throws std::invalid_argument, naming the key, if the scene is not valid. A mode that needs a field that the scan
/// lacks is left out, with that reason.
Plan make_plan(const Scene& scene, io::FieldSet available, const Workspace& workspace);

}  // namespace palpate::modes
