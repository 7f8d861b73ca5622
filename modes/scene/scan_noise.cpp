#include "modes/scene/scan_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>

#include "io/fields/evenly_spread.h"
#include "io/parallel.h"
#include "io/quantile.h"

namespace palpate::modes::internal {
namespace {

constexpr double outer_share = 1e-3;         // of the values on each side that do not count for the range
constexpr double median_difference = 0.954;  // of |a - b|, in standard deviations of Gaussian noise
// The flattest tenth is taken for noise, so that a thin tissue, all of which is near an edge, has not the edge's
// gradient. In standard deviations of a component: the square root of chi squared of three at 0.1.
constexpr double flattest = 0.1, flattest_magnitude = 0.764;
constexpr std::uint64_t enough_values = 500'000, enough_gradients = 20'000;

bool counts(const io::Volume& volume, int i, int j, int k) {
  return !volume.is_padding(i, j, k) && std::isfinite(volume.value_at(i, j, k));
}

/// What some voxels of a slice, or of many, tell.
struct Found {
  std::vector<double> values, differences;
  std::vector<glm::dvec2> pairs, gradients;

  void add(const Found& other) {
    const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
    append(values, other.values);
    append(differences, other.differences);
    append(pairs, other.pairs);
    append(gradients, other.gradients);
  }
};

/// Reads the chosen voxels of a scan, slice by slice.
class Reader {
 public:
  Reader(const io::Volume& volume, const io::GradientKernel& kernel)
      : volume_(volume),
        kernel_(kernel),
        for_values_(volume.offset(0, 0, volume.geometry.dimensions.z), enough_values),
        for_gradients_(volume.offset(0, 0, volume.geometry.dimensions.z), enough_gradients),
        apart_(std::max(1, static_cast<int>(std::lround(2 * kernel.scale_mm() / volume.geometry.spacing_i)))) {}

  void read_slice(int k, Found& found) const {
    const glm::ivec3& size = volume_.geometry.dimensions;
    std::uint64_t offset = volume_.offset(0, 0, k);
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i, ++offset) {
        if (for_values_.has(offset) && counts(volume_, i, j, k)) read_value(i, j, k, found);
        if (for_gradients_.has(offset) && counts(volume_, i, j, k)) read_gradient(i, j, k, found);
      }
    }
  }

 private:
  void read_value(int i, int j, int k, Found& found) const {
    const double value = volume_.value_at(i, j, k);
    found.values.push_back(value);
    if (i > 0 && !volume_.is_padding(i - 1, j, k)) {
      const double difference = std::abs(value - volume_.value_at(i - 1, j, k));
      if (difference > 0) {  // a background that was cut off at one value says nothing about noise
        found.differences.push_back(difference);
      }
    }
    if (i >= apart_ && counts(volume_, i - apart_, j, k)) {
      found.pairs.emplace_back(value, volume_.value_at(i - apart_, j, k));
    }
  }

  void read_gradient(int i, int j, int k, Found& found) const {
    std::array<glm::vec3, 1> gradient{};
    kernel_.at_cell({{i, j, k}, {1, 1, 1}}, gradient);
    const auto magnitude = static_cast<double>(glm::length(gradient[0]));
    if (std::isfinite(magnitude)) found.gradients.emplace_back(volume_.value_at(i, j, k), magnitude);
  }

  const io::Volume& volume_;
  const io::GradientKernel& kernel_;
  io::internal::EvenlySpread for_values_, for_gradients_;
  int apart_;
};

}  // namespace

ScanNoise::ScanNoise(const io::Volume& volume, const io::GradientKernel& kernel, int threads) {
  const Reader reader(volume, kernel);
  std::vector<Found> slices(static_cast<std::size_t>(volume.geometry.dimensions.z));
  const auto read = [&](std::size_t k) { reader.read_slice(static_cast<int>(k), slices[k]); };
  io::internal::parallel_for(slices.size(), read, {}, threads);
  Found all;
  for (const Found& slice : slices) all.add(slice);
  spread_ = {io::quantile(all.values, outer_share), io::quantile(all.values, 1 - outer_share),
             io::quantile(std::move(all.differences), 0.5) / median_difference};
  pairs_ = std::move(all.pairs);
  gradients_ = std::move(all.gradients);
}

std::vector<Noise> ScanNoise::between(std::span<const double> limits) const {
  const auto range_of = [&](double value) {
    return static_cast<std::size_t>(std::upper_bound(limits.begin(), limits.end(), value) - limits.begin());
  };
  const double lowest = spread_.low;
  std::vector<std::vector<double>> differences(limits.size() + 1), magnitudes(limits.size() + 1);
  for (const glm::dvec2& pair : pairs_) {
    if (pair[0] > lowest && pair[1] > lowest && range_of(pair[0]) == range_of(pair[1])) {
      differences[range_of(pair[0])].push_back(std::abs(pair[0] - pair[1]));
    }
  }
  for (const glm::dvec2& one : gradients_) {
    if (one[0] > lowest) magnitudes[range_of(one[0])].push_back(one[1]);
  }
  std::vector<Noise> noise;
  for (std::size_t r = 0; r <= limits.size(); ++r) {
    noise.push_back({io::quantile(std::move(differences[r]), 0.5) / median_difference,
                     io::quantile(std::move(magnitudes[r]), flattest) / flattest_magnitude});
  }
  return noise;
}

}  // namespace palpate::modes::internal
