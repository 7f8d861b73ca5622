#pragma once

/// Loops over a kernel's taps with a count known at compile time.

namespace palpate::io::internal {

/// The largest number of pairs in one pass: their weights and the sums should fit into registers. The first pass starts
/// the sums.
inline constexpr int most_at_once = 8;

/// Calls run<Count>(); Count is at most most_at_once.
template <int Most = most_at_once, typename Run>
[[gnu::always_inline]] inline void with_count(int count, const Run& run) {
  if constexpr (Most > 0) {
    if (count < Most) return with_count<Most - 1>(count, run);
  }
  run.template operator()<Most>();
}

/// Calls pass<Count, First>(done); `done` is the number of pairs done before.
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
