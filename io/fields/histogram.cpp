#include "io/fields/histogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "io/fields/evenly_spread.h"
#include "io/fields/low_high.h"

namespace palpate::io {
namespace {

void check(const Bins& bins, const char* what) {
  if (bins.count < 1 || !(bins.high > bins.low)) {
    throw std::logic_error(std::string("histogram: the bins of the ") + what + " are empty");
  }
}

}  // namespace

int Bins::bin_of(double value) const noexcept {
  const double at = (value - low) / width();
  return at > 0 ? static_cast<int>(std::min(at, count - 1.0)) : 0;
}

JointHistogram joint_histogram(const Volume& volume, const GradientKernel& kernel, const Bins& values,
                               const Bins& magnitudes, const Progress& progress, int threads) {
  check(values, "values");
  check(magnitudes, "gradient magnitudes");
  JointHistogram all{values, magnitudes, {}, 0};
  all.counts.resize(static_cast<std::size_t>(values.count) * static_cast<std::size_t>(magnitudes.count));
  std::mutex adding;
  const auto count_block = [&](const Block& block, std::span<const glm::vec3> gradients) {
    std::vector<std::uint32_t> counts(all.counts.size());
    std::uint64_t voxels = 0;
    auto gradient = gradients.begin();
    for (int k = block.first.z; k < block.first.z + block.size.z; ++k) {
      for (int j = block.first.y; j < block.first.y + block.size.y; ++j) {
        for (int i = block.first.x; i < block.first.x + block.size.x; ++i, ++gradient) {
          const double value = volume.value_at(i, j, k);
          if (volume.is_padding(i, j, k) || !std::isfinite(value)) {
            continue;
          }
          const auto column = static_cast<std::size_t>(values.bin_of(value));
          const auto row = static_cast<std::size_t>(magnitudes.bin_of(static_cast<double>(glm::length(*gradient))));
          ++counts[row * static_cast<std::size_t>(values.count) + column];
          ++voxels;
        }
      }
    }
    const std::scoped_lock lock(adding);
    std::transform(counts.begin(), counts.end(), all.counts.begin(), all.counts.begin(),
                   [](std::uint32_t a, std::uint64_t b) { return a + b; });
    all.voxels += voxels;
  };
  kernel.for_each_block(count_block, progress, threads);
  return all;
}

LowHighHistogram low_high_histogram(const Volume& volume, const GradientKernel& kernel, const Bins& values,
                                    double least_magnitude, const Progress& progress, int threads) {
  return std::move(low_high_histograms(volume, kernel, values, std::array{least_magnitude}, progress, threads).front());
}

std::vector<LowHighHistogram> low_high_histograms(const Volume& volume, const GradientKernel& kernel,
                                                  const Bins& values, std::span<const double> least_magnitudes,
                                                  const Progress& progress, int threads, const EdgeUse& use) {
  check(values, "values");
  constexpr std::uint64_t enough_voxels = 1'000'000;  // far more than are needed to fill the bins
  const internal::EvenlySpread counted(volume.offset(0, 0, volume.geometry.dimensions.z), enough_voxels);
  const auto columns = static_cast<std::size_t>(values.count);
  std::vector<LowHighHistogram> all(least_magnitudes.size(), {values, std::vector<std::uint64_t>(columns * columns)});
  const double least_of_all = *std::min_element(least_magnitudes.begin(), least_magnitudes.end());
  struct Edge {
    std::size_t bin;
    double magnitude;
  };
  std::mutex adding;
  const auto count_block = [&](const Block& block, std::span<const glm::vec3> gradients) {
    std::vector<Edge> found;
    std::vector<CountedEdge> used;
    auto gradient = gradients.begin();
    for (int k = block.first.z; k < block.first.z + block.size.z; ++k) {
      for (int j = block.first.y; j < block.first.y + block.size.y; ++j) {
        std::uint64_t offset = volume.offset(block.first.x, j, k);
        for (int i = block.first.x; i < block.first.x + block.size.x; ++i, ++gradient, ++offset) {
          if (!counted.has(offset)) continue;
          const auto magnitude = static_cast<double>(glm::length(*gradient));
          if (!(magnitude > least_of_all) || volume.is_padding(i, j, k)) continue;
          const LowHigh sides = low_high_at(volume, {i, j, k}, Vec3(*gradient), kernel.scale_mm());
          const int low = values.bin_of(sides.low), high = values.bin_of(sides.high);
          found.push_back({static_cast<std::size_t>(high) * columns + static_cast<std::size_t>(low), magnitude});
          if (use && magnitude > least_magnitudes.front()) used.push_back({{i, j, k}, *gradient, low, high});
        }
      }
    }
    if (use) use(used);
    const std::scoped_lock lock(adding);
    for (std::size_t h = 0; h < all.size(); ++h) {
      for (const Edge& edge : found) {
        if (!(edge.magnitude > least_magnitudes[h])) continue;
        ++all[h].counts[edge.bin];
        ++all[h].voxels;
      }
    }
  };
  kernel.for_each_block(count_block, progress, threads);
  return all;
}

}  // namespace palpate::io
