#include "io/structures/closest_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "io/parallel.h"
#include "io/structures/cubic.h"

namespace palpate::io {
namespace {

constexpr int newton_margin = 5;  // how many nodes beyond its brick a Newton step may look
constexpr std::ptrdiff_t newton_width = brick_edge + 2 * newton_margin;

/// f around a brick, interpolated.
class Surroundings {
 public:
  Surroundings(const NodeBricks& bricks, const std::vector<float>& f, std::size_t slot)
      : spacing_(bricks.lattice.spacing),
        numbers_(static_cast<std::size_t>(newton_width) * newton_width * newton_width) {
    gather<newton_margin, float>(bricks, f, slot, no_node, numbers_.data());
  }
  float at(int i, int j, int k) const {
    return numbers_[static_cast<std::size_t>(((k + newton_margin) * newton_width + j + newton_margin) * newton_width +
                                             i + newton_margin)];
  }
  /// At a node's coordinates in the brick; the slope is per mm. NaN if unknown.
  double sample(const Vec3& node, Vec3& slope) const {
    const Vec3 base = glm::floor(node);
    const glm::ivec3 first = glm::ivec3(base) - 1 + newton_margin;
    if (!(first.x >= 0 && first.y >= 0 && first.z >= 0 && first.x + 3 < newton_width && first.y + 3 < newton_width &&
          first.z + 3 < newton_width)) {
      return no_node;
    }
    const Vec3 t = node - base;
    const CubicSample sample =
        cubic_sample(numbers_.data() + (first.z * newton_width + first.y) * newton_width + first.x, newton_width,
                     newton_width * newton_width, t);
    slope = Vec3(sample.slope[0], sample.slope[1], sample.slope[2]) / spacing_;
    return sample.value;
  }

 private:
  Vec3 spacing_;
  std::vector<float> numbers_;
};

/// The point of the surface closest to a node, as far as Newton's steps find one; the node's own coordinates in mm.
bool newton(const Surroundings& f, const Vec3& spacing, const glm::ivec3& node, Vec3& closest) {
  const double least = std::min({spacing.x, spacing.y, spacing.z});
  const Vec3 start = Vec3(node) * spacing;
  Vec3 at = start;
  for (int n = 0; n < 6; ++n) {
    Vec3 slope(0);
    const double value = f.sample(at / spacing, slope);
    const double steep = glm::dot(slope, slope);
    if (!(steep > 1e-4) || !std::isfinite(value)) {
      return false;
    }
    const Vec3 down = -value / steep * slope;
    const Vec3 back = start - at;
    const Vec3 aside = n == 5 ? Vec3(0) : back - glm::dot(back, slope) / steep * slope;
    const Vec3 step = down + aside;
    at += step;
    if (glm::length(step) < 1e-3 * least) {
      break;
    }
  }
  Vec3 slope(0);
  const double value = f.sample(at / spacing, slope);
  if (!(std::abs(value) < 0.05 * least * glm::length(slope))) {
    return false;
  }
  closest = at;
  return true;
}

void offer(const Vec3f& node, const Vec3f& point, float& least, Vec3f& closest) {
  const Vec3f away = node - point;
  const float squared = glm::dot(away, away);
  if (squared < least) {
    least = squared;
    closest = point;
  }
}

}  // namespace

void points_near_surface(const NodeBricks& bricks, const std::vector<float>& f, std::size_t slot, Vec3f* closest) {
  const Vec3& spacing = bricks.lattice.spacing;
  const Vec3 corner = Vec3(bricks.place[slot] * brick_edge) * spacing;
  const double near = 2.2 * std::max({spacing.x, spacing.y, spacing.z});
  const float* const own = f.data() + slot * brick_nodes;
  if (std::none_of(own, own + brick_nodes, [&](float here) { return std::abs(here) <= near; })) {
    std::fill_n(closest, brick_nodes, Vec3f(nowhere));
    return;
  }
  const Surroundings around(bricks, f, slot);
  for (int k = 0; k < brick_edge; ++k) {
    for (int j = 0; j < brick_edge; ++j) {
      for (int i = 0; i < brick_edge; ++i) {
        const float here = around.at(i, j, k);
        Vec3f& best = closest[NodeBricks::at(i, j, k)];
        best = Vec3f(nowhere);
        if (!(std::abs(here) <= near)) {
          continue;
        }
        const Vec3 node = corner + Vec3(i, j, k) * spacing;
        float least = std::numeric_limits<float>::max();
        for (int side = 0; side < 6; ++side) {
          glm::ivec3 toward(0);
          toward[side / 2] = side % 2 == 0 ? -1 : 1;
          const float there = around.at(i + toward.x, j + toward.y, k + toward.z);
          if ((here > 0) != (there > 0) && there == there) {
            const double part = static_cast<double>(here) / (static_cast<double>(here) - there);
            offer(Vec3f(node), Vec3f(node + part * Vec3(toward) * spacing), least, best);
          }
        }
        Vec3 found;
        if (newton(around, spacing, {i, j, k}, found)) {
          // This point is on the surface. If it is the nearer one, or nearly so, it is also more exact.
          const Vec3f point(corner + found);
          const Vec3f away = Vec3f(node) - point;
          if (best.x == nowhere || glm::dot(away, away) < 1.2F * least + 0.01F) {
            best = point;
          }
        }
      }
    }
  }
}

namespace {

/// Takes over neighbors' closest points that are nearer: forwards and backwards through a brick. Returns whether any
/// changed.
bool spread(const NodeBricks& bricks, const std::vector<Vec3f>& before, std::size_t slot, Vec3f* closest) {
  constexpr std::ptrdiff_t side = brick_edge + 2;
  std::array<Vec3f, static_cast<std::size_t>(side) * side * side> around;
  gather<1, Vec3f>(bricks, before, slot, Vec3f(nowhere), around.data());
  if (std::ranges::all_of(around, [](const Vec3f& point) { return point.x == nowhere; })) {
    std::fill_n(closest, brick_nodes, Vec3f(nowhere));
    return false;
  }
  const Vec3f spacing(bricks.lattice.spacing);
  const Vec3f corner = Vec3f(bricks.place[slot] * brick_edge) * spacing;
  const auto visit = [&](int i, int j, int k) {
    Vec3f* here = around.data() + ((k + 1) * side + j + 1) * side + i + 1;
    const Vec3f node = corner + Vec3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)) * spacing;
    // All distances before the first comparison: they do not wait for each other.
    constexpr std::array<std::ptrdiff_t, 7> steps{0, -1, 1, -side, side, -side * side, side * side};
    std::array<float, steps.size()> squared;
    for (std::size_t n = 0; n < steps.size(); ++n) {
      const Vec3f away = node - here[steps[n]];
      squared[n] = glm::dot(away, away);
    }
    std::size_t nearest = 0;
    for (std::size_t n = 1; n < steps.size(); ++n) nearest = squared[n] < squared[nearest] ? n : nearest;
    if (nearest != 0) *here = here[steps[nearest]];
  };
  for (int k = 0; k < brick_edge; ++k) {
    for (int j = 0; j < brick_edge; ++j) {
      for (int i = 0; i < brick_edge; ++i) visit(i, j, k);
    }
  }
  for (int k = brick_edge; k-- > 0;) {
    for (int j = brick_edge; j-- > 0;) {
      for (int i = brick_edge; i-- > 0;) visit(i, j, k);
    }
  }
  bool changed = false;
  for (int k = 0; k < brick_edge; ++k) {
    for (int j = 0; j < brick_edge; ++j) {
      for (int i = 0; i < brick_edge; ++i) {
        Vec3f& point = closest[NodeBricks::at(i, j, k)];
        const Vec3f nearer = around[static_cast<std::size_t>(((k + 1) * side + j + 1) * side + i + 1)];
        changed = changed || nearer != before[slot * brick_nodes + NodeBricks::at(i, j, k)];
        point = nearer;
      }
    }
  }
  return changed;
}

/// Whether a brick or one that shares a face with it has changed.
bool changed_around(const NodeBricks& bricks, const std::vector<char>& changed, std::size_t slot) {
  const glm::ivec3 place = bricks.place[slot];
  for (int side = 0; side < 6; ++side) {
    glm::ivec3 at = place;
    at[side / 2] += side % 2 == 0 ? -1 : 1;
    const std::int32_t beside = bricks.slot_at(at.x, at.y, at.z);
    if (beside >= 0 && changed[static_cast<std::size_t>(beside)] != 0) return true;
  }
  return changed[slot] != 0;
}

}  // namespace

namespace {

/// In stretches of bricks, so that a thread takes few of them up.
template <typename Work>
void for_bricks(std::size_t count, int threads, const Work& work) {
  constexpr std::size_t stretch = 32;
  internal::parallel_for((count + stretch - 1) / stretch,
                         [&](std::size_t n) {
                           for (std::size_t slot = n * stretch; slot < std::min(count, (n + 1) * stretch); ++slot)
                             work(slot);
                         },
                         {}, threads);
}

}  // namespace

void spread_closest_points(const NodeBricks& bricks, double band_mm, int threads, std::vector<Vec3f>& closest,
                           std::vector<char> unsettled) {
  const std::size_t count = bricks.count();
  const Vec3& h = bricks.lattice.spacing;
  const double brick_mm = brick_edge * std::min({h.x, h.y, h.z});
  const int passes = 2 + static_cast<int>(std::ceil(band_mm / brick_mm));
  std::vector<Vec3f> next(closest.size());
  std::vector<char> changed = std::move(unsettled), changed_now(count);
  changed.resize(count, 1);
  for (int pass = 0; pass < passes; ++pass) {
    for_bricks(count, threads, [&](std::size_t slot) {
      const Vec3f* const here = closest.data() + slot * brick_nodes;
      changed_now[slot] = 0;
      if (changed_around(bricks, changed, slot)) {
        changed_now[slot] = spread(bricks, closest, slot, next.data() + slot * brick_nodes) ? 1 : 0;
      } else {
        std::copy_n(here, brick_nodes,
                    next.data() + slot * brick_nodes);  // what would come of the same once more
      }
    });
    closest.swap(next);
    changed.swap(changed_now);
  }
}

std::vector<Vec3f> closest_points(const NodeBricks& bricks, const std::vector<float>& f, double band_mm, int threads) {
  std::vector<Vec3f> closest(bricks.count() * brick_nodes);
  for_bricks(bricks.count(), threads,
             [&](std::size_t slot) { points_near_surface(bricks, f, slot, closest.data() + slot * brick_nodes); });
  spread_closest_points(bricks, band_mm, threads, closest);
  return closest;
}

}  // namespace palpate::io
