#include "palpate/io/volume.h"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace palpate::io {

double Volume::value_at(int i, int j, int k) const noexcept {
  const std::size_t at = offset(i, j, k);
  return slope * std::visit([at](const auto& v) { return static_cast<double>(v[at]); }, voxels) + intercept;
}

bool Volume::is_padding(int i, int j, int k) const noexcept {
  if (!padding) return false;
  const std::size_t at = offset(i, j, k);
  const double stored = std::visit([at](const auto& v) { return static_cast<double>(v[at]); }, voxels);
  return stored >= padding->first && stored <= padding->second;
}

Statistics statistics(const Volume& volume) noexcept {
  return std::visit(
      [&](const auto& voxels) -> Statistics {
        if (voxels.empty()) return {};
        using Stored = typename std::decay_t<decltype(voxels)>::value_type;
        using Sum = std::conditional_t<std::is_integral_v<Stored>, std::int64_t, double>;
        constexpr bool exact = std::is_integral_v<Stored>;
        Stored low = std::numeric_limits<Stored>::max();
        Stored high = std::numeric_limits<Stored>::lowest();
        Sum sum = 0;
        std::uint64_t count = 0;
        for (const Stored v : voxels) {
          if constexpr (!exact) {
            if (volume.padding && v >= volume.padding->first && v <= volume.padding->second) continue;
            ++count;
          }
          low = std::min(low, v);
          high = std::max(high, v);
          sum += v;
        }
        if constexpr (exact) count = voxels.size();
        if (count == 0) return {};
        const double mean = static_cast<double>(sum) / static_cast<double>(count);
        const auto rescaled = [&](double stored) { return volume.slope * stored + volume.intercept; };
        const auto [minimum, maximum] = std::minmax({rescaled(low), rescaled(high)});  // a slope may be negative
        return {minimum, maximum, rescaled(mean), count};
      },
      volume.voxels);
}

Statistics merge(const Statistics& a, const Statistics& b) noexcept {
  if (a.count == 0) return b;
  if (b.count == 0) return a;
  const auto count = a.count + b.count;
  const double mean = a.mean + (b.mean - a.mean) * (static_cast<double>(b.count) / static_cast<double>(count));
  return {std::min(a.minimum, b.minimum), std::max(a.maximum, b.maximum), mean, count};
}

}  // namespace palpate::io
