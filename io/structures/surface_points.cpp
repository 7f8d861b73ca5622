#include "io/structures/surface_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "io/parallel.h"

namespace palpate::io {
namespace {

constexpr int edge = 8;  // cells of a block along each axis

/// Blocks over a box.
struct Blocks {
  Vec3 origin;
  double spacing;  ///< of nodes, mm
  glm::ivec3 size;

  Blocks(const StructureBox& box, double spacing_mm)
      : origin(box.low_mm),
        spacing(spacing_mm),
        size(glm::ivec3(glm::ceil((box.high_mm - box.low_mm) / (edge * spacing_mm))) + 1) {}

  std::size_t layers() const { return static_cast<std::size_t>(size.z); }
  double width() const { return edge * spacing; }
  /// Farther from a block's middle than this, no surface is in the block.
  double reach() const { return 1.25 * (width() / 2 + spacing) * std::sqrt(3.0); }

  /// Calls `work` with the first corner of each block of a layer.
  template <typename Work>
  void for_layer(std::size_t layer, const Work& work) const {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) work(origin + width() * Vec3(x, y, static_cast<double>(layer)));
    }
  }
};

Vec3 normal_at(const SignedDistance& distance, const Vec3& at, double step) {
  Vec3 slope;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 aside(0);
    aside[axis] = step;
    slope[axis] = distance(at + aside) - distance(at - aside);
  }
  const double length = glm::length(slope);
  return length > 0 ? slope / length : Vec3(0, 0, 1);
}

/// Where the distance is 0 between two points with `from` and `to` there: linear, and once more with the value there.
Vec3 crossing(const SignedDistance& distance, const Vec3& a, double from, const Vec3& b, double to) {
  double share = from / (from - to);
  const Vec3 first = a + share * (b - a);
  const double left = distance(first);
  if ((left > 0) == (from > 0)) {
    share += (1 - share) * left / (left - to);
  } else {
    share *= from / (from - left);
  }
  return std::isfinite(share) ? a + std::clamp(share, 0.0, 1.0) * (b - a) : first;
}

void add_points(const SignedDistance& distance, const Vec3& corner, double spacing, std::vector<SurfacePoint>& points) {
  constexpr std::size_t wide = edge + 1;
  std::array<double, wide * wide * wide> values{};
  const auto at = [](int i, int j, int k) {
    return static_cast<std::size_t>(i) + wide * (static_cast<std::size_t>(j) + wide * static_cast<std::size_t>(k));
  };
  for (int k = 0; k <= edge; ++k) {
    for (int j = 0; j <= edge; ++j) {
      for (int i = 0; i <= edge; ++i) values[at(i, j, k)] = distance(corner + spacing * Vec3(i, j, k));
    }
  }
  for (int k = 0; k < edge; ++k) {
    for (int j = 0; j < edge; ++j) {
      for (int i = 0; i < edge; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          glm::ivec3 next(i, j, k);
          ++next[axis];
          const double from = values[at(i, j, k)], to = values[at(next.x, next.y, next.z)];
          if ((from > 0) == (to > 0)) continue;
          SurfacePoint point;
          point.at_mm = crossing(distance, corner + spacing * Vec3(i, j, k), from, corner + spacing * Vec3(next), to);
          const Vec3 normal = glm::abs(normal_at(distance, point.at_mm, spacing / 4));
          point.area_mm2 = spacing * spacing / (normal.x + normal.y + normal.z);
          points.push_back(point);
        }
      }
    }
  }
}

}  // namespace

StructureBox box_around(const SignedDistance& distance, StructureBox box) {
  constexpr int nodes = 24, most_times = 20;
  constexpr double step_mm = 2;
  for (int times = 0; times < most_times; ++times) {
    box.low_mm -= step_mm;
    box.high_mm += step_mm;
    bool leaves = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (int n = 0; n < 2 * (nodes + 1) * (nodes + 1); ++n) {
        Vec3 share;
        share[axis] = n % 2;
        const int column = n / 2 % (nodes + 1);
        share[(axis + 1) % 3] = static_cast<double>(column) / nodes;
        const int row = n / 2 / (nodes + 1);
        share[(axis + 2) % 3] = static_cast<double>(row) / nodes;
        leaves = leaves || distance(glm::mix(box.low_mm, box.high_mm, share)) > 0;
      }
    }
    if (!leaves) break;
  }
  return box;
}

std::vector<SurfacePoint> surface_points(const SignedDistance& distance, const StructureBox& box, double spacing_mm) {
  return surface_points_in(distance, box_around(distance, box), spacing_mm);
}

std::vector<SurfacePoint> surface_points_in(const SignedDistance& distance, const StructureBox& box,
                                            double spacing_mm) {
  const Blocks blocks(box, spacing_mm);
  std::vector<std::vector<SurfacePoint>> layers(blocks.layers());
  internal::parallel_for(
      layers.size(),
      [&](std::size_t layer) {
        blocks.for_layer(layer, [&](const Vec3& corner) {
          if (std::abs(distance(corner + blocks.width() / 2)) > blocks.reach()) return;
          add_points(distance, corner, spacing_mm, layers[layer]);
        });
      },
      {}, 0);
  std::vector<SurfacePoint> points;
  for (const std::vector<SurfacePoint>& layer : layers) points.insert(points.end(), layer.begin(), layer.end());
  return points;
}

SharedVolume shared_volume(const SignedDistance& first, const SignedDistance& second, const StructureBox& box,
                           double spacing_mm) {
  const Blocks blocks(box, spacing_mm);
  std::vector<SharedVolume> layers(blocks.layers());
  const double cell = spacing_mm * spacing_mm * spacing_mm;
  internal::parallel_for(
      layers.size(),
      [&](std::size_t layer) {
        SharedVolume& sum = layers[layer];
        blocks.for_layer(layer, [&](const Vec3& corner) {
          const Vec3 middle = corner + blocks.width() / 2;
          const std::array<double, 2> there{first(middle), second(middle)};
          const double reach = blocks.reach();
          if (there[0] < -reach && there[1] < -reach) return;
          for (int n = 0; n < edge * edge * edge; ++n) {
            const glm::ivec3 place(n % edge, n / edge % edge, n / (edge * edge));
            const Vec3 at = corner + spacing_mm * (Vec3(place) + 0.5);
            // Deep inside or far outside of one, its value in the middle says it for all of the block.
            const double a = std::abs(there[0]) > reach ? there[0] : first(at);
            const double b = std::abs(there[1]) > reach ? there[1] : second(at);
            const auto part = [&](double mm) { return std::clamp(0.5 + mm / spacing_mm, 0.0, 1.0) * cell; };
            sum.first_mm3 += part(a);
            sum.second_mm3 += part(b);
            sum.both_mm3 += part(std::min(a, b));
          }
        });
      },
      {}, 0);
  SharedVolume all;
  for (const SharedVolume& layer : layers) {
    all.first_mm3 += layer.first_mm3;
    all.second_mm3 += layer.second_mm3;
    all.both_mm3 += layer.both_mm3;
  }
  return all;
}

}  // namespace palpate::io
