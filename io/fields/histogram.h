#pragma once

/// Counts how often each value of a scan occurs together with each gradient magnitude. Tissues are the bright
/// spots at low magnitude, boundaries the arches between two of them. Source: Kindlmann and Durkin, "Semi-automatic
/// generation of transfer functions for direct volume rendering", 1998.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "io/fields/gradient.h"

namespace palpate::io {

/// Bins of equal width over [low, high]. Values outside count in the first or last bin.
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
  std::uint64_t voxels = 0;           ///< that were counted: all but padding

  std::uint64_t at(int value_bin, int magnitude_bin) const noexcept {
    return counts[static_cast<std::size_t>(magnitude_bin) * static_cast<std::size_t>(values.count) +
                  static_cast<std::size_t>(value_bin)];
  }
};

/// Counts every voxel, block by block: no gradient of the whole volume is kept. `threads` 0: all cores; the counts do
/// not depend on them. Throws std::invalid_argument for empty bins, Cancelled.
JointHistogram joint_histogram(const Volume& volume, const GradientKernel& kernel, const Bins& values,
                               const Bins& magnitudes, const Progress& progress = {}, int threads = 0);

/// The pairs of values on the two sides of boundaries: how often each low occurs with each high (low_high.h).
struct LowHighHistogram {
  Bins values;                        ///< of low and of high, in the volume's unit
  std::vector<std::uint64_t> counts;  ///< low bins fastest
  std::uint64_t voxels = 0;           ///< that were counted

  std::uint64_t at(int low_bin, int high_bin) const noexcept {
    return counts[static_cast<std::size_t>(high_bin) * static_cast<std::size_t>(values.count) +
                  static_cast<std::size_t>(low_bin)];
  }
};

/// A voxel that a low-high histogram counts.
struct CountedEdge {
  glm::ivec3 voxel{0};
  glm::vec3 gradient{0};  ///< patient space, per mm
  int low = 0, high = 0;  ///< bins
};
/// Receives the edges above the first least magnitude, some at a time, in no fixed order. May be called by several
/// threads.
using EdgeUse = std::function<void(std::span<const CountedEdge>)>;

/// Counts the voxels whose gradient is steeper than the least magnitude (per mm), padding left out. Of a volume of more
/// than some millions of voxels an evenly spread part is counted. `threads` 0: all cores; the counts do not depend on
/// them. Throws std::invalid_argument for empty bins, Cancelled.
LowHighHistogram low_high_histogram(const Volume& volume, const GradientKernel& kernel, const Bins& values,
                                    double least_magnitude, const Progress& progress = {}, int threads = 0);
/// The same for several least magnitudes, in one pass over the volume: one histogram for each.
std::vector<LowHighHistogram> low_high_histograms(const Volume& volume, const GradientKernel& kernel,
                                                  const Bins& values, std::span<const double> least_magnitudes,
                                                  const Progress& progress = {}, int threads = 0,
                                                  const EdgeUse& use = {});

}  // namespace palpate::io
