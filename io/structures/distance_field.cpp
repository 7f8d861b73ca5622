#include "io/structures/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <utility>

#include "io/messages.h"
#include "io/structures/closest_points.h"
#include "io/structures/coarse_distance.h"
#include "io/structures/distance_bounds.h"
#include "io/structures/label_planes.h"
#include "io/structures/smoothest.h"

namespace palpate::io {
namespace {

constexpr std::size_t nodes_of_a_brick = internal::DistanceParts::nodes_of_a_brick;

/// A node's closest point and on which side of the surface the node is.
struct Nearest {
  Vec3f point{nowhere};
  float f = 0;
};

/// Signed distances of a brick's nodes and of the nodes around it. A node outside all bricks uses the closest point of
/// the nearest node in a brick.
void fill_brick(const NodeBricks& bricks, const std::vector<Nearest>& nearest, std::size_t slot, float* into) {
  constexpr std::ptrdiff_t side = brick_edge + 4;
  std::vector<Nearest> around(static_cast<std::size_t>(side) * side * side);
  gather<2, Nearest>(bricks, nearest, slot, Nearest{}, around.data());
  const Vec3f spacing(bricks.lattice.spacing);
  const Vec3f corner = Vec3f(bricks.place[slot] * brick_edge) * spacing;
  for (int k = -1; k < brick_edge + 2; ++k) {
    for (int j = -1; j < brick_edge + 2; ++j) {
      for (int i = -1; i < brick_edge + 2; ++i) {
        const auto held = [&](int x, int y, int z) {
          return around[static_cast<std::size_t>(((z + 2) * side + y + 2) * side + x + 2)];
        };
        Nearest here = held(i, j, k);
        if (here.point.x == nowhere) {
          here = held(std::clamp(i, 0, brick_edge - 1), std::clamp(j, 0, brick_edge - 1),
                      std::clamp(k, 0, brick_edge - 1));
        }
        const Vec3f node =
            corner + Vec3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)) * spacing;
        *into++ = std::copysign(glm::length(node - here.point), here.f);
      }
    }
  }
}

/// Only the bricks that hold a node nearer to the surface than `within`.
NodeBricks bricks_within(const NodeBricks& bricks, const std::vector<Vec3f>& closest, double within,
                         std::vector<std::size_t>& kept) {
  NodeBricks near;
  near.lattice = bricks.lattice;
  near.slot = bricks.slot;
  const Vec3f spacing(bricks.lattice.spacing);
  for (std::size_t slot = 0; slot < bricks.count(); ++slot) {
    const glm::ivec3 place = bricks.place[slot];
    float least = nowhere;
    for (int n = 0; n < static_cast<int>(brick_nodes); ++n) {
      const glm::ivec3 node =
          place * brick_edge + glm::ivec3(n % brick_edge, n / brick_edge % brick_edge, n / (brick_edge * brick_edge));
      least = std::min(least,
                       glm::distance(Vec3f(node) * spacing, closest[slot * brick_nodes + static_cast<std::size_t>(n)]));
    }
    const glm::ivec3& size = bricks.lattice.bricks;
    std::int32_t& entry = near.slot[(static_cast<std::size_t>(place.z) * static_cast<std::size_t>(size.y) +
                                     static_cast<std::size_t>(place.y)) *
                                        static_cast<std::size_t>(size.x) +
                                    static_cast<std::size_t>(place.x)];
    if (static_cast<double>(least) < within) {
      entry = static_cast<std::int32_t>(near.count());
      near.place.push_back(place);
      kept.push_back(slot);
    } else {
      entry = NodeBricks::outside;
    }
  }
  return near;
}

/// The box that distances are kept for.
std::pair<Vec3, Vec3> region_of(const NodeBricks& bricks, const DistanceOptions& options) {
  Vec3 low(std::numeric_limits<double>::infinity());
  Vec3 high(-std::numeric_limits<double>::infinity());
  const auto hold = [&](const Vec3& at) {
    low = glm::min(low, at);
    high = glm::max(high, at);
  };
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 share((corner & 1) != 0 ? 1 : 0, (corner & 2) != 0 ? 1 : 0, (corner & 4) != 0 ? 1 : 0);
    hold(bricks.lattice.position(share * Vec3(bricks.lattice.bricks * brick_edge)));
    if (options.scan != nullptr) hold(options.scan->to_patient(share * Vec3(options.scan->dimensions - 1)));
  }
  constexpr double around_mm = 40;
  return options.scan != nullptr ? std::pair(low, high) : std::pair(low - around_mm, high + around_mm);
}

}  // namespace

DistanceField::DistanceField(const OutlinePlanes& planes, const DistanceOptions& options) {
  parts_.reach_mm = options.reach_mm;
  parts_.blend_mm = blend_mm(planes.lattice);
  const DistanceBounds bounds = bounds_of(planes, options.threads);
  SmoothestOptions smooth;
  smooth.threads = options.threads;
  smooth.coarser = planes.coarser;
  const std::vector<float> f = smoothest(bounds, smooth);
  const std::vector<Vec3f> closest = closest_points(bounds.bricks, f, planes.band_mm, options.threads);

  const auto [low, high] = region_of(bounds.bricks, options);
  const CoarseLattice coarse = coarse_lattice(low, high);
  parts_.far.origin = coarse.origin;
  parts_.far.spacing = coarse.spacing;
  parts_.far.size = coarse.size;
  parts_.far.mm = std::make_shared<const std::vector<float>>(coarse_distances(coarse, bounds.bricks, f, closest));

  std::vector<std::size_t> kept;
  parts_.near.lattice = planes.lattice;
  parts_.near = bricks_within(bounds.bricks, closest, parts_.kept_within_mm(), kept);
  parts_.origin = planes.lattice.origin;
  const Vec3 per_mm = 1.0 / planes.lattice.spacing;
  parts_.to_node = glm::transpose(planes.lattice.axes);
  parts_.from_node = planes.lattice.axes;
  for (int axis = 0; axis < 3; ++axis) {
    parts_.to_node[axis] *= per_mm;
    parts_.from_node[axis] *= per_mm[axis];
  }
  std::vector<Nearest> nearest(closest.size());
  for (std::size_t n = 0; n < nearest.size(); ++n) {
    nearest[n] = {closest[n], f[n]};
  }
  std::vector<float> mm(kept.size() * nodes_of_a_brick);
  for (std::size_t n = 0; n < kept.size(); ++n) {
    fill_brick(bounds.bricks, nearest, kept[n], mm.data() + n * nodes_of_a_brick);
  }
  const auto page = std::make_shared<const std::vector<float>>(std::move(mm));
  parts_.pages = {page};
  for (std::size_t n = 0; n < kept.size(); ++n) parts_.brick.push_back(page->data() + n * nodes_of_a_brick);
}

Distance DistanceField::sample(const Vec3& position_mm) const noexcept {
  Distance near;
  if (!parts_.sample_near(position_mm, near)) {
    return parts_.sample_far(position_mm);
  }
  const double t = (std::abs(near.mm) - parts_.reach_mm) / parts_.blend_mm;
  if (t <= 0) {
    return near;
  }
  const Distance far = parts_.sample_far(position_mm);
  if (t >= 1) {
    return far;
  }
  const double part = t * t * (3 - 2 * t);
  const double slope = 6 * t * (1 - t) / parts_.blend_mm * (near.mm < 0 ? -1.0 : 1.0);
  return {
      .mm = near.mm + part * (far.mm - near.mm),
      .gradient = near.gradient + part * (far.gradient - near.gradient) + (far.mm - near.mm) * slope * near.gradient};
}

std::shared_ptr<const DistanceField> distance_of(const Mask& mask, const DistanceOptions& options) {
  bool any = false;
  for (const std::uint8_t share : mask.occupancy) any = any || share >= Mask::half;
  if (!any) {
    throw InvalidInput(say("no-voxel-inside"));
  }
  return std::make_shared<const DistanceField>(planes_of(mask, options.reach_mm, options.scan), options);
}

}  // namespace palpate::io
