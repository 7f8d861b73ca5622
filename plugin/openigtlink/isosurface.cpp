#include "plugin/openigtlink/isosurface.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

namespace palpate::plugin::igtl {
namespace {

constexpr std::size_t most_cells = 60'000;
constexpr int block = 8;       // cells of the coarsest level, along an axis; a power of 2
constexpr double slack = 1.2;  // distances far from a surface are interpolated

struct Lattice {
  glm::dvec3 low{0};
  double step = 1;

  glm::dvec3 at(const glm::ivec3& node) const { return low + step * glm::dvec3(node); }
};

using Distance = std::function<SurfaceDistance(const glm::dvec3&)>;

std::uint64_t key_of(const glm::ivec3& node) {
  return static_cast<std::uint64_t>(node.x) << 42U | static_cast<std::uint64_t>(node.y) << 21U |
         static_cast<std::uint64_t>(node.z);
}

/// Adds the cells of a cube of cells that the surface may cross. False if there are too many.
bool add_cells(const Distance& distance, const Lattice& lattice, const glm::ivec3& low, int size,
               std::vector<glm::ivec3>& cells) {
  const glm::dvec3 middle = lattice.at(low) + 0.5 * size * lattice.step;
  if (std::abs(distance(middle).mm) > slack * 0.5 * std::sqrt(3.0) * size * lattice.step) return true;
  if (size == 1) {
    cells.push_back(low);
    return cells.size() <= most_cells;
  }
  for (int child = 0; child < 8; ++child) {
    const glm::ivec3 corner = low + size / 2 * glm::ivec3(child & 1, child >> 1 & 1, child >> 2);
    if (!add_cells(distance, lattice, corner, size / 2, cells)) return false;
  }
  return true;
}

std::optional<std::vector<glm::ivec3>> cells_of(const Distance& distance, const Lattice& lattice,
                                                const glm::ivec3& size) {
  std::vector<glm::ivec3> cells;
  for (int z = 0; z < size.z; z += block) {
    for (int y = 0; y < size.y; y += block) {
      for (int x = 0; x < size.x; x += block) {
        if (!add_cells(distance, lattice, {x, y, z}, block, cells)) return std::nullopt;
      }
    }
  }
  return cells;
}

/// The lattice of a surface: right-handed, with nodes.
struct Nodes {
  std::function<double(const glm::ivec3&)> height;  ///< positive inside; not a number: no surface is there
  std::function<glm::dvec3(const glm::ivec3&)> place;
  std::function<glm::dvec3(const glm::dvec3&)> settle;  ///< from near the surface on to it
};

class Nets {
 public:
  explicit Nets(Nodes nodes) : nodes_(std::move(nodes)) {}

  Surface of(const std::vector<glm::ivec3>& cells) {
    for (const glm::ivec3& cell : cells) add_vertex(cell);
    for (const glm::ivec3& cell : cells) {
      for (int axis = 0; axis < 3; ++axis) add_quad(cell, axis);
    }
    return std::move(surface_);
  }

 private:
  double height(const glm::ivec3& node) {
    const auto [found, fresh] = heights_.try_emplace(key_of(node), 0);
    if (fresh) found->second = nodes_.height(node);
    return found->second;
  }

  /// The mean of where the cell's edges are crossed, then on to the surface.
  void add_vertex(const glm::ivec3& cell) {
    glm::dvec3 sum(0);
    int crossings = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int edge = 0; edge < 4; ++edge) {
        glm::ivec3 from = cell, along(0);
        from[(axis + 1) % 3] += edge & 1;
        from[(axis + 2) % 3] += edge >> 1;
        along[axis] = 1;
        const double a = height(from), b = height(from + along);
        if (std::isnan(a + b)) return;
        if ((a > 0) == (b > 0)) continue;
        sum += glm::mix(nodes_.place(from), nodes_.place(from + along), a / (a - b));
        ++crossings;
      }
    }
    if (crossings == 0) return;
    vertices_[key_of(cell)] = static_cast<std::uint32_t>(surface_.points.size());
    surface_.points.push_back(nodes_.settle(sum / static_cast<double>(crossings)));
  }

  /// Around the edge that leaves the cell's first corner along an axis.
  void add_quad(const glm::ivec3& cell, int axis) {
    glm::ivec3 along(0), u(0), v(0);
    along[axis] = 1;
    u[(axis + 1) % 3] = 1;
    v[(axis + 2) % 3] = 1;
    const bool inside = height(cell) > 0;
    if (inside == (height(cell + along) > 0)) return;
    std::array<std::uint32_t, 4> corners{};
    std::size_t n = 0;
    for (const glm::ivec3& one : {cell - u - v, cell - v, cell, cell - u}) {
      const auto found = vertices_.find(key_of(one));
      if (found == vertices_.end()) return;  // at the end of the box
      corners[n++] = found->second;
    }
    if (!inside) std::swap(corners[1], corners[3]);
    surface_.triangles.push_back({corners[0], corners[1], corners[2]});
    surface_.triangles.push_back({corners[0], corners[2], corners[3]});
  }

  Nodes nodes_;
  std::unordered_map<std::uint64_t, double> heights_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
  Surface surface_;
};

/// Every few voxels of a scan, by index.
struct Voxels {
  const io::Volume& volume;
  double value = 0;
  glm::ivec3 step{1};

  glm::ivec3 size() const { return (volume.geometry.dimensions - 1) / step + 1; }
  double height(const glm::ivec3& node) const {
    const glm::ivec3 voxel = node * step;
    const bool missing = volume.is_padding(voxel.x, voxel.y, voxel.z);
    return missing ? std::numeric_limits<double>::quiet_NaN() : volume.value_at(voxel.x, voxel.y, voxel.z) - value;
  }
  glm::dvec3 place(const glm::ivec3& node) const { return volume.geometry.to_patient(glm::dvec3(node * step)); }
};

/// Those that the surface crosses. None if there are too many.
std::optional<std::vector<glm::ivec3>> cells_of(const Voxels& voxels) {
  std::vector<glm::ivec3> cells;
  const glm::ivec3 last = voxels.size() - 1;
  for (int z = 0; z < last.z; ++z) {
    const auto lies_here = [&](int gap) { return gap / voxels.step.z == z; };
    if (std::ranges::any_of(voxels.volume.geometry.gaps, lies_here)) continue;
    for (int y = 0; y < last.y; ++y) {
      int inside[2] = {};  // nodes of each of the two columns
      for (int x = -1; x < last.x; ++x) {
        inside[0] = inside[1];
        inside[1] = 0;
        for (int n = 0; n < 4; ++n) inside[1] += voxels.height({x + 1, y + (n & 1), z + (n >> 1)}) > 0 ? 1 : 0;
        if (x < 0 || inside[0] + inside[1] == 0 || inside[0] + inside[1] == 8) continue;
        cells.emplace_back(x, y, z);
        if (cells.size() > most_cells) return std::nullopt;
      }
    }
  }
  return cells;
}

}  // namespace

Surface isosurface(const Distance& distance, const io::Box& box) {
  for (double step = 1;; step *= 2) {
    const Lattice lattice{box.low - 2 * step, step};
    const glm::ivec3 size(glm::ceil((box.high - box.low) / step) + 4.0);
    const auto cells = cells_of(distance, lattice, size);
    if (!cells) continue;
    const auto settle = [&](const glm::dvec3& place) {
      const SurfaceDistance there = distance(place);
      const double slope = glm::dot(there.gradient, there.gradient);
      const bool is_near = slope > 0.25 && std::abs(there.mm) < lattice.step;
      return is_near ? place - there.mm / slope * there.gradient : place;
    };
    return Nets({.height = [&](const glm::ivec3& node) { return distance(lattice.at(node)).mm; },
                 .place = [&](const glm::ivec3& node) { return lattice.at(node); },
                 .settle = settle})
        .of(*cells);
  }
}

Surface isosurface(const io::Volume& volume, double value) {
  const io::Geometry& geometry = volume.geometry;
  const glm::dvec3 spacing(geometry.spacing_i, geometry.spacing_j, geometry.slice_spacing());
  const double finest = std::min({spacing.x, spacing.y, spacing.z});
  for (double mm = finest;; mm *= 2) {
    const Voxels voxels{volume, value, glm::max(glm::ivec3(glm::round(mm / spacing)), glm::ivec3(1))};
    const auto cells = cells_of(voxels);
    if (!cells) continue;
    return Nets({.height = [&](const glm::ivec3& node) { return voxels.height(node); },
                 .place = [&](const glm::ivec3& node) { return voxels.place(node); },
                 .settle = [](const glm::dvec3& place) { return place; }})
        .of(*cells);
  }
}

}  // namespace palpate::plugin::igtl
