#include "io/structures/field_patch.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/messages.h"
#include "io/parallel.h"

namespace palpate::io::internal {
namespace {

constexpr double most_bricks = 3e5;

/// The nodes of a brick beside which the surface moves; none if `low` is above `high`.
struct Moved {
  glm::ivec3 low{brick_edge}, high{-1};

  bool any() const { return low.x <= high.x; }
  /// How far they are from the nearest node of the brick so many bricks away, mm.
  double distance_to(const glm::ivec3& away, const Vec3& spacing) const {
    const glm::ivec3 first = away * brick_edge, last = first + brick_edge - 1;
    return glm::length(Vec3(glm::max(glm::max(first - high, low - last), glm::ivec3(0))) * spacing);
  }
};

/// The numbers of one brick before and after.
Moved evaluate(const Patch& patch, const glm::ivec3& place, float* before, float* after) {
  const float* stored = patch.stored(place);
  const NodeLattice& lattice = patch.bricks.lattice;
  const Vec3 corner = Vec3(place * brick_edge);
  const auto& near = patch.near[patch.box_at(place)];
  const double around = 2.2 * std::max({lattice.spacing.x, lattice.spacing.y, lattice.spacing.z});
  std::array<double, brick_nodes> added{};
  if (patch.change.bumps) add_at_nodes(*patch.change.bumps, near, lattice, place, added);
  Moved moved;
  for (int k = 0; k < brick_edge; ++k) {
    for (int j = 0; j < brick_edge; ++j) {
      for (int i = 0; i < brick_edge; ++i) {
        const std::size_t n = NodeBricks::at(i, j, k);
        const Vec3 at = lattice.position(corner + Vec3(i, j, k));
        before[n] = stored != nullptr ? stored[stored_at(i, j, k)] : static_cast<float>(patch.old.sample_far(at).mm);
        if (near.empty()) {
          after[n] = before[n];
        } else if (patch.change.bumps) {
          after[n] = static_cast<float>(before[n] + added[n]);
        } else {
          after[n] = static_cast<float>(patch.change.after(at, before[n], near));
        }
        if (after[n] == before[n] ||
            !(std::abs(after[n]) < around || std::abs(before[n]) < around || (after[n] > 0) != (before[n] > 0))) {
          continue;
        }
        moved.low = glm::min(moved.low, glm::ivec3(i, j, k));
        moved.high = glm::max(moved.high, glm::ivec3(i, j, k));
      }
    }
  }
  return moved;
}

}  // namespace

Patch patch_around(const DistanceParts& old, const FieldChange& change, double around_mm) {
  Patch patch{.old = old, .change = change};
  const NodeLattice& lattice = old.near.lattice;
  const Vec3 brick_mm = lattice.spacing * static_cast<double>(brick_edge);
  Vec3 low(1e9), high(-1e9);
  for (const Stretch& stretch : change.where) {
    for (const Vec3& end : {stretch.from, stretch.to}) {
      const Vec3 at = (glm::transpose(lattice.axes) * (end - lattice.origin)) / brick_mm;
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  }
  const Vec3 around = (change.within_mm + around_mm) / brick_mm + 1.0;
  const Vec3 first = glm::floor(low - around), last = glm::floor(high + around);
  const Vec3 size = last - first + 1.0;
  if (!(size.x * size.y * size.z < 64 * most_bricks)) throw InvalidInput(say("edit-is-too-large"));
  patch.low = glm::ivec3(first);
  patch.bricks.lattice = lattice;
  patch.bricks.lattice.bricks = glm::ivec3(size);
  patch.bricks.lattice.origin = lattice.position(Vec3(patch.low * brick_edge));
  patch.bricks.slot.assign(static_cast<std::size_t>(size.x * size.y * size.z), NodeBricks::outside);
  patch.near.resize(patch.bricks.slot.size());
  const NodeLattice& own = patch.bricks.lattice;
  const double half_mm = 0.5 * glm::length(brick_mm);
  for (std::uint32_t n = 0; n < change.where.size(); ++n) {
    const Stretch& stretch = change.where[n];
    const Vec3 from = (glm::transpose(own.axes) * (stretch.from - own.origin)) / brick_mm;
    const Vec3 to = (glm::transpose(own.axes) * (stretch.to - own.origin)) / brick_mm;
    const Vec3 within = change.within_mm / brick_mm;
    const glm::ivec3 begin(glm::floor(glm::min(from, to) - within)), end(glm::floor(glm::max(from, to) + within));
    for (int z = begin.z; z <= end.z; ++z) {
      for (int y = begin.y; y <= end.y; ++y) {
        for (int x = begin.x; x <= end.x; ++x) {
          const Vec3 middle = own.position(Vec3(glm::ivec3(x, y, z) * brick_edge) + 0.5 * brick_edge);
          if (distance_to(stretch, middle) <= change.within_mm + half_mm)
            patch.near[patch.box_at({x, y, z})].push_back(n);
        }
      }
    }
  }
  return patch;
}

bool choose_bricks(Patch& patch, double around_mm, int threads, std::vector<char>& passed) {
  const glm::ivec3 size = patch.bricks.lattice.bricks;
  std::vector<glm::ivec3> inside;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (!patch.near[patch.box_at({x, y, z})].empty()) inside.emplace_back(x, y, z);
      }
    }
  }
  std::vector<float> before(inside.size() * brick_nodes), after(inside.size() * brick_nodes);
  std::vector<Moved> moved(inside.size());
  parallel_for(
      inside.size(),
      [&](std::size_t n) {
        moved[n] = evaluate(patch, inside[n], before.data() + n * brick_nodes, after.data() + n * brick_nodes);
      },
      {}, threads);
  const Vec3 brick_mm = patch.bricks.lattice.spacing * static_cast<double>(brick_edge);
  const glm::ivec3 reach(glm::ceil(around_mm / brick_mm));
  NodeBricks& bricks = patch.bricks;
  for (std::size_t n = 0; n < inside.size(); ++n) {
    if (!moved[n].any()) continue;
    for (int z = -reach.z; z <= reach.z; ++z) {
      for (int y = -reach.y; y <= reach.y; ++y) {
        for (int x = -reach.x; x <= reach.x; ++x) {
          const glm::ivec3 away(x, y, z), place = inside[n] + away;
          if (!patch.holds(place) || moved[n].distance_to(away, bricks.lattice.spacing) > around_mm) continue;
          std::int32_t& slot = bricks.slot[patch.box_at(place)];
          if (slot >= 0) continue;
          slot = static_cast<std::int32_t>(bricks.count());
          bricks.place.push_back(place);
        }
      }
    }
  }
  if (static_cast<double>(bricks.count()) > most_bricks) throw InvalidInput(say("edit-is-too-large"));
  const std::size_t count = bricks.count();
  patch.f.resize(count * brick_nodes);
  patch.before_mm.resize(count * brick_nodes);
  passed.assign(count, 0);
  std::vector<char> done(count, 0);
  for (std::size_t n = 0; n < inside.size(); ++n) {
    const std::int32_t slot = bricks.slot[patch.box_at(inside[n])];
    if (slot < 0) continue;
    const auto at = static_cast<std::size_t>(slot);
    std::copy_n(before.data() + n * brick_nodes, brick_nodes, patch.before_mm.data() + at * brick_nodes);
    std::copy_n(after.data() + n * brick_nodes, brick_nodes, patch.f.data() + at * brick_nodes);
    passed[at] = moved[n].any() ? 1 : 0;
    done[at] = 1;
  }
  parallel_for(
      count,
      [&](std::size_t n) {
        if (done[n] != 0) return;
        evaluate(patch, bricks.place[n], patch.before_mm.data() + n * brick_nodes, patch.f.data() + n * brick_nodes);
      },
      {}, threads);
  return count > 0;
}

}  // namespace palpate::io::internal
