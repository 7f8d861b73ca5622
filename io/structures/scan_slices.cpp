#include "io/structures/scan_slices.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace palpate::io {
namespace {

/// The scan's slices along the mask's normal, ascending.
struct ScanSlices {
  std::vector<Vec3> at;
  std::vector<double> height;  // mm
};

std::optional<ScanSlices> slices_along(const Geometry& scan, const Vec3& normal) {
  constexpr double parallel = 1 - 1e-5;
  const double cosine = glm::dot(glm::normalize(glm::cross(scan.direction_i, scan.direction_j)), normal);
  if (std::abs(cosine) < parallel || scan.slice_positions.size() < 2) return std::nullopt;
  ScanSlices slices{scan.slice_positions, {}};
  if (cosine < 0) std::reverse(slices.at.begin(), slices.at.end());
  for (const Vec3& position : slices.at) slices.height.push_back(glm::dot(position, normal));
  return slices;
}

/// The slice at that height, within a twentieth of the step beside it.
std::optional<std::size_t> slice_at(const ScanSlices& scan, double height) {
  constexpr double near = 0.05;
  const auto above = std::lower_bound(scan.height.begin(), scan.height.end(), height);
  auto n = static_cast<std::size_t>(above - scan.height.begin());
  if (n == scan.height.size() || (n > 0 && height - scan.height[n - 1] < scan.height[n] - height)) --n;
  const double step = n > 0 ? scan.height[n] - scan.height[n - 1] : scan.height[1] - scan.height[0];
  if (std::abs(height - scan.height[n]) > near * step) return std::nullopt;
  return n;
}

/// A slice that the mask has, and which of the scan's it is.
struct Matched {
  std::size_t of_mask = 0, of_scan = 0;
};

/// The mask's slices, those that are only assumed left out. Empty if one is not the scan's.
std::vector<Matched> matched(const Mask& mask, const Vec3& normal, const ScanSlices& scan) {
  std::vector<Matched> slices;
  for (std::size_t k = 0; k < mask.geometry.slice_positions.size(); ++k) {
    if (std::ranges::binary_search(mask.assumed_slices, static_cast<int>(k))) continue;
    const auto found = slice_at(scan, glm::dot(mask.geometry.slice_positions[k], normal));
    if (!found || (!slices.empty() && slices.back().of_scan >= *found)) return {};
    slices.push_back({k, *found});
  }
  return slices;
}

/// mm: the smaller of the steps beside a slice. A gap beside it does not make it thick.
double thickness_of(const ScanSlices& scan, std::size_t n) {
  double least = std::numeric_limits<double>::infinity();
  if (n > 0) least = scan.height[n] - scan.height[n - 1];
  if (n + 1 < scan.height.size()) least = std::min(least, scan.height[n + 1] - scan.height[n]);
  return least;
}

/// Whether two of them are neighbors in the scan. A slice alone has to be as thick as the scan's, if its file says.
bool is_as_fine(const std::vector<Matched>& slices, const ScanSlices& scan, const Mask& mask) {
  if (slices.size() == 1) {
    constexpr double about = 1.5;
    return mask.has_no_thickness || mask.geometry.slice_spacing() < about * thickness_of(scan, slices.front().of_scan);
  }
  for (std::size_t n = 1; n < slices.size(); ++n) {
    if (slices[n].of_scan == slices[n - 1].of_scan + 1) return true;
  }
  return false;
}

/// Where the mask's lattice lies on a slice of the scan: as far along from its own slice as the scan's.
Vec3 place_on(const Mask& mask, const ScanSlices& scan, const Matched& own, std::size_t n, const Vec3& normal) {
  const Vec3 from = mask.geometry.slice_positions[own.of_mask], moved = scan.at[n] - scan.at[own.of_scan];
  const Vec3& step = mask.geometry.step;
  if (mask.geometry.slice_positions.size() < 2) return from + moved;
  return from + glm::dot(moved, normal) / glm::dot(step, normal) * step;
}

/// The box of occupancies on other slices: `to` holds the new slice of each.
void move_box(const std::vector<std::optional<int>>& to, Mask& mask) {
  const int low = mask.low.z, high = low + mask.size.z - 1;
  const auto slice_of = [&](int k) { return to[static_cast<std::size_t>(k)]; };
  const auto plane = static_cast<std::size_t>(mask.size.x) * static_cast<std::size_t>(mask.size.y);
  const int first = slice_of(low).value_or(0), last = slice_of(high).value_or(first);
  std::vector<std::uint8_t> occupancy(plane * static_cast<std::size_t>(last - first + 1));
  for (int k = low; k <= high; ++k) {
    const auto slice = slice_of(k);
    if (!slice) continue;  // only assumed: it is empty
    std::copy_n(mask.occupancy.begin() + static_cast<std::ptrdiff_t>(plane) * (k - low), plane,
                occupancy.begin() + static_cast<std::ptrdiff_t>(plane) * (*slice - first));
  }
  mask.low.z = first;
  mask.size.z = last - first + 1;
  mask.occupancy = std::move(occupancy);
}

}  // namespace

bool has_whole_steps(const Geometry& scan) {
  const Vec3 normal = glm::normalize(glm::cross(scan.direction_i, scan.direction_j));
  std::vector<double> steps;
  for (std::size_t k = 0; k + 1 < scan.slice_positions.size(); ++k) {
    steps.push_back(glm::dot(scan.slice_positions[k + 1] - scan.slice_positions[k], normal));
  }
  if (steps.empty()) return true;
  const double least = *std::ranges::min_element(steps);
  constexpr double off = 0.02;
  return std::ranges::all_of(steps,
                             [&](double step) { return std::abs(step / least - std::round(step / least)) <= off; });
}

void take_slices_of(const Geometry& scan, double around_mm, Mask& mask) {
  Geometry& geometry = mask.geometry;
  const Vec3 normal = glm::normalize(glm::cross(geometry.direction_i, geometry.direction_j));
  const auto slices = slices_along(scan, normal);
  if (!slices || mask.occupancy.empty()) return;
  const std::vector<Matched> own = matched(mask, normal, *slices);
  if (own.empty() || !is_as_fine(own, *slices, mask)) return;
  std::vector<Vec3> positions;
  std::vector<std::optional<int>> to(geometry.slice_positions.size());
  std::size_t next = 0;  // of `own`
  for (std::size_t n = 0; n < slices->at.size(); ++n) {
    if (slices->height[n] < slices->height[own.front().of_scan] - around_mm) continue;
    if (slices->height[n] > slices->height[own.back().of_scan] + around_mm) break;
    if (next < own.size() && own[next].of_scan == n) {
      to[own[next].of_mask] = static_cast<int>(positions.size());
      positions.push_back(geometry.slice_positions[own[next++].of_mask]);
    } else {
      positions.push_back(place_on(mask, *slices, own[next > 0 ? next - 1 : 0], n, normal));
    }
  }
  move_box(to, mask);
  mask.assumed_slices.clear();
  geometry.slice_positions = std::move(positions);
  geometry.dimensions.z = static_cast<int>(geometry.slice_positions.size());
  if (geometry.dimensions.z > 1) {
    geometry.step =
        (geometry.slice_positions.back() - geometry.slice_positions.front()) / (geometry.dimensions.z - 1.0);
  } else if (mask.has_no_thickness) {
    geometry.step = thickness_of(*slices, own.front().of_scan) * normal;
  }
}

}  // namespace palpate::io
