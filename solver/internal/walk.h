#pragma once

/// The way down the energy to its minimum, from flat to flat: see exact.h.

#include <cstdint>
#include <span>

#include "palpate/solver/internal/frame.h"
#include "palpate/solver/internal/placed.h"
#include "palpate/solver/internal/share.h"

namespace palpate::solver::internal {

struct Walk {
  std::span<const Placed> primitives;  ///< in general position: nowhere more of them meet than three planes do
  double stiffness = 0;                ///< k, N/m
  Vec3 pull{0};                        ///< the sum of the directed forces, N
  FineVec3 z;                          ///< m, relative to the probe: where the walk starts and ends
  Frame frame;                         ///< what is locked there
  double coarseness = 0;               ///< of what counts as met, relative to the distances from the probe
  std::span<Vec3> forces;              ///< out, N: each primitive's force on the proxy at the end
  std::span<Hold> hold;                ///< scratch
  std::span<std::uint32_t> met;        ///< scratch
};

/// Walks to the minimum, at most `cap` evaluations of all primitives; returns how many were needed.
int walk(Walk& state, int cap);

}  // namespace palpate::solver::internal
