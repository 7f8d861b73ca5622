// Marching squares (Lorensen and Cline 1987, in a plane). In a cell whose corners alternate, the mean of the four
// decides whether the two corners above 0 are connected.

#include "io/structures/zero_lines.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <unordered_map>

namespace palpate::io {
namespace {

/// An edge of the lattice: twice its lower node's number, and one more where it runs along j.
using CellEdge = std::uint64_t;

struct Lattice {
  std::span<const double> values;
  glm::ivec2 nodes;

  std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nodes.x) + static_cast<std::size_t>(i);
  }
  double value(int i, int j) const { return values[at(i, j)]; }
  /// The edge on a cell's side: 0 below, 1 right, 2 above, 3 left.
  CellEdge side(int i, int j, int side) const {
    switch (side) {
      case 0:
        return 2 * at(i, j);
      case 1:
        return 2 * at(i + 1, j) + 1;
      case 2:
        return 2 * at(i, j + 1);
      default:
        return 2 * at(i, j) + 1;
    }
  }
  glm::dvec2 crossing(CellEdge edge) const {
    const auto node = static_cast<int>(edge / 2);
    const int i = node % nodes.x, j = node / nodes.x;
    const bool along_j = edge % 2 == 1;
    const double from = value(i, j), to = along_j ? value(i, j + 1) : value(i + 1, j);
    const double share = from / (from - to);
    return {i + (along_j ? 0 : share), j + (along_j ? share : 0)};
  }
};

/// Pieces of line through a cell: from side to side, with values above 0 on the left. Indexed by the bits of the
/// corners above 0: lower left, lower right, upper right, upper left.
struct LinePieces {
  int count = 0;
  std::array<std::array<int, 2>, 2> sides{};
};

LinePieces pieces_of(unsigned corners, bool is_joined) {
  switch (corners) {
    case 1:
      return {1, {{{0, 3}}}};
    case 2:
      return {1, {{{1, 0}}}};
    case 3:
      return {1, {{{1, 3}}}};
    case 4:
      return {1, {{{2, 1}}}};
    case 5:
      return is_joined ? LinePieces{2, {{{0, 1}, {2, 3}}}} : LinePieces{2, {{{0, 3}, {2, 1}}}};
    case 6:
      return {1, {{{2, 0}}}};
    case 7:
      return {1, {{{2, 3}}}};
    case 8:
      return {1, {{{3, 2}}}};
    case 9:
      return {1, {{{0, 2}}}};
    case 10:
      return is_joined ? LinePieces{2, {{{1, 2}, {3, 0}}}} : LinePieces{2, {{{1, 0}, {3, 2}}}};
    case 11:
      return {1, {{{1, 2}}}};
    case 12:
      return {1, {{{3, 1}}}};
    case 13:
      return {1, {{{0, 1}}}};
    case 14:
      return {1, {{{3, 0}}}};
    default:
      return {};
  }
}

}  // namespace

std::vector<ContourPolygon> zero_lines(std::span<const double> values, const glm::ivec2& nodes) {
  const Lattice lattice{values, nodes};
  std::unordered_map<CellEdge, CellEdge> next;
  std::vector<CellEdge> starts;  // in the lattice's order, so that the lines are
  for (int j = 0; j + 1 < nodes.y; ++j) {
    for (int i = 0; i + 1 < nodes.x; ++i) {
      const std::array corners{lattice.value(i, j), lattice.value(i + 1, j), lattice.value(i + 1, j + 1),
                               lattice.value(i, j + 1)};
      unsigned above = 0;
      for (unsigned n = 0; n < 4; ++n) above |= corners[n] > 0 ? 1U << n : 0U;
      const LinePieces pieces = pieces_of(above, corners[0] + corners[1] + corners[2] + corners[3] > 0);
      for (int n = 0; n < pieces.count; ++n) {
        const auto [from, to] = pieces.sides[static_cast<std::size_t>(n)];
        const CellEdge start = lattice.side(i, j, from);
        next.emplace(start, lattice.side(i, j, to));
        starts.push_back(start);
      }
    }
  }
  std::vector<ContourPolygon> lines;
  for (const CellEdge start : starts) {
    ContourPolygon line;
    CellEdge edge = start;
    for (auto at = next.find(edge); at != next.end(); at = next.find(edge)) {
      line.push_back(lattice.crossing(edge));
      edge = at->second;
      next.erase(at);
    }
    if (line.size() > 2) lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<ContourPolygon> thinned(const std::vector<ContourPolygon>& lines_mm) {
  constexpr double most_moved_mm = 0.01;
  std::vector<ContourPolygon> thin;
  for (const ContourPolygon& line : lines_mm) {
    std::vector<cv::Point2f> points, kept;
    points.reserve(line.size());
    for (const glm::dvec2& point : line) {
      points.emplace_back(static_cast<float>(point.x), static_cast<float>(point.y));
    }
    cv::approxPolyDP(points, kept, most_moved_mm, true);
    if (kept.size() < 3) continue;
    ContourPolygon& polygon = thin.emplace_back();
    polygon.reserve(kept.size());
    for (const cv::Point2f& point : kept) polygon.emplace_back(point.x, point.y);
  }
  return thin;
}

}  // namespace palpate::io
