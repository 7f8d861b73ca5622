#include "io/structures/coarse_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace palpate::io {
namespace {

constexpr double finest_mm = 4;
constexpr double most_nodes = 4e5;

/// A lattice being filled with closest points, in mm of patient space.
struct Filling {
  const CoarseLattice& lattice;
  std::vector<Vec3f> closest;

  std::size_t at(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(lattice.size.y) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(lattice.size.x) +
           static_cast<std::size_t>(i);
  }
  Vec3f position(int i, int j, int k) const { return Vec3f(lattice.origin + Vec3(i, j, k) * lattice.spacing); }
  void offer(int i, int j, int k, const Vec3f& point) {
    const Vec3f node = position(i, j, k);
    Vec3f& best = closest[at(i, j, k)];
    if (glm::dot(node - point, node - point) < glm::dot(node - best, node - best)) {
      best = point;
    }
  }
};

void seed(const NodeBricks& bricks, const std::vector<Vec3f>& closest, Filling& filling) {
  const NodeLattice& lattice = bricks.lattice;
  const glm::ivec3 last = filling.lattice.size - 1;
  for (std::size_t slot = 0; slot < bricks.count(); ++slot) {
    for (int k = 0; k < NodeBricks::edge; k += 3) {
      for (int j = 0; j < NodeBricks::edge; j += 3) {
        for (int i = 0; i < NodeBricks::edge; i += 3) {
          const Vec3f& point = closest[slot * NodeBricks::nodes + NodeBricks::at(i, j, k)];
          if (point.x == nowhere) {
            continue;
          }
          const Vec3 node = lattice.position(Vec3(bricks.place[slot] * NodeBricks::edge + glm::ivec3(i, j, k)));
          const glm::ivec3 place = glm::clamp(
              glm::ivec3(glm::round((node - filling.lattice.origin) / filling.lattice.spacing)), glm::ivec3(0), last);
          filling.offer(place.x, place.y, place.z, Vec3f(lattice.origin + lattice.axes * Vec3(point)));
        }
      }
    }
  }
}

void sweep(Filling& filling) {
  const glm::ivec3 size = filling.lattice.size;
  std::array<std::ptrdiff_t, 13> steps;
  for (int n = 0; n < 13; ++n) {
    const std::ptrdiff_t row = size.x, plane = row * size.y;
    steps[static_cast<std::size_t>(n)] = (n / 9 - 1) * plane + (n / 3 % 3 - 1) * row + n % 3 - 1;
  }
  const auto visit = [&](int i, int j, int k, int behind) {
    const Vec3f node = filling.position(i, j, k);
    Vec3f best = filling.closest[filling.at(i, j, k)];
    float least = glm::dot(node - best, node - best);
    const auto take = [&](const Vec3f& point) {
      const float squared = glm::dot(node - point, node - point);
      if (!(squared < least)) return;
      least = squared;
      best = point;
    };
    // The thirteen neighbors that were visited before, in this direction.
    Vec3f* const here = filling.closest.data() + filling.at(i, j, k);
    if (i > 0 && j > 0 && k > 0 && i + 1 < size.x && j + 1 < size.y && k + 1 < size.z) {
      for (const std::ptrdiff_t step : steps) take(here[behind * step]);
    } else {
      for (int n = 0; n < 13; ++n) {
        const int x = i + behind * (n % 3 - 1), y = j + behind * (n / 3 % 3 - 1), z = k + behind * (n / 9 - 1);
        if (x >= 0 && y >= 0 && z >= 0 && x < size.x && y < size.y && z < size.z) {
          take(filling.closest[filling.at(x, y, z)]);
        }
      }
    }
    *here = best;
  };
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) visit(i, j, k, 1);
    }
  }
  for (int k = size.z; k-- > 0;) {
    for (int j = size.y; j-- > 0;) {
      for (int i = size.x; i-- > 0;) visit(i, j, k, -1);
    }
  }
}

bool is_inside(const NodeBricks& bricks, const std::vector<float>& f, const Vec3& position) {
  const Vec3 node = glm::round(bricks.lattice.node_of(position));
  if (!(glm::all(glm::greaterThanEqual(node, Vec3(0))) &&
        glm::all(glm::lessThan(node, Vec3(bricks.lattice.bricks * NodeBricks::edge))))) {
    return false;
  }
  const glm::ivec3 at(node);
  const glm::ivec3 place = at / NodeBricks::edge;
  const std::int32_t slot = bricks.slot_at(place.x, place.y, place.z);
  if (slot < 0) {
    return slot == NodeBricks::inside;
  }
  const glm::ivec3 in = at - place * NodeBricks::edge;
  return f[static_cast<std::size_t>(slot) * NodeBricks::nodes + NodeBricks::at(in.x, in.y, in.z)] > 0;
}

}  // namespace

CoarseLattice coarse_lattice(const Vec3& low_mm, const Vec3& high_mm) {
  CoarseLattice lattice;
  const Vec3 extent = glm::max(high_mm - low_mm, Vec3(1));
  lattice.spacing = std::max(finest_mm, std::cbrt(extent.x * extent.y * extent.z / most_nodes));
  lattice.size = glm::ivec3(glm::ceil(extent / lattice.spacing)) + 4;
  lattice.origin = low_mm - Vec3(1.5 * lattice.spacing);
  return lattice;
}

std::vector<Vec3f> closest_of(const CoarseLattice& coarse, const std::vector<Vec3f>& points) {
  Filling filling{coarse, std::vector<Vec3f>(coarse.count(), Vec3f(nowhere))};
  for (const Vec3f& point : points) {
    const glm::ivec3 place = glm::clamp(glm::ivec3(glm::round((Vec3(point) - coarse.origin) / coarse.spacing)),
                                        glm::ivec3(0), coarse.size - 1);
    filling.offer(place.x, place.y, place.z, point);
  }
  sweep(filling);
  return filling.closest;
}

std::vector<float> coarse_distances(const CoarseLattice& coarse, const NodeBricks& bricks, const std::vector<float>& f,
                                    const std::vector<Vec3f>& closest) {
  Filling filling{coarse, std::vector<Vec3f>(coarse.count(), Vec3f(nowhere))};
  seed(bricks, closest, filling);
  sweep(filling);
  std::vector<float> mm(coarse.count());
  for (int k = 0; k < coarse.size.z; ++k) {
    for (int j = 0; j < coarse.size.y; ++j) {
      for (int i = 0; i < coarse.size.x; ++i) {
        const Vec3f node = filling.position(i, j, k);
        const float distance = glm::length(node - filling.closest[filling.at(i, j, k)]);
        mm[filling.at(i, j, k)] = is_inside(bricks, f, Vec3(node)) ? distance : -distance;
      }
    }
  }
  return mm;
}

}  // namespace palpate::io
