#include "modes/scene/scan_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>

#include "io/quantile.h"

namespace palpate::modes::internal {
namespace {

constexpr double outer_share = 1e-3;         // of the values on each side that do not count for the range
constexpr double median_difference = 0.954;  // of |a - b|, in standard deviations of Gaussian noise
// The flattest tenth is taken for noise, so that a thin tissue, all of which is near an edge, has not the edge's
// gradient. In standard deviations of a component: the square root of chi squared of three at 0.1.
constexpr double flattest = 0.1, flattest_magnitude = 0.764;
constexpr std::uint64_t enough_values = 500'000, enough_gradients = 20'000;

std::uint64_t voxels_of(const io::Volume& volume) {
  return volume.offset(0, 0, volume.geometry.dimensions.z);
}

bool counts(const io::Volume& volume, int i, int j, int k) {
  return !volume.is_padding(i, j, k) && std::isfinite(volume.value_at(i, j, k));
}

/// About `enough` voxels, evenly spread; hashed, as an even stride would fall into step with the rows.
template <typename Use>
void for_some_voxels(const io::Volume& volume, std::uint64_t enough, const Use& use) {
  const std::uint64_t stride = 1 + voxels_of(volume) / enough;
  const glm::ivec3& size = volume.geometry.dimensions;
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        const std::uint64_t hash = (volume.offset(i, j, k) * 0x9E3779B97F4A7C15U) >> 32U;
        if (hash % stride == 0 && counts(volume, i, j, k)) use(i, j, k);
      }
    }
  }
}

}  // namespace

Spread spread_of(const io::Volume& volume) {
  std::vector<double> values, differences;
  for_some_voxels(volume, enough_values, [&](int i, int j, int k) {
    values.push_back(volume.value_at(i, j, k));
    if (i > 0 && !volume.is_padding(i - 1, j, k)) {
      const double difference = std::abs(values.back() - volume.value_at(i - 1, j, k));
      if (difference > 0) {  // a background that was cut off at one value says nothing about noise
        differences.push_back(difference);
      }
    }
  });
  return {io::quantile(values, outer_share), io::quantile(values, 1 - outer_share),
          io::quantile(std::move(differences), 0.5) / median_difference};
}

std::vector<Noise> noise_between(const io::Volume& volume, const io::GradientKernel& kernel,
                                 std::span<const double> limits, double lowest) {
  const auto range_of = [&](double value) {
    return static_cast<std::size_t>(std::upper_bound(limits.begin(), limits.end(), value) - limits.begin());
  };
  const int apart = std::max(1, static_cast<int>(std::lround(2 * kernel.scale_mm() / volume.geometry.spacing_i)));
  std::vector<std::vector<double>> differences(limits.size() + 1), magnitudes(limits.size() + 1);
  for_some_voxels(volume, enough_values, [&](int i, int j, int k) {
    if (i < apart || !counts(volume, i - apart, j, k)) return;
    const double here = volume.value_at(i, j, k), there = volume.value_at(i - apart, j, k);
    if (here > lowest && there > lowest && range_of(here) == range_of(there)) {
      differences[range_of(here)].push_back(std::abs(here - there));
    }
  });
  for_some_voxels(volume, enough_gradients, [&](int i, int j, int k) {
    const double here = volume.value_at(i, j, k);
    std::array<glm::vec3, 1> gradient{};
    kernel.at_cell({{i, j, k}, {1, 1, 1}}, gradient);
    const auto magnitude = static_cast<double>(glm::length(gradient[0]));
    if (here > lowest && std::isfinite(magnitude)) magnitudes[range_of(here)].push_back(magnitude);
  });
  std::vector<Noise> noise;
  for (std::size_t r = 0; r <= limits.size(); ++r) {
    noise.push_back({io::quantile(std::move(differences[r]), 0.5) / median_difference,
                     io::quantile(std::move(magnitudes[r]), flattest) / flattest_magnitude});
  }
  return noise;
}

}  // namespace palpate::modes::internal
