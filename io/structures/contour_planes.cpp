#include "io/structures/contour_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "io/errors.h"
#include "io/messages.h"
#include "io/structures/beyond_slices.h"

namespace palpate::io {
namespace {

using Polygon = std::vector<glm::dvec2>;

constexpr double finest_contour_mm = 0.5;
constexpr double coarsest_mm = 1.5;

/// Which columns of a row of nodes lie inside, by even-odd.
void fill_row(const std::vector<Polygon>& polygons, double y, double first, double step, std::vector<char>& inside) {
  std::vector<double> crossings;
  for (const Polygon& polygon : polygons) {
    for (std::size_t n = 0; n < polygon.size(); ++n) {
      const glm::dvec2& a = polygon[n];
      const glm::dvec2& b = polygon[(n + 1) % polygon.size()];
      if ((a.y > y) != (b.y > y)) crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
  }
  std::sort(crossings.begin(), crossings.end());
  std::fill(inside.begin(), inside.end(), 0);
  for (std::size_t n = 0; n + 1 < crossings.size(); n += 2) {
    const double from = std::ceil((crossings[n] - first) / step);
    const double to = std::floor((crossings[n + 1] - first) / step);
    for (double i = std::max(from, 0.0); i <= to && i < static_cast<double>(inside.size()); ++i) {
      inside[static_cast<std::size_t>(i)] = 1;
    }
  }
}

/// Squared distances of all nodes within the band to a segment.
void draw_segment(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& origin, const glm::dvec2& step,
                  const glm::ivec2& size, double band, std::vector<float>& squared) {
  const glm::dvec2 low = (glm::min(a, b) - band - origin) / step;
  const glm::dvec2 high = (glm::max(a, b) + band - origin) / step;
  const glm::ivec2 first = glm::max(glm::ivec2(glm::floor(low)), glm::ivec2(0));
  const glm::ivec2 last = glm::min(glm::ivec2(glm::ceil(high)), size - 1);
  const glm::dvec2 along = b - a;
  const double length = glm::dot(along, along);
  for (int j = first.y; j <= last.y; ++j) {
    for (int i = first.x; i <= last.x; ++i) {
      const glm::dvec2 at = origin + glm::dvec2(i, j) * step;
      const double part = length > 0 ? std::clamp(glm::dot(at - a, along) / length, 0.0, 1.0) : 0.0;
      const glm::dvec2 away = at - a - part * along;
      float& best =
          squared[static_cast<std::size_t>(j) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(i)];
      best = std::min(best, static_cast<float>(glm::dot(away, away)));
    }
  }
}

/// Planes of distances: the contours' own, and empty ones beyond their ends.
struct Layout {
  std::vector<const ContourStack::Plane*> planes;  ///< null: empty
  glm::dvec2 origin{0};
};

void compute_plane(const Layout& layout, const NodeLattice& lattice, double band, std::size_t n,
                   PlaneDistances& distances) {
  const glm::ivec2 size(lattice.bricks * NodeBricks::edge);
  const auto count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  distances.to_inside.assign(count, PlaneDistances::far);
  distances.to_outside.assign(count, 0);
  if (layout.planes[n] == nullptr) {
    return;
  }
  const std::vector<Polygon>& polygons = layout.planes[n]->polygons;
  const glm::dvec2 step(lattice.spacing);
  std::vector<float> squared(count, PlaneDistances::far);
  for (const Polygon& polygon : polygons) {
    for (std::size_t m = 0; m < polygon.size(); ++m) {
      draw_segment(polygon[m], polygon[(m + 1) % polygon.size()], layout.origin, step, size, band, squared);
    }
  }
  std::vector<char> inside(static_cast<std::size_t>(size.x));
  for (int j = 0; j < size.y; ++j) {
    fill_row(polygons, layout.origin.y + j * step.y, layout.origin.x, step.x, inside);
    for (int i = 0; i < size.x; ++i) {
      const std::size_t at =
          static_cast<std::size_t>(j) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(i);
      const bool is_in = inside[static_cast<std::size_t>(i)] != 0;
      distances.to_inside[at] = is_in ? 0 : squared[at];
      distances.to_outside[at] = is_in ? squared[at] : 0;
    }
  }
}

/// Around all polygons, in a plane.
struct Rectangle {
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};
};

Rectangle rectangle_around(const ContourStack& stack) {
  Rectangle all;
  for (const ContourStack::Plane& plane : stack.planes) {
    for (const Polygon& polygon : plane.polygons) {
      for (const glm::dvec2& point : polygon) {
        all.low = glm::min(all.low, point);
        all.high = glm::max(all.high, point);
      }
    }
  }
  return all;
}

/// The axes and spacing of the lattice, and the band that this spacing needs.
OutlinePlanes spaced_for(const ContourStack& stack, double reach_mm) {
  OutlinePlanes planes;
  NodeLattice& lattice = planes.lattice;
  lattice.axes = stack.axes;
  const double in_plane = std::clamp(stack.step_mm, finest_contour_mm, 1.0);
  // A power of two, so that the lattices of every second and every fourth node also contain all planes.
  const unsigned parts =
      std::bit_ceil(static_cast<unsigned>(std::clamp(std::ceil(stack.step_mm / coarsest_mm), 1.0, 8.0)));
  planes.coarser = std::countr_zero(parts);
  lattice.spacing = Vec3(in_plane, in_plane, stack.step_mm / parts);
  planes.play_mm = glm::length(Vec3(in_plane, in_plane, stack.step_mm));
  planes.band_mm = band_for(reach_mm, lattice, planes.play_mm);
  return planes;
}

/// A plane of the lattice: at its height the contours of `plane`; null: none.
struct Level {
  double height = 0;  // along the normal, mm
  const ContourStack::Plane* plane = nullptr;
};

/// Ascending: the contours' planes, the missing ones between them, and `beyond` more at each end.
std::vector<Level> levels_of(const ContourStack& stack, const Rectangle& all, int beyond,
                             const DistanceOptions& options) {
  std::vector<Level> levels;
  const glm::dvec2 middle = 0.5 * (all.low + all.high);
  // If the scan ends there, too, it is unknown whether the structure goes on: it is continued with the shape of its
  // end.
  const auto add_beyond = [&](double height, const ContourStack::Plane& end) {
    const bool is_empty = is_seen(options, stack.axes * Vec3(middle, height), stack.axes[2]);
    levels.push_back({height, is_empty ? nullptr : &end});
  };
  for (int n = beyond; n > 0; --n) {
    add_beyond(stack.planes.front().height - n * stack.step_mm, stack.planes.front());
  }
  for (std::size_t n = 0; n < stack.planes.size(); ++n) {
    const double height = stack.planes[n].height;
    // The surface goes on through planes that are missing; where many are, there are two bodies.
    const double from_last = n == 0 ? 0 : height - stack.planes[n - 1].height;
    for (double part = 1; !is_one_body(stack, from_last) && part * stack.step_mm < from_last - 1e-3; ++part) {
      levels.push_back({height - from_last + part * stack.step_mm, nullptr});
    }
    levels.push_back({height, &stack.planes[n]});
  }
  for (int n = 1; n <= beyond; ++n) {
    add_beyond(stack.planes.back().height + n * stack.step_mm, stack.planes.back());
  }
  return levels;
}

}  // namespace

OutlinePlanes planes_of(const ContourStack& stack, const DistanceOptions& options) {
  const Rectangle all = rectangle_around(stack);
  OutlinePlanes planes = spaced_for(stack, options.reach_mm);
  NodeLattice& lattice = planes.lattice;
  const double around = planes.band_mm + 2 * lattice.spacing.x;
  const int beyond = static_cast<int>(std::ceil(around / stack.step_mm));
  const double bottom = stack.planes.front().height - beyond * stack.step_mm;
  const auto node_at = [&](double height) {
    return static_cast<int>(std::lround((height - bottom) / lattice.spacing.z));
  };
  Layout layout;
  for (const Level& level : levels_of(stack, all, beyond, options)) {
    const int node = node_at(level.height);
    if (planes.node.empty() || node > planes.node.back()) {
      planes.node.push_back(node);
      layout.planes.push_back(level.plane);
    }
  }
  layout.origin = all.low - around;
  const glm::ivec2 size = glm::ivec2(glm::ceil((all.high - all.low + 2 * around) / lattice.spacing.x)) + 1;
  const int tall = node_at(stack.planes.back().height + beyond * stack.step_mm) + 1;
  lattice.bricks = (glm::ivec3(size, tall) + NodeBricks::edge - 1) / NodeBricks::edge;
  constexpr double most_nodes = 2e9;
  if (static_cast<double>(lattice.bricks.x) * lattice.bricks.y * lattice.bricks.z * 512 > most_nodes) {
    const double tall_mm = stack.planes.back().height - stack.planes.front().height;
    throw DicomError(say("contours-span-mm", std::lround(glm::length(Vec3(all.high - all.low, tall_mm)))));
  }
  lattice.origin = stack.axes * Vec3(layout.origin, bottom);
  planes.compute = [layout, lattice, band = planes.band_mm](std::size_t n, PlaneDistances& distances) {
    compute_plane(layout, lattice, band, n, distances);
  };
  return planes;
}

}  // namespace palpate::io
