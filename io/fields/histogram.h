#pragma once

/// How often each value of a scan occurs together with each gradient magnitude. Tissues are bright spots at low
/// magnitude, boundaries are arches between two of them. Source: Kindlmann and Durkin, "Semi-automatic generation of
/// transfer functions for direct volume rendering", 1998.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "io/fields/gradient.h"

namespace palpate::io {

/// Bins of equal width over [low, high]; values outside count in the first or last bin.
struct Bins {
  double low = 0;
  double high = 1;
  int count = 1;

  double width() const noexcept { return (high - low) / count; }
  double middle(int bin) const noexcept { return low + (bin + 0.5) * width(); }
  int bin_of(double value) const noexcept;
};

struct JointHistogram {
  Bins values;                        ///< in the volume's unit
  Bins magnitudes;                    ///< of the gradient, per mm
  std::vector<std::uint64_t> counts;  ///< value bins fastest
  std::uint64_t voxels = 0;           ///< counted voxels: all except padding

  std::uint64_t at(int value_bin, int magnitude_bin) const noexcept {
    return counts[static_cast<std::size_t>(magnitude_bin) * static_cast<std::size_t>(values.count) +
                  static_cast<std::size_t>(value_bin)];
  }
};

/// Counts every voxel, block by block, so the gradients of the whole volume are never stored. `threads` 0: all cores;
/// the counts do not depend on their number. Throws std::invalid_argument for empty bins, and Cancelled.
JointHistogram joint_histogram(const Volume& volume, const GradientKernel& kernel, const Bins& values,
                               const Bins& magnitudes, const Progress& progress = {}, int threads = 0);

/// The pairs of values on the two sides of boundaries: how often each low occurs with each high (low_high.h).
struct LowHighHistogram {
  Bins values;                        ///< of low and of high, in the volume's unit
  std::vector<std::uint64_t> counts;  ///< low bins fastest
  std::uint64_t voxels = 0;           ///< counted voxels

  std::uint64_t at(int low_bin, int high_bin) const noexcept {
    return counts[static_cast<std::size_t>(high_bin) * static_cast<std::size_t>(values.count) +
                  static_cast<std::size_t>(low_bin)];
  }
};

/// A voxel counted in a low-high histogram.
struct CountedEdge {
  glm::ivec3 voxel{0};
  glm::vec3 gradient{0};  ///< patient space, per mm
  int low = 0, high = 0;  ///< bins
};
/// Receives the edges above the first of the least magnitudes in batches, in any order; several threads may call it.
using EdgeUse = std::function<void(std::span<const CountedEdge>)>;

/// Counts the voxels with a gradient above the least magnitude (per mm), except padding. Of a volume with more than
/// some millions of voxels, an evenly spread sample is counted. `threads` 0: all cores; the counts do not depend on
/// their number. Throws std::invalid_argument for empty bins, and Cancelled.
LowHighHistogram low_high_histogram(const Volume& volume, const GradientKernel& kernel, const Bins& values,
                                    double least_magnitude, const Progress& progress = {}, int threads = 0);
/// The same for several least magnitudes, in one pass over the volume: one histogram for each.
std::vector<LowHighHistogram> low_high_histograms(const Volume& volume, const GradientKernel& kernel,
                                                  const Bins& values, std::span<const double> least_magnitudes,
                                                  const Progress& progress = {}, int threads = 0,
                                                  const EdgeUse& use = {});

}  // namespace palpate::io
