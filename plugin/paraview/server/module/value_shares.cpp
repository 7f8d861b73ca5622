#include "plugin/paraview/server/module/value_shares.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <memory>

#include "plugin/paraview/common/scan_store.h"

namespace palpate::plugin {
namespace {

constexpr int most_slices = 16;
constexpr std::int64_t most_values = 400'000;  // a percent of them is known to a fiftieth of itself

/// Appends every `stride`-th voxel of a slice.
void gather(const io::Volume& volume, int k, std::int64_t stride, std::vector<float>& values) {
  const glm::ivec3& size = volume.geometry.dimensions;
  for (std::int64_t n = 0; n < std::int64_t{size.x} * size.y; n += stride) {
    const int i = static_cast<int>(n % size.x);
    const int j = static_cast<int>(n / size.x);
    if (!volume.is_padding(i, j, k)) values.push_back(static_cast<float>(volume.value_at(i, j, k)));
  }
}

}  // namespace

std::vector<double> value_shares(const io::Series& series) {
  const auto whole = held_scan(series, 0);
  // A series joined from several ones has no slices of its own to read.
  const auto volume = whole || series.frames_per_position == 1 ? whole : load_scan(series, 0);
  const glm::ivec3& size = volume ? volume->geometry.dimensions : series.geometry.dimensions;
  const int slices = std::min(size.z, most_slices);
  // Odd, so that it does not fall in step with the columns.
  const std::int64_t stride = (std::int64_t{size.x} * size.y * slices / most_values) | 1;
  std::vector<float> values;
  for (int n = 0; n < slices; ++n) {
    const int k = static_cast<int>((2 * std::int64_t{n} + 1) * size.z / (2 * std::int64_t{slices}));
    if (volume) {
      gather(*volume, k, stride, values);
    } else {
      gather(*load_slice(series, k), 0, stride, values);
    }
  }
  if (values.empty()) return {};
  std::ranges::sort(values);
  std::vector<double> shares;
  for (std::size_t percent = 0; percent <= 100; ++percent) {
    shares.push_back(values[percent * (values.size() - 1) / 100]);
  }
  return shares;
}

std::optional<glm::ivec3> nearest_voxel(const io::Geometry& geometry, const glm::dvec3& place) {
  const glm::dvec3 index = geometry.to_index(place);
  const int below = static_cast<int>(std::floor(index.z));
  const bool in_gap = index.z != below && std::ranges::binary_search(geometry.gaps, below);
  const bool inside = geometry.contains(glm::round(index)) && !in_gap;
  return inside ? std::optional(glm::ivec3(glm::round(index))) : std::nullopt;
}

std::optional<double> nearest_value(const io::Volume& volume, const glm::dvec3& place) {
  const auto at = nearest_voxel(volume.geometry, place);
  if (!at || volume.is_padding(at->x, at->y, at->z)) return std::nullopt;
  return volume.value_at(at->x, at->y, at->z);
}

}  // namespace palpate::plugin
