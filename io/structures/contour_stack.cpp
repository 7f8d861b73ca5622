#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "io/dicom/stacking.h"
#include "io/errors.h"
#include "io/messages.h"
#include "io/quantile.h"
#include "io/structures/contour_planes.h"
#include "io/structures/contour_region.h"

namespace palpate::io {
namespace {

constexpr double least_apart_mm = 0.01;    // of two planes
constexpr double most_apart_mm = 0.1;      // of two contours in one plane that lean
constexpr double rounded_apart_mm = 0.05;  // of two contours in one plane whose heights were rounded differently
constexpr int most_planes = 4096;
constexpr double most_missing = 4.5;  // steps between two planes of one body

/// Along the contour's normal, of either sense. Its length is twice the area of the triangles from the first point: of
/// a contour that crosses itself, too.
Vec3 normal_along(const Contour& contour) {
  Vec3 sum(0);
  for (std::size_t n = 0; n + 1 < contour.size(); ++n) {
    const Vec3 triangle = glm::cross(contour[n] - contour.front(), contour[n + 1] - contour.front());
    sum += glm::dot(triangle, sum) < 0 ? -triangle : triangle;
  }
  return sum;
}

/// The unit normal of the largest contour and of those nearly parallel to it, so that rounded digits matter less.
Vec3 normal_of(const std::vector<Contour>& contours) {
  std::vector<Vec3> normals;
  normals.reserve(contours.size());
  Vec3 largest(0);
  for (const Contour& contour : contours) {
    normals.push_back(normal_along(contour));
    if (glm::length(normals.back()) > glm::length(largest)) largest = normals.back();
  }
  if (!(glm::length(largest) > 0)) throw DicomError(say("contours-have-no-area"));
  constexpr double nearly = 1 - 1e-5;
  Vec3 sum(0);
  for (const Vec3& normal : normals) {
    const double along = glm::dot(normal, largest);
    if (std::abs(along) > nearly * glm::length(normal) * glm::length(largest)) sum += along < 0 ? -normal : normal;
  }
  return glm::normalize(sum);
}

/// The axes of the patient where the planes lie along them, so that nothing is turned for rounding's sake.
glm::dmat3 axes_of(Vec3 normal) {
  for (int a = 0; a < 3; ++a) {
    if (std::abs(normal[a]) > 1 - 1e-10) {
      normal = Vec3(0);
      normal[a] = 1;
    }
  }
  const Vec3 along = std::abs(normal.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 i = glm::normalize(along - glm::dot(along, normal) * normal);
  return glm::dmat3(i, glm::cross(normal, i), normal);
}

/// A contour in the axes of its stack.
struct LevelContour {
  double height = 0;  // mm
  double leaning = 0;
  ContourPolygon polygon;
};

LevelContour level_contour(const Contour& contour, const glm::dmat3& axes) {
  LevelContour level;
  level.polygon.reserve(contour.size());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& point : contour) {
    const Vec3 at = glm::transpose(axes) * point;
    level.polygon.emplace_back(at);
    low = std::min(low, at.z);
    high = std::max(high, at.z);
  }
  // Not the mean: that is rounded by how many points there are.
  level.height = low + (high - low) / 2;
  level.leaning = high - low;
  if (!(level.leaning < 0.5)) throw DicomError(say("contours-do-not-lie-in-parallel"));
  return level;
}

/// Whether contours fall into planes no thicker than `mm` that are clearly farther apart than that.
bool fall_into_planes(const std::vector<LevelContour>& ascending, double mm) {
  constexpr double clearly = 3;
  double first = ascending.front().height, last = first;
  for (const LevelContour& contour : ascending) {
    const double gap = contour.height - last;
    if (gap > clearly * mm) first = contour.height;
    if (contour.height - first > mm) return false;
    last = contour.height;
  }
  return true;
}

/// How far apart two contours of one plane may be, mm.
double same_plane_mm(const std::vector<LevelContour>& ascending) {
  std::vector<double> leaning;
  leaning.reserve(ascending.size());
  for (const LevelContour& contour : ascending) leaning.push_back(contour.leaning);
  const double least = fall_into_planes(ascending, rounded_apart_mm) ? rounded_apart_mm : least_apart_mm;
  return std::clamp(quantile(std::move(leaning), 0.5), least, most_apart_mm);
}

std::vector<double> steps_of(const ContourStack& stack) {
  std::vector<double> steps;
  for (std::size_t n = 1; n < stack.planes.size(); ++n) {
    steps.push_back(stack.planes[n].height - stack.planes[n - 1].height);
  }
  return steps;
}

void warn_of_uneven_steps(ContourStack& stack) {
  constexpr double even = 0.1;
  std::vector<double> odd = steps_of(stack);
  std::erase_if(odd, [&](double step) { return std::abs(step - stack.step_mm) <= even * stack.step_mm; });
  if (odd.empty()) return;
  const auto [least, most] = std::ranges::minmax(odd);
  stack.warnings.push_back(say("contours-lie-unevenly", internal::millimeters(stack.step_mm), odd.size(),
                               internal::millimeters(least), internal::millimeters(most),
                               internal::millimeters(most_missing * stack.step_mm)));
}

/// Computes the region filled by the contours of each plane.
void fill_planes(ContourStack& stack, bool is_exclusive) {
  int doubled = 0, overlapping = 0;
  for (ContourStack::Plane& plane : stack.planes) {
    ContourRegion region = region_of(plane.polygons, is_exclusive);
    plane.polygons = std::move(region.edges);
    doubled += region.doubled;
    overlapping += region.is_overlap ? 1 : 0;
  }
  if (doubled > 0) stack.warnings.push_back(say("contours-are-there-twice", doubled));
  if (overlapping > 0) stack.warnings.push_back(say("contours-overlap", overlapping));
}

}  // namespace

ContourStack stack_of(const std::vector<Contour>& contours, const ContourRule& rule) {
  if (contours.empty()) throw DicomError(say("no-contour"));
  ContourStack stack;
  stack.axes = axes_of(normal_of(contours));
  std::vector<LevelContour> levels;
  levels.reserve(contours.size());
  for (const Contour& contour : contours) levels.push_back(level_contour(contour, stack.axes));
  std::ranges::stable_sort(levels, {}, &LevelContour::height);
  const double same_mm = same_plane_mm(levels);
  double last = -std::numeric_limits<double>::infinity();
  for (LevelContour& level : levels) {
    if (level.height - last > same_mm) stack.planes.push_back({level.height, {}});
    stack.planes.back().polygons.push_back(std::move(level.polygon));
    last = level.height;
  }
  if (static_cast<int>(stack.planes.size()) > most_planes) {
    throw DicomError(say("contours-lie-in-planes", stack.planes.size()));
  }
  fill_planes(stack, rule.is_exclusive);
  std::erase_if(stack.planes, [](const ContourStack::Plane& plane) { return plane.polygons.empty(); });
  if (stack.planes.empty()) throw DicomError(say("contours-have-no-area"));
  stack.step_mm = rule.thickness_mm > 0 ? rule.thickness_mm : 1;
  if (stack.planes.size() > 1) stack.step_mm = quantile(steps_of(stack), 0.5);
  warn_of_uneven_steps(stack);
  return stack;
}

double thickness_of_voxels(const Geometry& scan, const Vec3& normal) {
  const Vec3 across = glm::cross(scan.direction_i, scan.direction_j);
  double best = 0, thickness = 0;
  for (const auto& [axis, spacing] : {std::pair{across, scan.slice_spacing()},
                                      {scan.direction_i, scan.spacing_i},
                                      {scan.direction_j, scan.spacing_j}}) {
    if (const double along = std::abs(glm::dot(axis, normal)); along > best) {
      best = along;
      thickness = spacing;
    }
  }
  return thickness;
}

bool is_one_body(const ContourStack& stack, double apart_mm) {
  return apart_mm <= most_missing * stack.step_mm;
}

StructureMeasures measures_of(const std::vector<Contour>& contours, const ContourRule& rule) {
  const ContourStack stack = stack_of(contours, rule);
  StructureMeasures measures;
  measures.contours = contours.size();
  measures.box_low_mm = Vec3(std::numeric_limits<double>::infinity());
  measures.box_high_mm = -measures.box_low_mm;
  for (const Contour& contour : contours) {
    for (const Vec3& point : contour) {
      measures.box_low_mm = glm::min(measures.box_low_mm, point);
      measures.box_high_mm = glm::max(measures.box_high_mm, point);
    }
  }
  const std::vector<double> steps = steps_of(stack);
  const auto half_way = [&](std::size_t step) {
    return (step < steps.size() && is_one_body(stack, steps[step]) ? steps[step] : stack.step_mm) / 2;
  };
  Vec3 moment(0);
  for (std::size_t n = 0; n < stack.planes.size(); ++n) {
    const double below = half_way(n - 1), above = half_way(n);  // n - 1 of the first wraps: no such step
    glm::dvec2 in_plane;
    const double area = area_of(stack.planes[n].polygons, in_plane);
    const double volume = area * (below + above);
    measures.volume_mm3 += volume;
    moment += Vec3((below + above) * in_plane, volume * (stack.planes[n].height + (above - below) / 2));
  }
  measures.centroid_mm = stack.axes * (moment / measures.volume_mm3);
  if (stack.planes.size() == 1 && !(rule.thickness_mm > 0)) measures.warnings.push_back(say("contours-in-one-plane"));
  return measures;
}

}  // namespace palpate::io
