#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "io/messages.h"
#include "io/structures/edit_changes.h"

namespace palpate::io::internal {
namespace {

constexpr double most_seam_mm = 2;
constexpr double thinner = 20;      // of the radius: a path is drawn with many more points than it needs
constexpr double beyond_nodes = 6;  // so that the numbers are the new ones wherever the surface is looked for

/// The larger of two numbers where they differ by `seam` or more, and once differentiable (I. Quilez's polynomial).
double smooth_maximum(double a, double b, double seam) {
  const double h = std::max(seam - std::abs(a - b), 0.0);
  return std::max(a, b) + h * h / (4 * seam);
}

/// How far a ball's surface lies from the old one, on the side that changes.
double bulge_of(const DistanceField& before, const Vec3& center, double radius_mm, double sign) {
  double most = 0;
  const auto look = [&](const Vec3& way) {
    const double length = glm::length(way);
    if (length > 0) most = std::max(most, -sign * before.sample(center + radius_mm / length * way).mm);
  };
  look(-sign * before.sample(center).gradient);
  for (int n = 0; n < 27; ++n) look(Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
  return most;
}

double largest_of(const DistanceField& before, const FieldChange& change, double radius_mm, double sign) {
  constexpr double apart_mm = 0.5;
  double largest = 0;
  for (const Stretch& stretch : change.where) {
    const int steps = static_cast<int>(std::clamp(glm::distance(stretch.from, stretch.to) / apart_mm, 1.0, 1000.0));
    for (int n = 0; n <= steps; ++n) {
      const Vec3 at = glm::mix(stretch.from, stretch.to, static_cast<double>(n) / steps);
      largest = std::max(largest, bulge_of(before, at, radius_mm, sign));
    }
  }
  return largest;
}

/// `sign` 1: joined; -1: cut.
Field with_tube(const Field& before, const Tube& tube, double sign, int threads, EditOutcome& outcome) {
  const DistanceParts& parts = before->parts();
  const Vec3 high = parts.far.origin + Vec3(parts.far.size - 1) * parts.far.spacing;
  for (std::size_t n = 0; n < tube.path_mm.size(); ++n) {
    const Vec3& place = tube.path_mm[n];
    if (place != glm::clamp(place, parts.far.origin, high)) throw InvalidInput(say("edit-lies-off-the-scan", n + 1));
  }
  FieldChange change;
  const std::vector<Vec3> path = thinned_path(tube.path_mm, tube.radius_mm / thinner);
  for (std::size_t n = 0; n < path.size(); ++n) change.where.push_back({path[n == 0 ? 0 : n - 1], path[n]});
  outcome.points = tube.path_mm.size();
  outcome.largest_mm = largest_of(*before, change, tube.radius_mm, sign);
  const Vec3& h = parts.near.lattice.spacing;
  const double seam = std::min(most_seam_mm, tube.radius_mm);
  change.touched_mm = tube.radius_mm + seam;
  change.within_mm = change.touched_mm + beyond_nodes * std::max({h.x, h.y, h.z});
  change.after = [&](const Vec3& at, double mm, std::span<const std::uint32_t> near) {
    double nearest = change.within_mm;
    for (const std::uint32_t n : near) nearest = std::min(nearest, distance_to(change.where[n], at));
    if (nearest >= change.within_mm) return mm;
    return sign * smooth_maximum(sign * mm, tube.radius_mm - nearest, seam);
  };
  return changed(before, change, threads);
}

}  // namespace

std::vector<Vec3> thinned_path(const std::vector<Vec3>& path, double mm) {
  std::vector<Vec3> kept;
  for (const Vec3& place : path) {
    if (kept.empty() || glm::distance(place, kept.back()) >= mm) kept.push_back(place);
  }
  if (!kept.empty() && kept.back() != path.back()) kept.push_back(path.back());
  return kept;
}

Field joined(const Field& before, const Tube& tube, int threads, EditOutcome& outcome) {
  return with_tube(before, tube, 1, threads, outcome);
}

Field cut(const Field& before, const Tube& tube, int threads, EditOutcome& outcome) {
  return with_tube(before, tube, -1, threads, outcome);
}

}  // namespace palpate::io::internal
