#include "io/fields/low_high.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/fields/cell.h"

namespace palpate::io {
namespace {

constexpr double scales_reached = 2.0;     // a step farther away adds little to a derivative of Gaussian
constexpr double steps_a_voxel = 2.5;      // of the profile: finer than what trilinear values can show
constexpr double least_of_steepest = 0.1;  // a rise ends here; or, earlier, where the next rise begins:
constexpr double lull = 0.3;               // it was below this part,
constexpr double rise_again = 0.2;         // and grows by this part
constexpr int most_steps = 32;             // on each side

/// Extent of a voxel along a direction, mm.
double extent_along(const Geometry& g, const Vec3& direction) noexcept {
  return std::abs(glm::dot(g.direction_i, direction)) * g.spacing_i +
         std::abs(glm::dot(g.direction_j, direction)) * g.spacing_j + std::abs(glm::dot(g.step, direction));
}

/// Values along a line through the voxel, from its first to its last sample that can be taken without a break.
struct Profile {
  std::array<double, 2 * most_steps + 1> values;
  int first = most_steps, last = most_steps;

  double& at(int n) noexcept { return values[static_cast<std::size_t>(n)]; }
  double at(int n) const noexcept { return values[static_cast<std::size_t>(n)]; }
};

Profile profile_of(const Volume& volume, const glm::ivec3& voxel, const Vec3& index_step, int steps) noexcept {
  Profile profile;
  profile.at(most_steps) = volume.value_at(voxel.x, voxel.y, voxel.z);
  const auto take = [&](int n) {
    internal::Cell cell;
    if (!internal::find_cell(volume, Vec3(voxel) + static_cast<double>(n) * index_step, cell)) {
      return false;
    }
    profile.at(most_steps + n) = internal::trilinear_value(volume, cell);
    return true;
  };
  for (int n = 1; n <= steps && take(n); ++n) {
    profile.last = most_steps + n;
  }
  for (int n = 1; n <= steps && take(-n); ++n) {
    profile.first = most_steps - n;
  }
  return profile;
}

}  // namespace

LowHigh low_high_at(const Volume& volume, const glm::ivec3& voxel, const Vec3& gradient, double scale_mm) noexcept {
  const auto own = static_cast<float>(volume.value_at(voxel.x, voxel.y, voxel.z));
  const double slope = glm::length(gradient);
  if (!(slope > 0) || !std::isfinite(slope)) {
    return {own, own};
  }
  const Geometry& g = volume.geometry;
  const Vec3 uphill = gradient / slope;
  const double extent = extent_along(g, uphill);
  const double reach = scales_reached * scale_mm + extent;
  const int steps = std::clamp(static_cast<int>(std::ceil(steps_a_voxel * reach / extent)), 1, most_steps);
  // The grid is treated as evenly spaced near the voxel. If slices are uneven, the profile bends a little but still
  // crosses the edge.
  const Vec3 middle = g.to_patient(voxel);
  const double step_mm = reach / steps;
  const Vec3 index_step = 0.5 * (g.to_index(middle + step_mm * uphill) - g.to_index(middle - step_mm * uphill));
  const Profile profile = profile_of(volume, voxel, index_step, steps);
  const auto rise = [&](int n) { return profile.at(n + 1) - profile.at(n); };
  int steepest = -1;
  double most = 0;
  for (int n = profile.first; n < profile.last; ++n) {
    const double away = (n + 0.5 - most_steps) / (steps + 1);
    const double nearness = (1 - away * away) * (1 - away * away);
    if (nearness * rise(n) > most) {
      most = nearness * rise(n);
      steepest = n;
    }
  }
  if (steepest < 0) {
    return {own, own};
  }
  // How many of the steps next to the steepest still belong to its rise.
  const auto followed = [&](int direction, int steps_there) {
    double least = rise(steepest);
    int least_at = 0;
    for (int n = 1; n <= steps_there; ++n) {
      const double here = rise(steepest + direction * n);
      if (here <= least_of_steepest * rise(steepest)) {
        return n - 1;
      }
      if (here < least) {
        least = here;
        least_at = n;
      } else if (least < lull * rise(steepest) && here > least + rise_again * rise(steepest)) {
        return least_at;
      }
    }
    return steps_there;
  };
  const int high = steepest + 1 + followed(1, profile.last - steepest - 1);
  const int low = steepest - followed(-1, steepest - profile.first);
  return {static_cast<float>(profile.at(low)), static_cast<float>(profile.at(high))};
}

}  // namespace palpate::io
