#include "io/structures/contour_region.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>
#include <limits>
#include <polyclipping/clipper.hpp>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

using ClipperLib::Paths;

constexpr double units_per_mm = 1e9;  // of the library's whole numbers
constexpr double widest_mm = 1e6;
constexpr double crack_mm = 0.01;

/// One contour, alone.
struct FilledContour {
  Paths edges;
  double area_mm2 = 0;
  double around_mm = 0;
  glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  std::size_t points = 0;
};

Paths combined(const Paths& subject, const Paths& clip, ClipperLib::ClipType how, ClipperLib::PolyFillType fill) {
  ClipperLib::Clipper clipper;
  clipper.AddPaths(subject, ClipperLib::ptSubject, true);
  clipper.AddPaths(clip, ClipperLib::ptClip, true);
  Paths result;
  clipper.Execute(how, result, fill, fill);
  return result;
}

double area_mm2(const Paths& edges) {
  double area = 0;
  for (const ClipperLib::Path& path : edges) area += ClipperLib::Area(path) / (units_per_mm * units_per_mm);
  return area;
}

FilledContour filled_contour(const ContourPolygon& polygon, const glm::dvec2& base) {
  FilledContour filled;
  ClipperLib::Path path;
  path.reserve(polygon.size());
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    filled.low = glm::min(filled.low, polygon[n]);
    filled.high = glm::max(filled.high, polygon[n]);
    filled.around_mm += glm::distance(polygon[n], polygon[(n + 1) % polygon.size()]);
    const glm::dvec2 at = (polygon[n] - base) * units_per_mm;
    if (!(std::max(std::abs(at.x), std::abs(at.y)) < widest_mm * units_per_mm)) {
      const double span = glm::distance(polygon[n], base);
      throw DicomError(say("contours-span-mm", std::lround(std::min(span, 1e12))));
    }
    path.emplace_back(std::llround(at.x), std::llround(at.y));
  }
  // The average number of edges that a line crosses; in drawn contours it is small.
  double up_and_down = 0;
  for (std::size_t n = 0; n < polygon.size(); ++n)
    up_and_down += std::abs(polygon[n].y - polygon[n == 0 ? polygon.size() - 1 : n - 1].y);
  const double met = up_and_down / std::max(filled.high.y - filled.low.y, 1e-9);
  if (met > 50 && met * static_cast<double>(polygon.size()) > 2e5) {
    throw DicomError(say("contour-crosses-itself-too-often", polygon.size()));
  }
  filled.edges = combined({path}, {}, ClipperLib::ctUnion, ClipperLib::pftEvenOdd);
  for (const ClipperLib::Path& edge : filled.edges) filled.points += edge.size();
  filled.area_mm2 = area_mm2(filled.edges);
  return filled;
}

bool boxes_meet(const FilledContour& a, const FilledContour& b) {
  return glm::all(glm::lessThanEqual(a.low, b.high + crack_mm)) &&
         glm::all(glm::lessThanEqual(b.low, a.high + crack_mm));
}

double shared_mm2(const FilledContour& a, const FilledContour& b) {
  return area_mm2(combined(a.edges, b.edges, ClipperLib::ctIntersection, ClipperLib::pftEvenOdd));
}

/// Whether all of it lies within another one, as far as a crack's width.
bool is_within(const FilledContour& contour, double shared) {
  return contour.area_mm2 - shared <= crack_mm * contour.around_mm;
}

/// Takes away each contour that is there already. Returns how many.
int take_away_doubled(std::vector<FilledContour>& contours) {
  std::vector<FilledContour> kept;
  for (FilledContour& contour : contours) {
    const bool is_again = std::ranges::any_of(kept, [&](const FilledContour& other) {
      const double around = std::max(contour.around_mm, other.around_mm);
      if (!(std::abs(contour.area_mm2 - other.area_mm2) <= crack_mm * around) || !boxes_meet(contour, other)) {
        return false;
      }
      const double shared = shared_mm2(contour, other);
      return is_within(contour, shared) && is_within(other, shared);
    });
    if (!is_again) kept.push_back(std::move(contour));
  }
  const auto doubled = static_cast<int>(contours.size() - kept.size());
  contours = std::move(kept);
  return doubled;
}

/// Reverses contours inside an odd number of others, and finds contours that touch or cross.
void turn_holes(std::vector<FilledContour>& contours, bool& meet, bool& overlap) {
  constexpr std::size_t most_points = 2'000'000;
  std::size_t points = 0;
  std::vector<int> depth(contours.size(), 0);
  for (std::size_t n = 0; n < contours.size(); ++n) {
    for (std::size_t m = 0; m < n; ++m) {
      const FilledContour &a = contours[m], &b = contours[n];
      if (!boxes_meet(a, b)) continue;
      points += a.points + b.points;
      if (points > most_points) throw DicomError(say("contours-overlap-too-often", contours.size()));
      const double shared = shared_mm2(a, b);
      const bool is_a_in_b = is_within(a, shared), is_b_in_a = is_within(b, shared);
      depth[m] += is_a_in_b ? 1 : 0;
      depth[n] += is_b_in_a ? 1 : 0;
      if (is_a_in_b || is_b_in_a) continue;
      meet = true;
      overlap = overlap || shared > crack_mm * std::min(a.around_mm, b.around_mm);
    }
  }
  for (std::size_t n = 0; n < contours.size(); ++n) {
    if (depth[n] % 2 != 0) ClipperLib::ReversePaths(contours[n].edges);
  }
}

Paths grown(const Paths& edges, double by_mm) {
  constexpr double sharpest = 1000;  // lengths of `by_mm` that a corner may be moved by
  ClipperLib::ClipperOffset offset(sharpest);
  offset.AddPaths(edges, ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
  Paths result;
  offset.Execute(result, by_mm * units_per_mm);
  return result;
}

}  // namespace

ContourRegion region_of(const std::vector<ContourPolygon>& contours, bool is_exclusive) {
  ContourRegion region;
  const auto first = std::ranges::find_if(contours, [](const ContourPolygon& one) { return !one.empty(); });
  if (first == contours.end()) return region;
  const glm::dvec2 base = first->front();
  std::vector<FilledContour> filled;
  filled.reserve(contours.size());
  for (const ContourPolygon& contour : contours) {
    filled.push_back(filled_contour(contour, base));
    if (!(filled.back().area_mm2 > 0)) filled.pop_back();
  }
  Paths edges;
  if (filled.size() == 1) {
    edges = filled.front().edges;
  } else {
    bool meet = is_exclusive;
    if (!is_exclusive) {
      region.doubled = take_away_doubled(filled);
      turn_holes(filled, meet, region.is_overlap);
    }
    Paths all;
    for (FilledContour& contour : filled) std::ranges::move(contour.edges, std::back_inserter(all));
    const auto fill = is_exclusive ? ClipperLib::pftEvenOdd : ClipperLib::pftPositive;
    edges = combined(all, {}, ClipperLib::ctUnion, fill);
    if (meet) edges = grown(grown(edges, crack_mm / 2), -crack_mm / 2);
  }
  for (const ClipperLib::Path& path : edges) {
    ContourPolygon& polygon = region.edges.emplace_back();
    for (const ClipperLib::IntPoint& point : path) {
      polygon.push_back(base + glm::dvec2(static_cast<double>(point.X), static_cast<double>(point.Y)) / units_per_mm);
    }
  }
  return region;
}

double area_of(const std::vector<ContourPolygon>& edges, glm::dvec2& moment) {
  double area = 0;
  moment = glm::dvec2(0);
  for (const ContourPolygon& polygon : edges) {
    const glm::dvec2 base = polygon.front();
    double own = 0;
    for (std::size_t n = 0; n < polygon.size(); ++n) {
      const glm::dvec2 a = polygon[n] - base, b = polygon[(n + 1) % polygon.size()] - base;
      const double triangle = (a.x * b.y - a.y * b.x) / 2;
      own += triangle;
      moment += triangle / 3 * (a + b);
    }
    area += own;
    moment += own * base;
  }
  return area;
}

}  // namespace palpate::io
