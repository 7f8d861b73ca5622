#include "modes/scene/faint_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::modes::internal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double bandwidth_of_range = 0.005, bandwidth_of_noise = 0.75;
constexpr double least_in_noise = 4;         // standard deviations between the two sides
constexpr double least_in_bandwidths = 3.5;  // two hills nearer than that are one
constexpr double steep_in_noise = 5;  // standard deviations of the gradient: noise is as steep in one voxel of 10^5
// A plate half a scale thick has this part of the steepest gradient of a step: w / (sigma sqrt(e)).
constexpr double part_of_thin = 0.3;
// A fraction of the voxels at boundaries between tissues. The ends of steep rises vary, which makes pairs of up to 3
// % that are not walls.
constexpr double wall_share = 0.04;
constexpr double air_below_hu = -900;

double steepest(double step, double scale_mm) {
  return step / (scale_mm * std::sqrt(2 * std::numbers::pi));
}

/// Bone has no typical value, and material as light as air is not part of a patient.
bool is_searched(const TissueHills& tissues, std::size_t t, bool is_ct) {
  if (!is_ct) return t > 0;
  return tissues.typical[t] > air_below_hu && tissues.typical[t] < least_bone_hu;
}

std::uint64_t edges_between(const io::LowHighHistogram& edges, const Hill& low, const Hill& high, int least_bins) {
  std::uint64_t count = 0;
  for (auto h = static_cast<int>(high.first); h < static_cast<int>(high.end); ++h) {
    for (auto l = static_cast<int>(low.first); l < std::min(static_cast<int>(low.end), h - least_bins); ++l) {
      count += edges.at(l, h);
    }
  }
  return count;
}

Tissue side_of(const Hill& hill, const io::Bins& values, double softness) {
  const auto at = [&](std::size_t bin) { return values.low + static_cast<double>(bin) * values.width(); };
  return {.name = {},
          .low = hill.first == 0 ? -infinity : at(hill.first),
          .high = hill.end == static_cast<std::size_t>(values.count) ? infinity : at(hill.end),
          .softness = softness};
}

}  // namespace

double least_gradient_of_walls(const ScanNoise& noise, double scale_mm) {
  const double bandwidth = bandwidth_of_range * (noise.spread().high - noise.spread().low);
  return std::max(part_of_thin * steepest(least_in_bandwidths * bandwidth, scale_mm),
                  steep_in_noise * noise.between({}).front().gradient);
}

std::vector<FaintWall> faint_walls(const io::LowHighHistogram& edges, const TissueHills& tissues,
                                   std::span<const Noise> noise, double range, double voxels_at_boundaries,
                                   bool is_ct) {
  std::vector<FaintWall> walls;
  for (std::size_t t = 0; t < tissues.hills.size(); ++t) {
    if (!is_searched(tissues, t, is_ct)) continue;
    const double bandwidth = std::max(bandwidth_of_range * range, bandwidth_of_noise * noise[t].value);
    const double least_step = std::max(least_in_bandwidths * bandwidth, least_in_noise * noise[t].value);
    const int least_bins = static_cast<int>(least_step / edges.values.width());
    const TissueHills parts =
        tissue_hills(edges, {static_cast<int>(tissues.hills[t].first), static_cast<int>(tissues.hills[t].end)},
                     least_bins, bandwidth, is_ct);
    for (std::size_t low = 0; low < parts.hills.size(); ++low) {
      for (std::size_t high = low + 1; high < parts.hills.size(); ++high) {
        const double step = parts.typical[high] - parts.typical[low];
        const double share =
            static_cast<double>(edges_between(edges, parts.hills[low], parts.hills[high], least_bins)) /
            std::max(voxels_at_boundaries, 1.0);
        // What lies at the tissue's limit is the partial volume of the next tissue.
        const io::Bins& values = edges.values;
        const auto limit = [&](std::size_t bin) { return values.low + static_cast<double>(bin) * values.width(); };
        const bool at_low_limit = t > 0 && parts.typical[low] - limit(tissues.hills[t].first) < 0.5 * step;
        const bool at_high_limit =
            t + 1 < tissues.hills.size() && limit(tissues.hills[t].end) - parts.typical[high] < 0.5 * step;
        if (step < least_step || share < wall_share || at_low_limit || at_high_limit) continue;
        walls.push_back({.within = t,
                         .low = parts.typical[low],
                         .high = parts.typical[high],
                         .low_side = side_of(parts.hills[low], edges.values, 0.1 * step),
                         .high_side = side_of(parts.hills[high], edges.values, 0.1 * step),
                         .share = share,
                         .noise_gradient = noise[t].gradient});
      }
    }
  }
  std::stable_sort(walls.begin(), walls.end(),
                   [](const FaintWall& a, const FaintWall& b) { return a.share > b.share; });
  return walls;
}

}  // namespace palpate::modes::internal
