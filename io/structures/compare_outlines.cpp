#include "io/structures/compare_outlines.h"

#define BOOST_ALLOW_DEPRECATED_HEADERS  // Boost's own, which they say of each other

#include <algorithm>
#include <boost/geometry.hpp>  // whole: which part a distance is in differs between Boost 1.74 and 1.83
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "io/errors.h"
#include "io/messages.h"
#include "io/parallel.h"
#include "io/structures/surface_points.h"

namespace palpate::io {
namespace {

namespace geometry = boost::geometry;
using TreePoint = geometry::model::point<double, 3, geometry::cs::cartesian>;

TreePoint tree_point(const Vec3& at) {
  return {at.x, at.y, at.z};
}

/// A surface with its points, to be asked for the nearest one.
class Surface {
 public:
  Surface(const ComparedOutline& outline, double spacing_mm)
      : outline_(outline), points_(surface_points(outline.distance, outline.box, spacing_mm)), tree_([&] {
          std::vector<TreePoint> all;
          all.reserve(points_.size());
          for (const SurfacePoint& point : points_) all.push_back(tree_point(point.at_mm));
          return geometry::index::rtree<TreePoint, geometry::index::linear<16>>(all);
        }()) {
    if (points_.empty()) throw DicomError(say("outline-has-no-surface"));
  }

  const std::vector<SurfacePoint>& points() const { return points_; }

  /// Near the surface by its own field, which is finer than the points.
  double distance_from(const Vec3& at) const {
    const double by_field = std::abs(outline_.distance(at));
    if (by_field <= outline_.true_to_mm) return by_field;
    TreePoint nearest;
    tree_.query(geometry::index::nearest(tree_point(at), 1), &nearest);
    return glm::length(at - Vec3(nearest.get<0>(), nearest.get<1>(), nearest.get<2>()));
  }
  /// Negative inside.
  double distance_outwards(const Vec3& at) const {
    return outline_.distance(at) > 0 ? -distance_from(at) : distance_from(at);
  }

 private:
  const ComparedOutline& outline_;
  std::vector<SurfacePoint> points_;
  geometry::index::rtree<TreePoint, geometry::index::linear<16>> tree_;
};

/// About a million points on the surface of the larger box at most, and a fine lattice for small structures.
double spacing_for(const StructureBox& a, const StructureBox& b) {
  constexpr double most_points = 1e6, finest_mm = 0.2, coarsest_mm = 2;
  double most_mm2 = 0;
  for (const StructureBox& box : {a, b}) {
    const Vec3 size = box.high_mm - box.low_mm;
    most_mm2 = std::max(most_mm2, 2 * (size.x * size.y + size.y * size.z + size.z * size.x));
  }
  return std::clamp(std::sqrt(most_mm2 / most_points), finest_mm, coarsest_mm);
}

struct Apart {
  double mm = 0, area_mm2 = 0;
  Vec3 at_mm{0};
};

void add_distances(const Surface& from, const Surface& to, std::vector<Apart>& all) {
  const std::size_t first = all.size(), count = from.points().size();
  all.resize(first + count);
  constexpr std::size_t part = 4096;
  internal::parallel_for((count + part - 1) / part,
                         [&](std::size_t n) {
                           for (std::size_t at = n * part; at < std::min(count, (n + 1) * part); ++at) {
                             const SurfacePoint& point = from.points()[at];
                             all[first + at] = {to.distance_from(point.at_mm), point.area_mm2, point.at_mm};
                           }
                         },
                         {}, 0);
}

}  // namespace

OutlineComparison compare_outlines(const ComparedOutline& first, const ComparedOutline& second) {
  const double spacing_mm = spacing_for(first.box, second.box);
  const Surface a(first, spacing_mm), b(second, spacing_mm);
  std::vector<Apart> all;
  add_distances(a, b, all);
  add_distances(b, a, all);
  std::ranges::stable_sort(all, {}, &Apart::mm);
  OutlineComparison result;
  double area = 0, moment = 0;
  for (const Apart& one : all) {
    area += one.area_mm2;
    moment += one.area_mm2 * one.mm;
  }
  result.mean_mm = moment / area;
  double below = 0;
  const auto p95 = std::ranges::find_if(all, [&](const Apart& one) { return (below += one.area_mm2) >= 0.95 * area; });
  result.p95_mm = p95 == all.end() ? all.back().mm : p95->mm;
  result.largest_mm = all.back().mm;
  result.largest_at_mm = all.back().at_mm;
  const StructureBox first_box = box_around(first.distance, first.box);
  const StructureBox second_box = box_around(second.distance, second.box);
  const StructureBox both{glm::min(first_box.low_mm, second_box.low_mm),
                          glm::max(first_box.high_mm, second_box.high_mm)};
  const SharedVolume shared = shared_volume(first.distance, second.distance, both, spacing_mm);
  result.dice = 2 * shared.both_mm3 / (shared.first_mm3 + shared.second_mm3);
  return result;
}

double margin_mm(const ComparedOutline& first, const ComparedOutline& second) {
  const double spacing_mm = spacing_for(first.box, second.box);
  const Surface a(first, spacing_mm), b(second, spacing_mm);
  double least = std::numeric_limits<double>::infinity();
  for (const SurfacePoint& point : a.points()) least = std::min(least, b.distance_outwards(point.at_mm));
  for (const SurfacePoint& point : b.points()) least = std::min(least, a.distance_outwards(point.at_mm));
  return least;
}

}  // namespace palpate::io
