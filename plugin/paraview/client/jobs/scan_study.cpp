#include "plugin/paraview/client/jobs/scan_study.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "modes/scene/suggest.h"

namespace palpate::plugin {
namespace {

constexpr int bins = 128;

/// Least and greatest value of evenly spread voxels.
std::pair<double, double> range_of(const io::Volume& volume) {
  const glm::ivec3 size = volume.geometry.dimensions;
  const double voxels = static_cast<double>(size.x) * size.y * size.z;
  constexpr double looked_at = 200000;
  const int stride = std::max(1, static_cast<int>(std::cbrt(voxels / looked_at)));
  double low = 1e300, high = -1e300;
  for (int k = 0; k < size.z; k += stride) {
    for (int j = 0; j < size.y; j += stride) {
      for (int i = 0; i < size.x; i += stride) {
        if (volume.is_padding(i, j, k)) continue;
        const double value = volume.value_at(i, j, k);
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
  }
  if (!(low < high)) return {0, 1};
  return {low, high};
}

}  // namespace

ScanStudy study_scan(const std::shared_ptr<const io::Volume>& volume, const io::Progress& progress) {
  constexpr double suggesting = 0.6;  // of the work
  ScanStudy study;
  const modes::Scene found = modes::suggest(volume, [&](double done) { return progress(suggesting * done); }).scene;
  study.sites = std::make_shared<const modes::SiteMap>(volume);
  // The steps in a flow's speed are not boundaries.
  if (!found.modes.empty() && !volume->vectors) study.suggested = found;
  const auto [low, high] = range_of(*volume);
  const double scale_mm = io::default_gradient_scale_mm(volume->geometry);
  // At the middle of a step of the whole range, blurred by the Gaussian, it is as steep as this.
  const double steepest = (high - low) / (std::sqrt(2 * 3.14159265358979) * scale_mm);
  const io::JointHistogram joint =
      io::joint_histogram(*volume, io::GradientKernel(volume, scale_mm), {low, high, bins}, {0, steepest, bins},
                          [&](double done) { return progress(suggesting + (1 - suggesting) * done); });
  study.values = {joint.values, std::vector<double>(bins)};
  study.magnitudes = {joint.magnitudes, std::vector<double>(bins)};
  for (int m = 0; m < bins; ++m) {
    for (int v = 0; v < bins; ++v) {
      const auto count = static_cast<double>(joint.at(v, m));
      study.values.counts[static_cast<std::size_t>(v)] += count;
      study.magnitudes.counts[static_cast<std::size_t>(m)] += count;
    }
  }
  return study;
}

}  // namespace palpate::plugin
