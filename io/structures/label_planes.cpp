#include "io/structures/label_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <vector>

#include "io/errors.h"
#include "io/messages.h"
#include "io/quantile.h"
#include "io/structures/continued_mask.h"
#include "io/structures/fraction_edges.h"
#include "io/structures/scan_slices.h"

namespace palpate::io {
namespace {

constexpr int finest = 8;  // nodes for one step between voxels, at most

/// Where the mask's slices lie on the lattice: node of a voxel = first + voxel * per_voxel, per axis.
struct Layout {
  glm::ivec3 per_voxel{1};
  std::vector<int> slice;               // those of the box and those beside it, ascending
  std::vector<int> slice_node;          // of each, along the third axis
  std::vector<glm::ivec2> slice_first;  // node of pixel 0, 0 of the whole lattice
  glm::ivec2 low{0}, high{0};           // pixels around the box that are known, both ends included
};

/// mm: the least step between slices along their normal. Slices that nearly lie on each other do not count: they would
/// ask for far too many nodes.
double least_step(const std::vector<double>& heights, double otherwise) {
  std::vector<double> steps;
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) steps.push_back(heights[k + 1] - heights[k]);
  if (steps.empty()) return otherwise;
  constexpr double nearly = 0.1;  // of the typical step
  const double least = std::max(*std::ranges::min_element(steps), nearly * quantile(steps, 0.5));
  return least > 1e-6 ? least : otherwise;
}

/// Squared distances along a row of nodes to the nearest seed; `far` if there is none.
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

/// The minimum, over the rows within `reach`, of the distance along a row plus the squared step across rows.
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

/// The mask's slices in patient space: their axes, and how far each lies from the first.
struct Slices {
  const Geometry& geometry;
  Vec3 normal, across;          // unit vectors: of the planes, and along their columns
  std::vector<double> heights;  // along the normal, mm
  double step = 1;              // mm: the least between two heights
  bool is_whole = true;         // all steps are multiples of the least: then slices are nodes, or lie beside one

  Vec3 slide_of(const Vec3& position) const { return position - geometry.slice_positions.front(); }
  /// Slices that are no nodes go on by the mean step: where they begin decides how near they lie to nodes.
  Vec3 position_of(int k) const {
    if (is_whole) return slice_position(geometry, k);
    const int held = std::clamp(k, 0, geometry.dimensions.z - 1);
    return geometry.slice_positions[static_cast<std::size_t>(held)] + static_cast<double>(k - held) * geometry.step;
  }
  double height_of(int k) const { return glm::dot(slide_of(position_of(k)), normal); }
  Vec3 voxel() const { return {geometry.spacing_i, geometry.spacing_j, step}; }
};

Slices slices_of(const Geometry& geometry) {
  Slices slices{geometry, glm::normalize(glm::cross(geometry.direction_i, geometry.direction_j)), {}, {}, 1};
  slices.across = glm::cross(slices.normal, geometry.direction_i);
  slices.heights.reserve(geometry.slice_positions.size());
  for (const Vec3& position : geometry.slice_positions) {
    slices.heights.push_back(glm::dot(slices.slide_of(position), slices.normal));
  }
  slices.is_whole = has_whole_steps(geometry);
  slices.step = least_step(slices.heights, std::max(glm::dot(geometry.step, slices.normal), 0.01));
  return slices;
}

/// How many nodes lie between two voxels along each axis, so that tilted and uneven slices find a node near them.
glm::ivec3 nodes_per_voxel(const Slices& slices) {
  const Geometry& geometry = slices.geometry;
  constexpr double off = 0.02;  // of a voxel
  const auto is_off = [](double voxels) { return std::abs(voxels - std::round(voxels)) > off; };
  bool tilted = false;
  bool uneven = false;
  for (std::size_t k = 0; k < slices.heights.size(); ++k) {
    const Vec3 slide = slices.slide_of(geometry.slice_positions[k]);
    tilted = tilted || is_off(glm::dot(slide, geometry.direction_i) / geometry.spacing_i) ||
             is_off(glm::dot(slide, slices.across) / geometry.spacing_j);
    uneven = uneven || is_off(slices.heights[k] / slices.step);
  }
  const Vec3 voxel = slices.voxel();
  const double finest_mm = std::min({voxel.x, voxel.y, voxel.z});
  glm::ivec3 per_voxel(1);
  for (int a = 0; a < 3; ++a) {
    int parts = std::clamp(static_cast<int>(std::lround(voxel[a] / finest_mm)), 1, finest);
    if ((tilted && a < 2) || (uneven && a == 2)) {
      parts = std::min(2 * parts, finest);
    }
    // A power of two, so that the lattices of every second and every fourth node also contain all voxels.
    per_voxel[a] = static_cast<int>(std::bit_floor(static_cast<unsigned>(parts)));
  }
  return per_voxel;
}

int most_of(const glm::ivec3& parts) {
  return std::max({parts.x, parts.y, parts.z});
}

/// The slices of the box, and those beside it as far as the band reaches and one more.
std::vector<int> slices_around(const Mask& mask, const Slices& slices, double band_mm) {
  const int most = static_cast<int>(std::ceil(band_mm / slices.step)) + 1;
  const auto count = [&](int end, int side) {
    int n = 1;
    while (n < most &&
           (!slices.is_whole || std::abs(slices.height_of(end + side * (n - 1)) - slices.height_of(end)) < band_mm))
      ++n;
    return n;
  };
  const int high = mask.low.z + mask.size.z - 1;
  std::vector<int> all;
  for (int k = mask.low.z - count(mask.low.z, -1); k <= high + count(high, 1); ++k) all.push_back(k);
  return all;
}

/// mm: the largest step between slices of the box, or from one of them to the next. The least one where slices are no
/// nodes. More than 16 of the least are a gap, over which nothing is known.
double largest_step(const Mask& mask, const Slices& slices) {
  double largest = slices.step;
  if (!slices.is_whole) return largest;
  constexpr double gap = 16;
  for (int k = mask.low.z - 1; k < mask.low.z + mask.size.z; ++k) {
    largest = std::max(largest, slices.height_of(k + 1) - slices.height_of(k));
  }
  return std::min(largest, gap * slices.step);
}

/// Places the box and its known surroundings on the lattice, and determines the lattice's size and origin.
Layout lay_out(const Mask& mask, const Slices& slices, const glm::ivec3& per_voxel, double band_mm,
               NodeLattice& lattice) {
  const Geometry& geometry = slices.geometry;
  const glm::ivec2 around = glm::ivec2(glm::ceil(glm::dvec2(band_mm) / glm::dvec2(slices.voxel()))) + 1;
  Layout layout;
  layout.per_voxel = per_voxel;
  layout.slice = slices_around(mask, slices, band_mm);
  layout.low = glm::ivec2(mask.low) - around;
  layout.high = glm::ivec2(mask.low + mask.size) - 1 + around;
  // The first slice of the lattice is a node, and so are all that lie whole steps from it.
  const double below = slices.height_of(layout.slice.front()) / lattice.spacing.z;
  const double base = (slices.is_whole ? std::round(below) : below) * lattice.spacing.z;
  glm::dvec2 least_slide(std::numeric_limits<double>::infinity());
  glm::dvec2 most_slide(-std::numeric_limits<double>::infinity());
  std::vector<glm::dvec2> slides;
  for (const int k : layout.slice) {
    const Vec3 slide = slices.slide_of(slices.position_of(k));
    const glm::dvec2 in_nodes(glm::dot(slide, geometry.direction_i) / lattice.spacing.x,
                              glm::dot(slide, slices.across) / lattice.spacing.y);
    slides.push_back(in_nodes);
    least_slide = glm::min(least_slide, in_nodes);
    most_slide = glm::max(most_slide, in_nodes);
    layout.slice_node.push_back(static_cast<int>(std::lround((slices.height_of(k) - base) / lattice.spacing.z)));
  }
  // The known region reaches as far as the band; some more room keeps its nodes on the coarser lattices.
  const int room = most_of(per_voxel);
  const glm::ivec2 first_node = glm::ivec2(glm::floor(least_slide)) + layout.low * glm::ivec2(per_voxel) - room;
  const glm::ivec2 last_node = glm::ivec2(glm::ceil(most_slide)) + layout.high * glm::ivec2(per_voxel) + room;
  for (std::size_t n = 0; n < slides.size(); ++n) {
    layout.slice_first.push_back(glm::ivec2(glm::round(slides[n])) - first_node);
    layout.slice_node[n] += room;
  }
  const int tall = layout.slice_node.empty() ? 1 : layout.slice_node.back() + room + 1;
  const glm::ivec3 size(last_node - first_node + 1, tall);
  lattice.bricks = (size + NodeBricks::edge - 1) / NodeBricks::edge;
  lattice.origin = geometry.slice_positions.front() + lattice.axes[0] * (first_node.x * lattice.spacing.x) +
                   lattice.axes[1] * (first_node.y * lattice.spacing.y) +
                   lattice.axes[2] * (base - room * lattice.spacing.z);
  return layout;
}

/// The nodes of a plane that are voxels, and where the mask has fractions their known distances.
std::vector<std::uint8_t> seed_plane(const ContinuedMask& mask, const Layout& layout, const glm::ivec2& nodes,
                                     std::size_t plane, PlaneDistances& distances) {
  const auto count = static_cast<std::size_t>(nodes.x) * static_cast<std::size_t>(nodes.y);
  std::vector<std::uint8_t> seeds(count, unknown);
  const bool has_fractions = mask.mask().fractions != Mask::Fractions::none;
  if (has_fractions) distances.known.assign(count, std::numeric_limits<float>::quiet_NaN());
  const int k = layout.slice[plane];
  for (int j = layout.low.y; j <= layout.high.y; ++j) {
    const int row = layout.slice_first[plane].y + j * layout.per_voxel.y;
    for (int i = layout.low.x; i <= layout.high.x; ++i) {
      const int column = layout.slice_first[plane].x + i * layout.per_voxel.x;
      if (row >= 0 && row < nodes.y && column >= 0 && column < nodes.x) {
        const std::size_t node =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(nodes.x) + static_cast<std::size_t>(column);
        seeds[node] = mask.occupancy({i, j, k}) >= Mask::half ? in : out;
        if (has_fractions) distances.known[node] = edge_distance(mask, i, j, k);
      }
    }
  }
  return seeds;
}

void compute_plane(const ContinuedMask& mask, const Layout& layout, const NodeLattice& lattice, double band_mm,
                   std::size_t plane, PlaneDistances& distances) {
  const glm::ivec2 nodes(lattice.bricks * NodeBricks::edge);
  const std::vector<std::uint8_t> seeds = seed_plane(mask, layout, nodes, plane, distances);
  std::vector<float> along(seeds.size());
  const auto columns = static_cast<std::size_t>(nodes.x);
  const int reach = static_cast<int>(std::ceil(band_mm / lattice.spacing.y));
  for (const Seed wanted : {in, out}) {
    for (int j = 0; j < nodes.y; ++j) {
      const auto first = static_cast<std::size_t>(j) * columns;
      along_row(std::span(seeds).subspan(first, columns), wanted, static_cast<float>(lattice.spacing.x),
                std::span(along).subspan(first, columns));
    }
    across_rows(along, nodes.x, nodes.y, static_cast<float>(lattice.spacing.y), reach,
                wanted == in ? distances.to_inside : distances.to_outside);
  }
}

}  // namespace

OutlinePlanes planes_of(const Mask& mask, double reach_mm, const Geometry* scan) {
  const Slices slices = slices_of(mask.geometry);
  const glm::ivec3 per_voxel = nodes_per_voxel(slices);
  OutlinePlanes planes;
  planes.coarser = std::countr_zero(static_cast<unsigned>(most_of(per_voxel)));
  NodeLattice& lattice = planes.lattice;
  lattice.axes = glm::dmat3(mask.geometry.direction_i, slices.across, slices.normal);
  lattice.spacing = slices.voxel() / Vec3(per_voxel);
  planes.play_mm = glm::length(Vec3(glm::dvec2(slices.voxel()), largest_step(mask, slices)));
  planes.band_mm = band_for(reach_mm, lattice, planes.play_mm);
  const Layout layout = lay_out(mask, slices, per_voxel, planes.band_mm, lattice);
  const glm::dvec2 nodes(lattice.bricks * NodeBricks::edge);
  constexpr double most_nodes = 5e7;  // of a plane: those of patients have far fewer
  if (nodes.x * nodes.y > most_nodes) {
    const double tall_mm = slices.height_of(mask.low.z + mask.size.z - 1) - slices.height_of(mask.low.z);
    throw DicomError(say("slices-span-mm", std::lround(std::max(tall_mm, planes.play_mm))));
  }
  planes.node = layout.slice_node;
  planes.compute = [mask = ContinuedMask(mask, scan), layout, lattice, band = planes.band_mm](
                       std::size_t plane, PlaneDistances& distances) {
    compute_plane(mask, layout, lattice, band, plane, distances);
  };
  return planes;
}

}  // namespace palpate::io
