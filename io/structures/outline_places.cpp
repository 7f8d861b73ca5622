#include "io/structures/outline_places.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace palpate::io {
namespace {

using internal::DistanceParts;

/// Where an edge of the lattice crosses the surface.
struct Crossing {
  glm::ivec3 cell{0};  ///< of `spacing_mm`
  int wall = 0;        ///< of the walls in that cell
  OutlinePlace place;
};

auto order_of(const Crossing& c) {
  return std::tuple(c.cell.z, c.cell.y, c.cell.x, c.wall);
}

std::vector<Crossing> crossings_of(const DistanceField& field, double spacing_mm) {
  const DistanceParts& parts = field.parts();
  const NodeLattice& lattice = parts.near.lattice;
  const Vec3& h = lattice.spacing;
  constexpr std::ptrdiff_t row = DistanceParts::wide;
  constexpr std::ptrdiff_t steps[3]{1, row, row * row};
  std::vector<Crossing> crossings;
  for (std::size_t slot = 0; slot < parts.near.count(); ++slot) {
    const glm::ivec3 corner = parts.near.place[slot] * NodeBricks::edge;
    for (int k = 0; k < NodeBricks::edge; ++k) {
      for (int j = 0; j < NodeBricks::edge; ++j) {
        for (int i = 0; i < NodeBricks::edge; ++i) {
          const float* here = parts.brick[slot] + ((k + 1) * row + j + 1) * row + i + 1;
          for (int axis = 0; axis < 3; ++axis) {
            const float there = here[steps[axis]];
            if ((*here > 0) == (there > 0)) continue;
            Vec3 node(corner + glm::ivec3(i, j, k));
            node[axis] += static_cast<double>(*here) / (static_cast<double>(*here) - there);
            Crossing crossing;
            crossing.place.place_mm = lattice.position(node);
            const Vec3 gradient = field.sample(crossing.place.place_mm).gradient;
            const double steep = glm::length(gradient);
            if (!(steep > 1e-3)) continue;
            crossing.place.inward = gradient / steep;
            crossing.place.area_mm2 =
                h[(axis + 1) % 3] * h[(axis + 2) % 3] * std::abs(glm::dot(crossing.place.inward, lattice.axes[axis]));
            crossing.cell = glm::ivec3(glm::floor(node * h / spacing_mm));
            crossings.push_back(crossing);
          }
        }
      }
    }
  }
  return crossings;
}

}  // namespace

std::vector<OutlinePlace> outline_places(const DistanceField& field, double spacing_mm) {
  std::vector<Crossing> crossings = crossings_of(field, spacing_mm);
  const auto by_order = [](const Crossing& a, const Crossing& b) { return order_of(a) < order_of(b); };
  std::ranges::stable_sort(crossings, by_order);
  for (std::size_t first = 0; first < crossings.size();) {
    std::size_t end = first;
    for (; end < crossings.size() && crossings[end].cell == crossings[first].cell; ++end) {
      crossings[end].wall = glm::dot(crossings[end].place.inward, crossings[first].place.inward) < 0 ? 1 : 0;
    }
    first = end;
  }
  std::ranges::stable_sort(crossings, by_order);
  std::vector<OutlinePlace> places;
  for (std::size_t first = 0; first < crossings.size();) {
    OutlinePlace all;
    std::size_t end = first;
    for (; end < crossings.size() && order_of(crossings[end]) == order_of(crossings[first]); ++end) {
      const OutlinePlace& one = crossings[end].place;
      all.area_mm2 += one.area_mm2;
      all.place_mm += one.area_mm2 * one.place_mm;
    }
    const Vec3 middle = all.place_mm / all.area_mm2;
    const auto begin = crossings.begin() + static_cast<std::ptrdiff_t>(first);
    const auto nearest = std::min_element(
        begin, crossings.begin() + static_cast<std::ptrdiff_t>(end), [&](const auto& a, const auto& b) {
          return glm::distance(a.place.place_mm, middle) < glm::distance(b.place.place_mm, middle);
        });
    Vec3 at = nearest->place.place_mm;
    for (int step = 0; step < 3; ++step) {
      const Distance there = field.sample(at);
      const double steep = glm::dot(there.gradient, there.gradient);
      if (steep > 0.1) at -= there.mm / steep * there.gradient;
    }
    places.push_back({at, nearest->place.inward, all.area_mm2});
    first = end;
  }
  return places;
}

}  // namespace palpate::io
