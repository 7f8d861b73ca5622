#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace palpate::io {

/// The value at a fraction (0 to 1) of the way through the values in ascending order, the upper of two; 0 of none.
inline double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const auto at = std::min(static_cast<std::size_t>(fraction * static_cast<double>(values.size())), values.size() - 1);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

}  // namespace palpate::io
