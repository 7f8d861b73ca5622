#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "io/messages.h"
#include "io/parallel.h"
#include "io/structures/edge_ways.h"
#include "io/structures/edit_changes.h"
#include "io/structures/same_parts.h"

namespace palpate::io::internal {
namespace {

constexpr int halving_rounds = 12;
constexpr double most_checked_nodes = 1e8;

FieldChange moved_by(const EdgeWays& ways, const ScanEdgeEdit& edit, const DistanceParts& before) {
  FieldChange change;
  change.where = {{edit.center_mm, edit.center_mm}};
  change.touched_mm = change.within_mm = edit.radius_mm;
  change.after = [&ways, &before](const Vec3& at, double mm, std::span<const std::uint32_t>) {
    return mm - ways.way_at(at, before.sample_nearest(at));
  };
  return change;
}

/// Nodes of parts that a change would make, take away, join or divide.
std::vector<Vec3> nodes_in_doubt(const DistanceParts& before, const FieldChange& change, int threads) {
  const NodeLattice& lattice = before.near.lattice;
  const Vec3 center = lattice.node_of(change.where.front().from), reach = change.within_mm / lattice.spacing + 2.0;
  const glm::ivec3 low(glm::floor(center - reach)), size = glm::ivec3(glm::ceil(center + reach)) - low + 1;
  if (!(static_cast<double>(size.x) * size.y * size.z < most_checked_nodes))
    throw InvalidInput(say("edit-is-too-large"));
  const auto row = static_cast<std::size_t>(size.x), plane = row * static_cast<std::size_t>(size.y);
  std::vector<char> was(plane * static_cast<std::size_t>(size.z)), is(was.size());
  const auto place = [&](std::size_t n) {
    return lattice.position(Vec3(low + glm::ivec3(n % row, n / row % static_cast<std::size_t>(size.y), n / plane)));
  };
  parallel_for(
      static_cast<std::size_t>(size.z),
      [&](std::size_t k) {
        for (std::size_t n = k * plane; n < (k + 1) * plane; ++n) {
          const Vec3 at = place(n);
          const double mm = before.sample_nearest(at).mm;
          was[n] = mm > 0 ? 1 : 0;
          is[n] = change.after(at, mm, {}) > 0 ? 1 : 0;
        }
      },
      {}, threads);
  std::vector<Vec3> places;
  for (const std::size_t n : nodes_of_other_parts(size, was, is)) places.push_back(place(n));
  return places;
}

}  // namespace

Field moved_to_scan_edge(const Field& before, const ScanEdgeEdit& edit, const EditOptions& options,
                         EditOutcome& outcome) {
  if (options.scan == nullptr) throw InvalidInput(say("edit-needs-the-scan"));
  EdgeWays ways(*before, edit, *options.scan, options.threads);
  const FieldChange change = moved_by(ways, edit, before->parts());
  Field after = before;
  for (int round = 0; ways.largest_mm() > 0; ++round) {
    const std::vector<Vec3> in_doubt = nodes_in_doubt(before->parts(), change, options.threads);
    if (in_doubt.empty()) {
      after = changed(before, change, options.threads);
      outcome.largest_mm = ways.largest_mm();
      break;
    }
    // Each round of ends leaves fewer places that move.
    if (!ways.hold_back(in_doubt, *before, round >= halving_rounds)) break;
  }
  for (const EdgeWay& one : ways.places()) {
    if (glm::distance(one.at.place_mm, edit.center_mm) >= edit.radius_mm) continue;
    ++outcome.points;
    outcome.without_edge += one.stays && !one.has_edge ? 1 : 0;
    outcome.held_back += one.is_held_back() ? 1 : 0;
  }
  return after;
}

}  // namespace palpate::io::internal
