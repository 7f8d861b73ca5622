#include "plugin/structures/edges_beside.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "io/errors.h"
#include "io/structures/scan_edge.h"

namespace palpate::plugin {

std::vector<std::optional<EdgeBeside>> edges_beside(std::span<const io::Vec3> places, const io::DistanceField& outline,
                                                    const std::shared_ptr<const io::Volume>& scan, double within_mm,
                                                    const io::Progress& progress) {
  const auto fields = io::edge_fields(scan);
  std::vector<std::optional<EdgeBeside>> found;
  found.reserve(places.size());
  for (const io::Vec3& place : places) {
    if (progress && !progress(static_cast<double>(found.size()) / static_cast<double>(places.size()))) {
      throw io::Cancelled();
    }
    found.emplace_back();
    const io::Vec3 slope = outline.sample(place).gradient;
    if (!(glm::length(slope) > 0)) continue;  // the middle of the structure
    const io::Vec3 inward = glm::normalize(slope);
    const auto edge = io::scan_edge({*fields, scan->geometry}, outline, place, inward, within_mm);
    if (!edge) continue;
    found.back() = {.place_mm = place + edge->mm * inward, .off_mm = edge->mm, .known_to_mm = edge->known_to_mm};
  }
  return found;
}

std::vector<double> known_to_of(std::span<const std::optional<EdgeBeside>> edges) {
  constexpr double on_it_mm = 1;
  std::vector<double> known;
  known.reserve(edges.size());
  for (const auto& edge : edges) known.push_back(edge && std::abs(edge->off_mm) < on_it_mm ? edge->known_to_mm : 0);
  return known;
}

std::optional<io::Vec3> first_on_outline(const io::DistanceField& outline, const io::Vec3& from, const io::Vec3& to) {
  constexpr double step_mm = 0.5;
  const double long_mm = glm::distance(from, to);
  if (!(long_mm > 0)) return std::nullopt;
  const io::Vec3 along = (to - from) / long_mm;
  double before_mm = outline.sample(from).mm, at_before = 0;
  for (double at = 0; at < long_mm;) {
    // Far from it the distance may be less exact: half of it is surely free.
    at = std::min(long_mm, at + std::max(step_mm, 0.5 * std::abs(before_mm)));
    const double mm = outline.sample(from + at * along).mm;
    if (before_mm < 0 && mm >= 0) {
      const double part = before_mm / (before_mm - mm);
      return from + glm::mix(at_before, at, part) * along;
    }
    before_mm = mm;
    at_before = at;
  }
  return std::nullopt;
}

}  // namespace palpate::plugin
