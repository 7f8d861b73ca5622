#include "io/structures/keyholes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>

namespace palpate::io {
namespace {

/// By crossings of the ray along x.
bool holds(const ContourPolygon& polygon, const glm::dvec2& point) {
  bool inside = false;
  for (std::size_t n = 0, before = polygon.size() - 1; n < polygon.size(); before = n++) {
    const glm::dvec2 &a = polygon[before], &b = polygon[n];
    if ((a.y > point.y) == (b.y > point.y)) continue;
    if (point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

double signed_area(const ContourPolygon& polygon) {
  glm::dvec2 unused;
  return area_of({polygon}, unused);
}

/// From the nearest point of the outline to the hole, around it, and back.
void join(const ContourPolygon& hole, ContourPolygon& outline) {
  std::size_t from = 0, to = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < outline.size(); ++a) {
    for (std::size_t b = 0; b < hole.size(); ++b) {
      const glm::dvec2 apart = hole[b] - outline[a];
      if (const double squared = glm::dot(apart, apart); squared < least) {
        least = squared;
        from = a;
        to = b;
      }
    }
  }
  ContourPolygon way(hole.begin() + static_cast<std::ptrdiff_t>(to), hole.end());
  way.insert(way.end(), hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(to) + 1);
  way.push_back(outline[from]);
  outline.insert(outline.begin() + static_cast<std::ptrdiff_t>(from) + 1, way.begin(), way.end());
}

}  // namespace

std::vector<ContourPolygon> with_keyholes(const std::vector<ContourPolygon>& lines) {
  std::vector<ContourPolygon> outer, holes;
  for (const ContourPolygon& line : lines) (signed_area(line) > 0 ? outer : holes).push_back(line);
  std::vector<std::size_t> of(holes.size(), outer.size());  // the smallest outline around a hole
  for (std::size_t h = 0; h < holes.size(); ++h) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < outer.size(); ++n) {
      const double area = signed_area(outer[n]);
      if (area < least && holds(outer[n], holes[h].front())) {
        least = area;
        of[h] = n;
      }
    }
  }
  for (std::size_t h = 0; h < holes.size(); ++h) {
    if (of[h] < outer.size()) join(holes[h], outer[of[h]]);
  }
  return outer;
}

}  // namespace palpate::io
