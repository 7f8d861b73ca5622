#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/parallel.h"
#include "io/structures/field_patch.h"

namespace palpate::io::internal {
namespace {

/// The old surface's points that are nearest to a brick's nodes, if they are still there.
void keep_old_points(Patch& patch, std::size_t slot, std::vector<Vec3f>& lost) {
  const glm::ivec3 place = patch.bricks.place[slot];
  const float* stored = patch.stored(place);
  const Vec3f spacing(patch.bricks.lattice.spacing);
  const double ridge_near = 2.2 * std::max({spacing.x, spacing.y, spacing.z});
  const auto& near = patch.near[patch.box_at(place)];
  for (int k = 0; k < brick_edge; ++k) {
    for (int j = 0; j < brick_edge; ++j) {
      for (int i = 0; i < brick_edge; ++i) {
        Vec3f& kept = patch.kept[slot * brick_nodes + NodeBricks::at(i, j, k)];
        kept = Vec3f(nowhere);
        if (stored == nullptr) continue;
        const auto at = [&](int x, int y, int z) { return stored[stored_at(x, y, z)]; };
        const float mm = at(i, j, k);
        const Vec3f gradient = Vec3f(at(i + 1, j, k) - at(i - 1, j, k), at(i, j + 1, k) - at(i, j - 1, k),
                                     at(i, j, k + 1) - at(i, j, k - 1)) /
                               (2.0F * spacing);
        const float steep = glm::length(gradient);
        const Vec3f node = Vec3f(place * brick_edge + glm::ivec3(i, j, k)) * spacing;
        if (!(steep > 0)) continue;
        const Vec3f point = node - mm / steep * gradient;
        bool gone = patch.is_touched(point);
        if (!gone && steep < 0.8F) {  // a ridge: another point may be as near
          const Vec3 patient = patch.bricks.lattice.origin + patch.bricks.lattice.axes * Vec3(node);
          const double within = std::abs(static_cast<double>(mm)) + patch.change.touched_mm;
          const auto is_near = [&](const Stretch& stretch) { return distance_to(stretch, patient) < within; };
          gone = std::abs(static_cast<double>(mm)) < ridge_near && patch.change.within_mm > within
                     ? std::ranges::any_of(near, [&](std::uint32_t n) { return is_near(patch.change.where[n]); })
                     : std::ranges::any_of(patch.change.where, is_near);
        }
        if (gone) {
          if (i % 2 == 0 && j % 2 == 0 && k % 2 == 0) lost.push_back(point);
        } else {
          kept = point;
        }
      }
    }
  }
}

void measure_brick(Patch& patch, const std::vector<Vec3f>& closest_before, std::size_t slot) {
  const Vec3f spacing(patch.bricks.lattice.spacing);
  const float h = std::max({spacing.x, spacing.y, spacing.z});
  const auto far = static_cast<float>(2 * patch.old.kept_within_mm());
  for (int n = 0; n < static_cast<int>(brick_nodes); ++n) {
    const std::size_t at = slot * brick_nodes + static_cast<std::size_t>(n);
    const Vec3f& point = patch.closest[at];
    const float f = patch.f[at], before = patch.before_mm[at];
    if (point.x == nowhere) {
      patch.mm[at] = std::copysign(far, f);
    } else if (patch.kept[at].x != nowhere && (f > 0) == (before > 0) &&
               (point == patch.kept[at] || !patch.is_touched(point))) {
      patch.mm[at] = before;  // the nearest point is still there, and no new one is nearer
    } else {
      const glm::ivec3 in(n % brick_edge, n / brick_edge % brick_edge, n / (brick_edge * brick_edge));
      const Vec3f node = Vec3f(patch.bricks.place[slot] * brick_edge + in) * spacing;
      const float now = std::copysign(glm::distance(node, point), f);
      const Vec3f& old_point = closest_before[at];
      patch.mm[at] = now;
      if (old_point.x == nowhere) continue;
      // A rough surface is measured a little wrong. Where it hardly moves, what the same measure misses of the old one
      // is put right in the new one.
      const float measured = std::copysign(glm::distance(node, old_point), before);
      const float part = std::max(0.0F, 1 - std::abs(now - measured) / h);
      const float right = now + part * (before - measured);
      if ((right > 0) == (f > 0)) patch.mm[at] = right;
    }
  }
}

/// The points of a surface f = 0 that are nearest to each node; those that are known stay where no new one is nearer.
std::vector<Vec3f> nearest_on(const Patch& patch, const std::vector<float>& f, const std::vector<char>& passed,
                              int threads) {
  std::vector<Vec3f> closest = patch.kept;
  const Vec3f spacing(patch.bricks.lattice.spacing);
  const float around = 2.2F * std::max({spacing.x, spacing.y, spacing.z});
  parallel_for(
      patch.bricks.count(),
      [&](std::size_t slot) {
        bool any = passed[slot] != 0;
        for (std::size_t at = slot * brick_nodes; at < (slot + 1) * brick_nodes && !any; ++at) {
          any = patch.kept[at].x == nowhere && std::abs(f[at]) < around;  // its nearest point may be gone
        }
        if (!any) return;
        std::array<Vec3f, brick_nodes> found;
        points_near_surface(patch.bricks, f, slot, found.data());
        for (std::size_t n = 0; n < brick_nodes; ++n) {
          Vec3f& best = closest[slot * brick_nodes + n];
          if (found[n].x == nowhere || (best.x != nowhere && !patch.is_touched(found[n]))) continue;
          const int in = static_cast<int>(n);
          const glm::ivec3 at =
              patch.bricks.place[slot] * brick_edge +
              glm::ivec3(in % brick_edge, in / brick_edge % brick_edge, in / (brick_edge * brick_edge));
          const Vec3f node = Vec3f(at) * spacing;
          if (best.x == nowhere || glm::distance(node, found[n]) < glm::distance(node, best)) best = found[n];
        }
      },
      {}, threads);
  spread_closest_points(patch.bricks, patch.old.kept_within_mm(), threads, closest);
  return closest;
}

}  // namespace

void measure_anew(Patch& patch, const std::vector<char>& passed, int threads) {
  const std::size_t count = patch.bricks.count();
  patch.kept.resize(count * brick_nodes);
  std::vector<std::vector<Vec3f>> lost(count);
  parallel_for(
      count, [&](std::size_t n) { keep_old_points(patch, n, lost[n]); }, {}, threads);
  for (const auto& points : lost) patch.lost.insert(patch.lost.end(), points.begin(), points.end());
  patch.closest = nearest_on(patch, patch.f, passed, threads);
  const std::vector<Vec3f> closest_before = nearest_on(patch, patch.before_mm, passed, threads);
  patch.mm.resize(count * brick_nodes);
  parallel_for(
      count, [&](std::size_t slot) { measure_brick(patch, closest_before, slot); }, {}, threads);
}

}  // namespace palpate::io::internal
