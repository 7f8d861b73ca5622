#pragma once

/// Loops over a kernel's taps with counts that are known at compile time.

namespace palpate::io::internal {

/// The number of taps in one pass: as many as there are registers for their weights, so that the sums stay in
/// registers. The first pass starts the sums.
inline constexpr int most_at_once = 8;

/// Calls run<Count>() with a count of most_at_once at most.
template <int Most = most_at_once, typename Run>
[[gnu::always_inline]] inline void with_count(int count, const Run& run) {
  if constexpr (Most > 0) {
    if (count < Most) return with_count<Most - 1>(count, run);
  }
  run.template operator()<Most>();
}

/// Calls pass<Count, First>(done) with the pairs that are done.
template <typename Pass>
[[gnu::always_inline]] inline void in_passes(int count, const Pass& pass) {
  with_count(
      count, [&]<int Count>() __attribute__((always_inline)) { pass.template operator()<Count, true>(0); });
  for (int n = most_at_once; n < count; n += most_at_once) {
    with_count(
        count - n, [&]<int Count>() __attribute__((always_inline)) { pass.template operator()<Count, false>(n); });
  }
}

}  // namespace palpate::io::internal
