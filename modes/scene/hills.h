#pragma once

/// The hills of a curve: the ranges around its maxima.

#include <cstddef>
#include <span>
#include <vector>

namespace palpate::modes::internal {

/// Bins [first, end) belong to the hill; its top is one of them.
struct Hill {
  std::size_t first = 0, top = 0, end = 0;
};

/// The hills of a curve, in ascending order; together they cover it. Each hill's top is above the higher of its two
/// valleys by at least `prominence` of its height, and each holds at least `mass` of the sum. The least prominent hill
/// is merged into its neighbor until all satisfy this: persistence of the maxima of a function on a line (Edelsbrunner
/// and Harer, "Computational Topology", 2010).
std::vector<Hill> hills_of(std::span<const float> curve, double prominence, double mass);

}  // namespace palpate::modes::internal
