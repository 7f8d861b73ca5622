#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "io/messages.h"
#include "io/parallel.h"
#include "io/structures/edit_changes.h"
#include "io/structures/outline_places.h"

namespace palpate::io::internal {
namespace {

constexpr double least_reach_mm = 2, most_reach_mm = 8;
constexpr double alike_mm = 1;  // of neighboring ways: an edge that is farther off belongs to something else

struct Seen {
  OutlinePlace at;
  std::optional<ScanEdge> edge;
};

/// What most places around one say of the way to the edge, mm.
double way_around(const std::vector<Seen>& seen, const Vec3& place, double within_mm) {
  std::vector<double> ways;
  for (const Seen& one : seen) {
    if (one.edge && glm::distance(one.at.place_mm, place) <= within_mm) ways.push_back(one.edge->mm);
  }
  const auto middle = ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2);
  std::nth_element(ways.begin(), middle, ways.end());
  return *middle;
}

}  // namespace

Field moved_to_scan_edge(const Field& before, const ScanEdgeEdit& edit, const EditOptions& options,
                         EditOutcome& outcome) {
  if (options.scan == nullptr) throw InvalidInput(say("edit-needs-the-scan"));
  // The edge is as before at the radius: the outermost points lie a reach inside it.
  const double reach = std::min(std::clamp(edit.radius_mm / 3, least_reach_mm, most_reach_mm), edit.radius_mm / 2);
  std::vector<Seen> seen;
  for (const OutlinePlace& place : outline_places(*before, reach / 4)) {
    if (glm::distance(place.place_mm, edit.center_mm) < edit.radius_mm - reach) seen.push_back({place, {}});
  }
  if (seen.empty()) throw InvalidInput(say("scan-edge-has-no-outline"));
  parallel_for(
      seen.size(),
      [&](std::size_t n) {
        seen[n].edge = scan_edge(*options.scan, *before, seen[n].at.place_mm, seen[n].at.inward, edit.most_mm);
      },
      {}, options.threads);
  TraceEdit trace{.points_mm = {}, .known_to_mm = {}, .reach_mm = reach};
  for (const Seen& one : seen) {
    double way = 0, known_to = 0;
    if (!one.edge) {
      ++outcome.without_edge;
    } else if (std::abs(one.edge->mm) > one.edge->known_to_mm &&
               std::abs(one.edge->mm - way_around(seen, one.at.place_mm, 2 * reach)) < alike_mm) {
      way = one.edge->mm;
      known_to = one.edge->known_to_mm;
    }
    trace.points_mm.push_back(one.at.place_mm + way * one.at.inward);
    trace.known_to_mm.push_back(known_to);
  }
  return traced(before, trace, options.threads, outcome);
}

}  // namespace palpate::io::internal
