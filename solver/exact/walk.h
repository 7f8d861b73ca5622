#pragma once

/// The way down the energy to its minimum, from flat to flat: see exact.h.

#include "solver/exact/local.h"

namespace palpate::solver::internal {

/// Walks from walk.z to the minimum, looking at most `cap` times; returns how often it looked. Leaves there z, what is
/// locked, and the forces.
int descend(Walk& walk, int cap);

}  // namespace palpate::solver::internal
