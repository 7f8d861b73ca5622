#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "io/messages.h"
#include "io/structures/edit_changes.h"

namespace palpate::io::internal {
namespace {

constexpr double most_seam_mm = 2;
constexpr double beyond_nodes = 6;  // so that the numbers are the new ones wherever the surface is looked for

/// The larger of two numbers where they differ by `seam` or more, and once differentiable (I. Quilez's polynomial).
double smooth_maximum(double a, double b, double seam) {
  const double h = std::max(seam - std::abs(a - b), 0.0);
  return std::max(a, b) + h * h / (4 * seam);
}

/// `sign` 1: joined; -1: cut.
Field with_tube(const Field& before, const Tube& tube, double sign, int threads) {
  const DistanceParts& parts = before->parts();
  const Vec3 high = parts.far.origin + Vec3(parts.far.size - 1) * parts.far.spacing;
  FieldChange change;
  for (std::size_t n = 0; n < tube.path_mm.size(); ++n) {
    const Vec3& place = tube.path_mm[n];
    if (place != glm::clamp(place, parts.far.origin, high)) throw InvalidInput(say("edit-lies-off-the-scan", n + 1));
    if (n == 0 || place != tube.path_mm[n - 1]) change.where.push_back({tube.path_mm[n == 0 ? 0 : n - 1], place});
  }
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

Field joined(const Field& before, const Tube& tube, int threads, EditOutcome& outcome) {
  outcome.points = tube.path_mm.size();
  return with_tube(before, tube, 1, threads);
}

Field cut(const Field& before, const Tube& tube, int threads, EditOutcome& outcome) {
  outcome.points = tube.path_mm.size();
  return with_tube(before, tube, -1, threads);
}

}  // namespace palpate::io::internal
