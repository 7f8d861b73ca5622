#include "plugin/openigtlink/isosurface.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <unordered_map>

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

class Nets {
 public:
  Nets(const Distance& distance, const Lattice& lattice) : distance_(distance), lattice_(lattice) {}

  Surface of(const std::vector<glm::ivec3>& cells) {
    for (const glm::ivec3& cell : cells) add_vertex(cell);
    for (const glm::ivec3& cell : cells) {
      for (int axis = 0; axis < 3; ++axis) add_quad(cell, axis);
    }
    return std::move(surface_);
  }

 private:
  double mm(const glm::ivec3& node) {
    const auto [found, fresh] = nodes_.try_emplace(key_of(node), 0);
    if (fresh) found->second = distance_(lattice_.at(node)).mm;
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
        const double a = mm(from), b = mm(from + along);
        if ((a > 0) == (b > 0)) continue;
        sum += glm::mix(lattice_.at(from), lattice_.at(from + along), a / (a - b));
        ++crossings;
      }
    }
    if (crossings == 0) return;
    glm::dvec3 vertex = sum / static_cast<double>(crossings);
    const SurfaceDistance there = distance_(vertex);
    const double slope = glm::dot(there.gradient, there.gradient);
    if (slope > 0.25 && std::abs(there.mm) < lattice_.step) vertex -= there.mm / slope * there.gradient;
    vertices_[key_of(cell)] = static_cast<std::uint32_t>(surface_.points.size());
    surface_.points.push_back(vertex);
  }

  /// Around the edge that leaves the cell's first corner along an axis.
  void add_quad(const glm::ivec3& cell, int axis) {
    glm::ivec3 along(0), u(0), v(0);
    along[axis] = 1;
    u[(axis + 1) % 3] = 1;
    v[(axis + 2) % 3] = 1;
    const bool inside = mm(cell) > 0;
    if (inside == (mm(cell + along) > 0)) return;
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

  const Distance& distance_;
  const Lattice& lattice_;
  std::unordered_map<std::uint64_t, double> nodes_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
  Surface surface_;
};

}  // namespace

Surface isosurface(const Distance& distance, const io::Box& box) {
  for (double step = 1;; step *= 2) {
    const Lattice lattice{box.low - 2 * step, step};
    const glm::ivec3 size(glm::ceil((box.high - box.low) / step) + 4.0);
    if (const auto cells = cells_of(distance, lattice, size)) return Nets(distance, lattice).of(*cells);
  }
}

}  // namespace palpate::plugin::igtl
