#include "io/dicom/stacking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "io/messages.h"
#include "io/quantile.h"

namespace palpate::io::internal {
namespace {

constexpr double uniform_tolerance = 0.02;
constexpr double gap_factor = 1.5;

std::vector<double> intervals_of(const Geometry& geometry) {
  const Vec3 normal = glm::normalize(glm::cross(geometry.direction_i, geometry.direction_j));
  std::vector<double> intervals;
  for (std::size_t k = 1; k < geometry.slice_positions.size(); ++k) {
    intervals.push_back(glm::dot(geometry.slice_positions[k] - geometry.slice_positions[k - 1], normal));
  }
  return intervals;
}

// A second slice distance that the protocol asked for comes in runs; lost slices come one by one.
bool in_even_run(const std::vector<double>& intervals, std::size_t at) {
  const auto alike = [&](std::size_t k) { return std::abs(intervals[k] - intervals[at]) <= 0.05 * intervals[at]; };
  std::size_t first = at;
  std::size_t last = at;
  while (first > 0 && alike(first - 1)) --first;
  while (last + 1 < intervals.size() && alike(last + 1)) ++last;
  return last - first >= 2;
}

}  // namespace

std::string millimeters(double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  std::replace(text.begin(), text.end(), ',', '.');  // whatever the locale's decimal sign
  return std::string(text.data()) + " mm";
}

double height_of(const Vec3& position, const Placement& reference) {
  return glm::dot(position, glm::normalize(glm::cross(reference.direction_i, reference.direction_j)));
}

double same_place_mm(const Placement& reference) {
  return 0.02 * std::min(reference.spacing_i, reference.spacing_j);
}

Geometry stack_geometry(int columns, int rows, const Placement& reference, std::vector<Vec3> positions,
                        std::span<const Vec3> lost, double thickness) {
  Geometry geometry;
  geometry.dimensions = {columns, rows, static_cast<int>(positions.size())};
  geometry.direction_i = reference.direction_i;
  geometry.direction_j = reference.direction_j;
  geometry.spacing_i = reference.spacing_i;
  geometry.spacing_j = reference.spacing_j;
  geometry.slice_positions = std::move(positions);
  const auto& slices = geometry.slice_positions;

  const Vec3 normal = glm::normalize(glm::cross(reference.direction_i, reference.direction_j));
  geometry.step = normal * (thickness > 0 ? thickness : 1);
  if (slices.size() < 2) return geometry;

  geometry.step = (slices.back() - slices.front()) / static_cast<double>(slices.size() - 1);
  const auto intervals = intervals_of(geometry);
  const double median = quantile(intervals, 0.5);
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    const Vec3 step = slices[k + 1] - slices[k];
    if (glm::length(step - geometry.step) > uniform_tolerance * glm::length(geometry.step)) geometry.uniform = false;
    const bool holds_lost = std::any_of(lost.begin(), lost.end(), [&](const Vec3& position) {
      const double height = glm::dot(position - slices[k], normal);
      return height > 0 && height < intervals[k];
    });
    if (holds_lost || (intervals[k] > gap_factor * median && !in_even_run(intervals, k))) {
      geometry.gaps.push_back(static_cast<int>(k));
    }
  }
  return geometry;
}

std::vector<Text> geometry_warnings(const Geometry& geometry, double thickness) {
  std::vector<Text> warnings;
  const auto intervals = intervals_of(geometry);
  const double median = quantile(intervals, 0.5);
  for (const int k : geometry.gaps) {
    const double interval = intervals[static_cast<std::size_t>(k)];
    const auto missing = std::max(1L, std::lround(interval / median) - 1);
    const std::string apart = millimeters(interval), elsewhere = millimeters(median);
    warnings.push_back(missing == 1 ? say("slice-is-missing-between-slices", missing, k, k + 1, apart, elsewhere)
                                    : say("slices-are-missing-between", missing, k, k + 1, apart, elsewhere));
  }
  if (!geometry.uniform && geometry.gaps.empty()) {
    const auto [least, most] = std::minmax_element(intervals.begin(), intervals.end());
    const bool even = *most - *least < uniform_tolerance * median;
    warnings.push_back(even ? say("slices-displaced-sideways")
                            : say("slices-are-unevenly-spaced", millimeters(*least), millimeters(*most)));
  }
  constexpr double half = 0.55;
  if (median > 0 && median <= half * thickness) {
    warnings.push_back(say("slices-overlap", millimeters(thickness), millimeters(median)));
  }
  return warnings;
}

}  // namespace palpate::io::internal
