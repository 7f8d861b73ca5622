#include "modes/scene/head_shape.h"

#include <cstddef>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <vector>

#include "modes/scene/starting_scene.h"

namespace palpate::modes::internal {
namespace {

using io::Vec3;

constexpr double step_mm = 1, ray_spacing_mm = 6;
constexpr double least_run_mm = 2;  // less is noise, or a vessel
constexpr double least_body_mm = 100, least_core_mm = 70, most_layer_mm = 25;
// Of what says that it is a head, and of what says nothing. Heads that were measured have 0.38 and more, a bottle 0.04.
constexpr double least_share = 0.2, least_share_unsaid = 0.5;
constexpr double longest_scan_mm = 700;  // along an axis: more is no scan of a head, and would take long
constexpr double widest_head_mm = 170;   // in the mean over rays: those that were measured have 152 at most

struct Run {
  bool bright = false;
  double mm = 0;
};

void append(std::vector<Run>& runs, bool bright, double mm) {
  if (runs.empty() || runs.back().bright != bright) runs.push_back({bright, 0});
  runs.back().mm += mm;
}

/// Short runs of one kind become part of their neighbors.
std::vector<Run> without_short(const std::vector<Run>& runs, bool bright) {
  std::vector<Run> left;
  for (const Run& run : runs) {
    append(left, run.bright == bright && run.mm < least_run_mm ? !bright : run.bright, run.mm);
  }
  return left;
}

/// From the first bright place of a ray to its last.
std::vector<Run> runs_along(const io::Volume& volume, double bright_from, Vec3 at, int axis, double end) {
  std::vector<Run> runs;
  for (; at[axis] <= end; at[axis] += step_mm) {
    const Vec3 index = volume.geometry.to_index(at);
    bool bright = false;
    if (volume.geometry.contains(index)) {
      const glm::ivec3 voxel(glm::round(index));
      bright =
          !volume.is_padding(voxel.x, voxel.y, voxel.z) && volume.value_at(voxel.x, voxel.y, voxel.z) > bright_from;
    }
    append(runs, bright, step_mm);
  }
  runs = without_short(without_short(runs, true), false);
  if (!runs.empty() && !runs.front().bright) runs.erase(runs.begin());
  if (!runs.empty() && !runs.back().bright) runs.pop_back();
  return runs;
}

bool is_shell(const Run& outer, const Run& dark, double body_mm) {
  return outer.mm <= most_layer_mm && dark.mm <= most_layer_mm && body_mm - outer.mm - dark.mm >= least_core_mm;
}

}  // namespace

Shell shell_of(const io::Volume& volume, double bright_from) {
  const glm::ivec3 last = volume.geometry.dimensions - 1;
  Vec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::ivec3 index((corner & 1U) != 0 ? last.x : 0, (corner & 2U) != 0 ? last.y : 0,
                           (corner & 4U) != 0 ? last.z : 0);
    const Vec3 at = volume.geometry.to_patient(Vec3(index));
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  if (glm::any(glm::greaterThan(high - low, Vec3(longest_scan_mm)))) return {};
  std::size_t rays = 0, shells = 0;
  double length = 0;
  for (const int axis : {0, 1}) {  // the neck is below
    const int other = 1 - axis;
    for (double across = low[other]; across <= high[other]; across += ray_spacing_mm) {
      for (double height = low.z; height <= high.z; height += ray_spacing_mm) {
        Vec3 from(low);
        from[other] = across;
        from.z = height;
        const std::vector<Run> runs = runs_along(volume, bright_from, from, axis, high[axis]);
        double body_mm = 0;
        for (const Run& run : runs) body_mm += run.mm;
        if (body_mm < least_body_mm) continue;
        ++rays;
        length += body_mm;
        if (runs.size() < 3) continue;
        shells += is_shell(runs[0], runs[1], body_mm) ? 1 : 0;
        shells += is_shell(runs[runs.size() - 1], runs[runs.size() - 2], body_mm) ? 1 : 0;
      }
    }
  }
  if (rays == 0) return {};
  return {static_cast<double>(shells) / static_cast<double>(2 * rays), length / static_cast<double>(rays)};
}

bool is_built_like_a_head(const io::Volume& volume, double bright_from) {
  if (!part_of_body(volume).empty() && !is_of_head(volume)) return false;
  const Shell shell = shell_of(volume, bright_from);
  if (is_of_head(volume)) return shell.share >= least_share;
  return shell.share >= least_share_unsaid && shell.width_mm <= widest_head_mm;
}

}  // namespace palpate::modes::internal
