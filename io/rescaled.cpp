#include "io/rescaled.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace palpate::io {
namespace {

bool is_whole_number(double value) {
  return std::abs(value) < 1e9 && std::floor(value) == value;
}

template <typename To, typename From>
std::vector<To> rescale_all(std::vector<From> stored, double slope, double intercept) {
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
Volume::Voxels in_scan_unit(std::vector<Stored> stored, double slope, double intercept) {
  if constexpr (!std::is_same_v<Stored, float>) {
    if (is_whole_number(slope) && is_whole_number(intercept) && !stored.empty()) {
      const auto [low, high] = std::minmax_element(stored.begin(), stored.end());
      const auto [least, most] = std::minmax({slope * *low + intercept, slope * *high + intercept});
      using Limits = std::numeric_limits<std::int16_t>;
      if (least >= Limits::min() && most <= Limits::max()) {
        return rescale_all<std::int16_t>(std::move(stored), slope, intercept);
      }
    }
  }
  return rescale_all<float>(std::move(stored), slope, intercept);
}

}  // namespace

Volume rescaled(Volume volume) {
  if (volume.slope == 1 && volume.intercept == 0) return volume;
  volume.voxels = std::visit(
      [&](auto& stored) -> Volume::Voxels { return in_scan_unit(std::move(stored), volume.slope, volume.intercept); },
      volume.voxels);
  if (volume.padding) {
    const auto& [first, last] = *volume.padding;
    volume.padding = std::minmax({volume.slope * first + volume.intercept, volume.slope * last + volume.intercept});
  }
  volume.slope = 1;
  volume.intercept = 0;
  return volume;
}

}  // namespace palpate::io
