#pragma once

/// The hills of a curve: where its counts gather.

#include <cstddef>
#include <span>
#include <vector>

namespace palpate::modes::internal {

/// Bins [first, end) belong to the hill; its top is one of them.
struct Hill {
  std::size_t first = 0, top = 0, end = 0;
};

/// The hills whose top stands out of the higher of its two valleys by at least `prominence` of its height, and which
/// hold at least `mass` of the sum, in ascending order; together they cover the whole curve. Source: persistence of the
/// maxima of a function on a line (Edelsbrunner and Harer, "Computational Topology", 2010), by merging the least
/// prominent hill into its neighbor until all stand out.
std::vector<Hill> hills_of(std::span<const float> curve, double prominence, double mass);

}  // namespace palpate::modes::internal
