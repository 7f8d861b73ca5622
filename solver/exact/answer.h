#pragma once

/// Makes a Solution from an answer relative to the probe.

#include "solver/exact/settle.h"
#include "solver/solution.h"

namespace palpate::solver::internal {

/// Rounds the proxy to doubles and adds the rounding to the bound.
inline void write_answer(const Balance& balance, const Settled& settled, Solution& solution) {
  const auto rounded = [](double probe, const DoubleDouble& z) {
    const DoubleDouble sum = two_sum(probe, z.hi);
    return sum.hi + (sum.lo + z.lo);
  };
  solution.proxy = {rounded(balance.probe.x, settled.z.x), rounded(balance.probe.y, settled.z.y),
                    rounded(balance.probe.z, settled.z.z)};
  const FineVec3 rounding = exact_difference(solution.proxy, balance.probe) - settled.z;
  solution.error_bound = (settled.bound.error + length_of(rounding.hi())) * (1 + 0x1p-48);
}

}  // namespace palpate::solver::internal
