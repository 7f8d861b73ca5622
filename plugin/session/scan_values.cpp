#include "plugin/session/scan_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace palpate::plugin {
namespace {

bool is_integer(double value) {
  return std::abs(value) < 1e9 && std::floor(value) == value;
}

template <typename To, typename From>
std::vector<To> rescaled(std::vector<From> stored, double slope, double intercept) {
  const auto rescale = [=](From v) { return static_cast<To>(slope * static_cast<double>(v) + intercept); };
  if constexpr (std::is_same_v<To, From>) {
    std::transform(stored.begin(), stored.end(), stored.begin(), rescale);
    return stored;
  } else {
    std::vector<To> values(stored.size());
    std::transform(stored.begin(), stored.end(), values.begin(), rescale);
    return values;
  }
}

template <typename Stored>
io::Volume::Voxels in_scan_unit(std::vector<Stored> stored, double slope, double intercept) {
  if constexpr (!std::is_same_v<Stored, float>) {
    if (is_integer(slope) && is_integer(intercept) && !stored.empty()) {
      const auto [low, high] = std::minmax_element(stored.begin(), stored.end());
      const auto [least, most] = std::minmax({slope * *low + intercept, slope * *high + intercept});
      using Limits = std::numeric_limits<std::int16_t>;
      if (least >= Limits::min() && most <= Limits::max()) {
        return rescaled<std::int16_t>(std::move(stored), slope, intercept);
      }
    }
  }
  return rescaled<float>(std::move(stored), slope, intercept);
}

}  // namespace

io::Volume scan_values(io::Volume volume) {
  if (volume.slope == 1 && volume.intercept == 0) return volume;
  volume.voxels = std::visit(
      [&](auto& stored) -> io::Volume::Voxels {
        return in_scan_unit(std::move(stored), volume.slope, volume.intercept);
      },
      volume.voxels);
  if (volume.padding) {
    const auto& [first, last] = *volume.padding;
    volume.padding = std::minmax({volume.slope * first + volume.intercept, volume.slope * last + volume.intercept});
  }
  volume.slope = 1;
  volume.intercept = 0;
  return volume;
}

}  // namespace palpate::plugin
