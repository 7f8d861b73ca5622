#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "io/parallel.h"
#include "io/structures/field_patch.h"

namespace palpate::io::internal {
namespace {

/// The surface's point beside a point of the lattice's mm.
Vec3f on_surface(const DistanceParts& parts, const NodeLattice& lattice, const Vec3f& point) {
  Vec3 at = lattice.origin + lattice.axes * Vec3(point);
  for (int step = 0; step < 2; ++step) {
    const Distance there = parts.sample_nearest(at);
    const double steep = glm::dot(there.gradient, there.gradient);
    if (steep > 0.1) at -= there.mm / steep * there.gradient;
  }
  return Vec3f(glm::transpose(lattice.axes) * (at - lattice.origin));
}

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
        Vec3f point = node - mm / steep * gradient;
        // Near a ridge the slope does not point to the surface. Others measure from this point: it has to lie there.
        if (steep < 0.97F) point = on_surface(patch.old, patch.bricks.lattice, point);
        bool gone = patch.is_touched(point);
        if (!gone && steep < 0.8F) {  // a ridge: another point may be as near
          const Vec3 patient = patch.bricks.lattice.origin + patch.bricks.lattice.axes * Vec3(node);
          const double within = std::abs(static_cast<double>(mm)) + patch.change.touched_mm;
          const auto is_near = [&](const Stretch& stretch) { return lies_within(stretch, patient, within); };
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

/// The old surface's points, in the bricks beside it alone.
struct PointsBefore {
  NodeBricks bricks;  ///< of the patch's lattice
  std::vector<Vec3f> closest;
};

/// The error of measuring the old surface at a node of the patch, where the surface hardly moves; none if unknown.
std::optional<float> missed_at(const Patch& patch, const PointsBefore& before, const glm::ivec3& node) {
  const glm::ivec3 place(node.x >> 3, node.y >> 3, node.z >> 3), in = node - place * brick_edge;
  const std::int32_t beside = before.bricks.slot_at(place.x, place.y, place.z);
  if (beside < 0) return std::nullopt;
  const std::size_t nth = NodeBricks::at(in.x, in.y, in.z);
  const Vec3f& old_point = before.closest[static_cast<std::size_t>(beside) * brick_nodes + nth];
  const std::size_t at = static_cast<std::size_t>(patch.bricks.slot_at(place.x, place.y, place.z)) * brick_nodes + nth;
  if (old_point.x == nowhere || patch.closest[at].x == nowhere) return std::nullopt;
  const Vec3f spacing(patch.bricks.lattice.spacing), mm = Vec3f(node) * spacing;
  const float now = std::copysign(glm::distance(mm, patch.closest[at]), patch.f[at]);
  const float measured = std::copysign(glm::distance(mm, old_point), patch.before_mm[at]);
  const float h = std::max({spacing.x, spacing.y, spacing.z});
  return std::max(0.0F, 1 - std::abs(now - measured) / h) * (patch.before_mm[at] - measured);
}

void measure_brick(Patch& patch, const PointsBefore& points_before, std::size_t slot) {
  const Vec3f spacing(patch.bricks.lattice.spacing);
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
      const glm::ivec3 node = patch.bricks.place[slot] * brick_edge + in;
      const float now = std::copysign(glm::distance(Vec3f(node) * spacing, point), f);
      patch.mm[at] = now;
      // A rough surface is measured with a small error. Where the surface hardly moves, the error of the same
      // measurement of the old surface is subtracted: at the node itself, or far from the surface at the node beside
      // its nearest point.
      std::optional<float> missed = missed_at(patch, points_before, node);
      if (!missed) missed = missed_at(patch, points_before, glm::ivec3(glm::round(point / spacing)));
      const float right = now + missed.value_or(0);
      if ((right > 0) == (f > 0)) patch.mm[at] = right;
    }
  }
}

/// The points of a surface f = 0 nearest to each node beside it; known points stay if no new one is nearer.
/// `unsettled`: the bricks in which a node got a point or has none yet.
std::vector<Vec3f> nearest_on(const Patch& patch, const std::vector<float>& f, const std::vector<char>& passed,
                              int threads, std::vector<char>& unsettled) {
  std::vector<Vec3f> closest = patch.kept;
  unsettled.assign(patch.bricks.count(), 0);
  const Vec3f spacing(patch.bricks.lattice.spacing);
  const float around = 2.2F * std::max({spacing.x, spacing.y, spacing.z});
  parallel_for(
      patch.bricks.count(),
      [&](std::size_t slot) {
        bool any = passed[slot] != 0;
        for (std::size_t at = slot * brick_nodes; at < (slot + 1) * brick_nodes; ++at) {
          if (patch.kept[at].x != nowhere) continue;
          unsettled[slot] = 1;
          any = any || std::abs(f[at]) < around;  // its nearest point may be gone
          if (any) break;
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
          if (best.x == nowhere || glm::distance(node, found[n]) < glm::distance(node, best)) {
            best = found[n];
            unsettled[slot] = 1;
          }
        }
      },
      {}, threads);
  return closest;
}

PointsBefore points_before(const Patch& patch, const std::vector<Vec3f>& closest, int threads) {
  PointsBefore before;
  NodeBricks& bricks = before.bricks;
  bricks.lattice = patch.bricks.lattice;
  bricks.slot.assign(patch.bricks.slot.size(), NodeBricks::outside);
  const Vec3& h = bricks.lattice.spacing;
  const double around = 2.2 * std::max({h.x, h.y, h.z});
  for (std::size_t slot = 0; slot < patch.bricks.count(); ++slot) {
    const std::size_t first = slot * brick_nodes, end = first + brick_nodes;
    const auto is_beside = [&](std::size_t at) { return std::abs(patch.before_mm[at]) < around; };
    std::size_t at = first;
    while (at < end && !is_beside(at)) ++at;
    if (at == end) continue;
    bricks.slot[patch.box_at(patch.bricks.place[slot])] = static_cast<std::int32_t>(bricks.count());
    bricks.place.push_back(patch.bricks.place[slot]);
    before.closest.insert(before.closest.end(), closest.begin() + static_cast<std::ptrdiff_t>(first),
                          closest.begin() + static_cast<std::ptrdiff_t>(end));
  }
  spread_closest_points(bricks, 0, threads, before.closest);  // all have points of their own
  return before;
}

}  // namespace

void measure_anew(Patch& patch, const std::vector<char>& passed, int threads) {
  const std::size_t count = patch.bricks.count();
  patch.kept.resize(count * brick_nodes);
  std::vector<std::vector<Vec3f>> lost(count);
  parallel_for(
      count, [&](std::size_t n) { keep_old_points(patch, n, lost[n]); }, {}, threads);
  for (const auto& points : lost) patch.lost.insert(patch.lost.end(), points.begin(), points.end());
  std::vector<char> unsettled;
  const PointsBefore before =
      points_before(patch, nearest_on(patch, patch.before_mm, passed, threads, unsettled), threads);
  patch.closest = nearest_on(patch, patch.f, passed, threads, unsettled);
  spread_closest_points(patch.bricks, patch.old.kept_within_mm(), threads, patch.closest, unsettled);
  patch.mm.resize(count * brick_nodes);
  parallel_for(
      count, [&](std::size_t slot) { measure_brick(patch, before, slot); }, {}, threads);
}

}  // namespace palpate::io::internal
