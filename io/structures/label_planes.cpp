#include "io/structures/label_planes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace palpate::io {
namespace {

constexpr int finest = 8;  // nodes for one step between voxels, at most

/// Where the mask's slices lie on the lattice: node of a voxel = first + voxel * per_voxel, per axis.
struct Layout {
  glm::ivec3 per_voxel{1};
  std::vector<int> slice_node;          // of every slice of the box and of those beside it, along the third axis
  std::vector<glm::ivec2> slice_first;  // node of pixel 0, 0 of the whole lattice
  std::vector<int> slice;               // which slice of the whole lattice; -1: beside it, and empty
  glm::ivec2 low{0}, high{0};           // pixels around the box that are known, both ends included
};

/// mm: the least step between slices along their normal.
double least_step(const std::vector<double>& heights, double otherwise) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    least = std::min(least, heights[k + 1] - heights[k]);
  }
  return std::isfinite(least) && least > 1e-6 ? least : otherwise;
}

/// Squared distances along a row of nodes to the nearest seed; `far` where there is none.
void along_row(std::span<const std::uint8_t> seeds, std::uint8_t wanted, float step, std::span<float> squared) {
  constexpr float none = 1e6F;
  float from_last = none;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    from_last = seeds[i] == wanted ? 0.0F : from_last + step;
    squared[i] = from_last;
  }
  float from_next = none;
  for (std::size_t i = seeds.size(); i-- > 0;) {
    from_next = seeds[i] == wanted ? 0.0F : from_next + step;
    const float nearest = std::min(squared[i], from_next);
    squared[i] = nearest >= none ? PlaneDistances::far : nearest * nearest;
  }
}

/// The least over the rows within `reach` of what lies along the rows, plus the step across them, squared.
void across_rows(const std::vector<float>& along, int columns, int rows, float step, int reach,
                 std::vector<float>& nearest) {
  nearest = along;
  for (int t = 1; t <= reach; ++t) {
    const float farther = static_cast<float>(t) * step * static_cast<float>(t) * step;
    for (int j = 0; j < rows; ++j) {
      float* into = nearest.data() + static_cast<std::ptrdiff_t>(j) * columns;
      for (const int other : {j - t, j + t}) {
        if (other >= 0 && other < rows) {
          const float* from = along.data() + static_cast<std::ptrdiff_t>(other) * columns;
          for (int i = 0; i < columns; ++i) {
            into[i] = std::min(into[i], from[i] + farther);
          }
        }
      }
    }
  }
}

enum Seed : std::uint8_t { unknown = 0, in = 1, out = 2 };

}  // namespace

OutlinePlanes planes_of(const Mask& mask, double reach_mm) {
  const Geometry& geometry = mask.geometry;
  const Vec3 normal = glm::normalize(glm::cross(geometry.direction_i, geometry.direction_j));
  const Vec3 across = glm::cross(normal, geometry.direction_i);
  const int slices = geometry.dimensions.z;
  std::vector<double> heights;
  heights.reserve(geometry.slice_positions.size());
  for (const Vec3& position : geometry.slice_positions) {
    heights.push_back(glm::dot(position - geometry.slice_positions.front(), normal));
  }
  const double step = least_step(heights, std::max(glm::dot(geometry.step, normal), 0.01));
  const double finest_mm = std::min({geometry.spacing_i, geometry.spacing_j, step});
  Layout layout;
  const Vec3 voxel(geometry.spacing_i, geometry.spacing_j, step);
  bool tilted = false;
  bool uneven = false;
  for (int k = 0; k < slices; ++k) {
    const Vec3 slide = geometry.slice_positions[static_cast<std::size_t>(k)] - geometry.slice_positions.front();
    const double along_i = glm::dot(slide, geometry.direction_i) / geometry.spacing_i;
    const double along_j = glm::dot(slide, across) / geometry.spacing_j;
    tilted = tilted || std::abs(along_i - std::round(along_i)) > 0.02 || std::abs(along_j - std::round(along_j)) > 0.02;
    const double up = heights[static_cast<std::size_t>(k)] / step;
    uneven = uneven || std::abs(up - std::round(up)) > 0.02;
  }
  for (int a = 0; a < 3; ++a) {
    int parts = std::clamp(static_cast<int>(std::lround(voxel[a] / finest_mm)), 1, finest);
    if ((tilted && a < 2) || (uneven && a == 2)) {
      parts = std::min(2 * parts, finest);
    }
    layout.per_voxel[a] = parts;
  }
  OutlinePlanes planes;
  NodeLattice& lattice = planes.lattice;
  lattice.axes = glm::dmat3(geometry.direction_i, across, normal);
  lattice.spacing = voxel / Vec3(layout.per_voxel);
  planes.play_mm = glm::length(Vec3(geometry.spacing_i, geometry.spacing_j, step));
  planes.band_mm = band_for(reach_mm, lattice, planes.play_mm);

  // The box, and what is known around it, in pixels and slices.
  const glm::ivec3 around = glm::ivec3(glm::ceil(Vec3(planes.band_mm) / voxel)) + 1;
  const glm::ivec3 low = mask.low - around;
  const glm::ivec3 high = mask.low + mask.size - 1 + around;
  layout.low = glm::max(glm::ivec2(low), glm::ivec2(0));
  layout.high = glm::min(glm::ivec2(high), glm::ivec2(geometry.dimensions) - 1);
  const double base = heights.empty() ? 0.0 : heights[static_cast<std::size_t>(std::max(low.z, 0))];
  glm::dvec2 least_slide(std::numeric_limits<double>::infinity());
  glm::dvec2 most_slide(-std::numeric_limits<double>::infinity());
  std::vector<glm::dvec2> slides;
  for (int k = std::max(low.z, 0); k <= std::min(high.z, slices - 1); ++k) {
    const Vec3 slide = geometry.slice_positions[static_cast<std::size_t>(k)] - geometry.slice_positions.front();
    const glm::dvec2 in_nodes(glm::dot(slide, geometry.direction_i) / lattice.spacing.x,
                              glm::dot(slide, across) / lattice.spacing.y);
    slides.push_back(in_nodes);
    least_slide = glm::min(least_slide, in_nodes);
    most_slide = glm::max(most_slide, in_nodes);
    layout.slice.push_back(k);
    layout.slice_node.push_back(
        static_cast<int>(std::lround((heights[static_cast<std::size_t>(k)] - base) / lattice.spacing.z)));
  }
  // Room beyond what is known, so that the field goes on there.
  const glm::ivec3 room = glm::ivec3(glm::ceil(Vec3(planes.band_mm) / lattice.spacing));
  const glm::ivec2 first_node =
      glm::ivec2(glm::floor(least_slide)) + layout.low * glm::ivec2(layout.per_voxel) - glm::ivec2(room);
  const glm::ivec2 last_node =
      glm::ivec2(glm::ceil(most_slide)) + layout.high * glm::ivec2(layout.per_voxel) + glm::ivec2(room);
  for (std::size_t n = 0; n < slides.size(); ++n) {
    layout.slice_first.push_back(glm::ivec2(glm::round(slides[n])) - first_node);
    layout.slice_node[n] += room.z;
  }
  const int tall = layout.slice_node.empty() ? 1 : layout.slice_node.back() + room.z + 1;
  const glm::ivec3 size(last_node - first_node + 1, tall);
  lattice.bricks = (size + NodeBricks::edge - 1) / NodeBricks::edge;
  lattice.origin = geometry.slice_positions.front() + lattice.axes[0] * (first_node.x * lattice.spacing.x) +
                   lattice.axes[1] * (first_node.y * lattice.spacing.y) +
                   lattice.axes[2] * (base - room.z * lattice.spacing.z);
  planes.node = layout.slice_node;

  planes.compute = [&mask, layout, lattice, band = planes.band_mm](std::size_t plane, PlaneDistances& distances) {
    const int columns = lattice.bricks.x * NodeBricks::edge;
    const int rows = lattice.bricks.y * NodeBricks::edge;
    const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    std::vector<std::uint8_t> seeds(count, unknown);
    const int k = layout.slice[plane];
    for (int j = layout.low.y; j <= layout.high.y; ++j) {
      const int row = layout.slice_first[plane].y + j * layout.per_voxel.y;
      for (int i = layout.low.x; i <= layout.high.x; ++i) {
        const int column = layout.slice_first[plane].x + i * layout.per_voxel.x;
        if (row >= 0 && row < rows && column >= 0 && column < columns) {
          seeds[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)] =
              mask.inside(i, j, k) ? in : out;
        }
      }
    }
    std::vector<float> along(count);
    const int reach = static_cast<int>(std::ceil(band / lattice.spacing.y));
    for (const Seed wanted : {in, out}) {
      for (int j = 0; j < rows; ++j) {
        const auto first = static_cast<std::size_t>(j) * static_cast<std::size_t>(columns);
        along_row(std::span(seeds).subspan(first, static_cast<std::size_t>(columns)), wanted,
                  static_cast<float>(lattice.spacing.x),
                  std::span(along).subspan(first, static_cast<std::size_t>(columns)));
      }
      across_rows(along, columns, rows, static_cast<float>(lattice.spacing.y), reach,
                  wanted == in ? distances.to_inside : distances.to_outside);
    }
  };
  return planes;
}

}  // namespace palpate::io
