#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace palpate::io {

/// The index of the quantile of a fraction (0 to 1) among `count` values in ascending order; the upper one if it lies
/// between two. Never beyond the last. `count` must be above 0.
inline std::size_t quantile_place(std::size_t count, double fraction) {
  return std::min(static_cast<std::size_t>(fraction * static_cast<double>(count)), count - 1);
}

/// The quantile of a fraction (0 to 1), such as 0.5 for the median; the upper value if it lies between two. 0 without
/// values.
inline double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(quantile_place(values.size(), fraction));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The same for values that are already in ascending order.
inline double quantile_of_sorted(std::span<const double> values, double fraction) {
  return values.empty() ? 0 : values[quantile_place(values.size(), fraction)];
}

}  // namespace palpate::io
