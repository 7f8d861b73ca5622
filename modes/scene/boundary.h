#pragma once

/// A boundary as a pair of tissues, from and to: the gates that select places between these two, and the side that
/// resists.

#include <array>

#include "modes/scene/scene.h"

namespace palpate::modes {

/// 1 within the tissue's range, 0 beyond its soft ends, linear in between; an infinite end has no limit.
TransferFunction gate_of(const Tissue& tissue);

struct Boundary {
  std::array<Gate, 2> gates;   ///< of low and of high: the values on both sides have to be those of the two tissues
  Side side = Side::entering;  ///< entering if `to` has the higher values
};
Boundary boundary_between(const Tissue& from, const Tissue& to);

}  // namespace palpate::modes
