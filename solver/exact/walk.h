#pragma once

/// The walk down the energy to its minimum, from flat to flat: see exact.h.

#include "solver/exact/local.h"

namespace palpate::solver::internal {

/// Walks from walk.z to the minimum with at most `cap` evaluations; returns their number. Leaves z, the locked
/// primitives and the forces in `walk`.
int descend(Walk& walk, int cap);

}  // namespace palpate::solver::internal
