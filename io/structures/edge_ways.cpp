#include "io/structures/edge_ways.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "io/messages.h"
#include "io/parallel.h"
#include "io/quantile.h"

namespace palpate::io::internal {
namespace {

constexpr double densest_mm = 0.75, sparsest_mm = 2, spacings_a_radius = 8;
constexpr double steepest_way = 0.8;   // mm of way a mm along the surface
constexpr double rounded_mm = 2;       // over which the limit at the radius becomes so steep
constexpr double around_spacings = 2;  // places whose ways are compared
constexpr double alike_mm = 1;         // of neighboring ways: an edge that is farther off belongs to something else
constexpr double unlike_a_mm = 0.5;    // more than that for each mm between them
constexpr double enough_alike = 0.5, enough_without_edge = 0.67;  // of the places around
constexpr double blended_spacings = 2.5;                          // places whose ways are blended
constexpr double least_slope = 0.4;     // of the distance on the way: less lies between two walls
constexpr double least_progress = 0.3;  // of the distance for each mm of way
constexpr double nodes_beyond_way = 3;  // of the way, that the surface's cubic pieces read
constexpr double near_cell_mm = 8;
constexpr int most_halvings = 3;

bool faces(const OutlinePlace& a, const OutlinePlace& b) {
  return glm::dot(a.inward, b.inward) > 0;
}

}  // namespace

EdgeWays::EdgeWays(const DistanceField& before, const ScanEdgeEdit& edit, const ScanValues& scan, int threads)
    : edit_(edit), spacing_mm_(std::clamp(edit.radius_mm / spacings_a_radius, densest_mm, sparsest_mm)) {
  const Vec3& h = before.parts().near.lattice.spacing;
  node_mm_ = std::max({h.x, h.y, h.z});
  const double around = edit.radius_mm + blended_spacings * spacing_mm_;
  bool any = std::abs(before.sample(edit.center_mm).mm) < edit.radius_mm;
  for (const OutlinePlace& place : outline_places(before, spacing_mm_)) {
    const double away = glm::distance(place.place_mm, edit.center_mm);
    if (away < around) places_.push_back({.at = place});
    any = any || away < edit.radius_mm;
  }
  if (!any) throw InvalidInput(say("scan-edge-has-no-outline"));
  parallel_for(
      places_.size(),
      [&](std::size_t n) {
        EdgeWay& one = places_[n];
        if (!(limit_at(one.at.place_mm) > 0)) return;
        const auto edge = scan_edge(scan, before, one.at.place_mm, one.at.inward, edit_.most_mm);
        if (!edge) return;
        one.has_edge = true;
        one.stays = false;
        one.mm = one.edge_mm = edge->mm;
        one.known_to_mm = edge->known_to_mm;
      },
      {}, threads);
  take_consent();
  for (EdgeWay& one : places_) {
    const double most = limit_at(one.at.place_mm);
    one.mm = std::clamp(one.mm, -most, most);
  }
  end_before_ridges(before, threads);
  halved_.assign(places_.size(), 0);
  for (const EdgeWay& one : places_) allowed_mm_.push_back(one.mm);
  grade();
}

/// A way that differs from its neighbors' is replaced by what most of them agree on; without agreement the place stays.
/// So does a place without an edge, unless most neighbors have an edge and agree: noise has hidden its own. A way that
/// is shorter than the uncertainty of the neighboring edges becomes zero.
void EdgeWays::take_consent() {
  std::vector<double> way(places_.size(), 0.0), around, known_to;
  std::vector<char> stays(places_.size(), 0);
  for (std::size_t n = 0; n < places_.size(); ++n) {
    EdgeWay& one = places_[n];
    if (!(limit_at(one.at.place_mm) > 0)) continue;
    const double within = around_spacings * spacing_mm_;
    const auto for_each_near = [&](const auto& work) {
      for (const EdgeWay& other : places_) {
        const double away = glm::distance(one.at.place_mm, other.at.place_mm);
        if (away <= within && faces(one.at, other.at) && limit_at(other.at.place_mm) > 0) work(other, away);
      }
    };
    around.clear();
    known_to.clear();
    for_each_near([&](const EdgeWay& other, double) {
      if (!other.has_edge) return;
      around.push_back(other.mm);
      known_to.push_back(other.known_to_mm);
    });
    const double middle = quantile(around, 0.5);
    std::size_t all = 0, alike = 0;
    for_each_near([&](const EdgeWay& other, double away) {
      ++all;
      alike += other.has_edge && std::abs(other.mm - middle) < alike_mm + unlike_a_mm * away ? 1 : 0;
    });
    const double needed = one.has_edge ? enough_alike : enough_without_edge;
    stays[n] = static_cast<double>(alike) < needed * static_cast<double>(all) ? 1 : 0;
    way[n] = one.has_edge && std::abs(one.mm - middle) < alike_mm ? one.mm : middle;
    if (std::abs(way[n]) <= quantile(known_to, 0.5)) way[n] = 0;
  }
  for (std::size_t n = 0; n < places_.size(); ++n) {
    EdgeWay& one = places_[n];
    if (!(limit_at(one.at.place_mm) > 0)) continue;
    one.stays = stays[n] != 0;
    one.mm = one.stays ? 0 : way[n];
  }
}

/// Between two walls of the structure, or of it and another part of it, the distance has no slope.
void EdgeWays::end_before_ridges(const DistanceField& before, int threads) {
  parallel_for(
      places_.size(),
      [&](std::size_t n) {
        EdgeWay& one = places_[n];
        const double sign = one.mm > 0 ? 1 : -1, step = 0.25 * node_mm_;
        for (double mm = step; mm < std::abs(one.mm) + node_mm_; mm += step) {
          const Distance there = before.parts().sample_nearest(one.at.place_mm + sign * mm * one.at.inward);
          if (glm::length(there.gradient) >= least_slope && sign * there.mm >= least_progress * mm) continue;
          const double end = std::max(0.0, mm - node_mm_);
          one.mm = sign * std::min(end, std::abs(one.mm));
          return;
        }
      },
      {}, threads);
}

/// The longest ways that are nowhere longer than allowed, and nowhere too steep.
void EdgeWays::grade() {
  std::vector<double> graded(places_.size(), 0.0);
  // What weighs much in the blend at a place that stays stays, too.
  const double stay_mm = 0.5 * blended_spacings * spacing_mm_;
  for (std::size_t n = 0; n < places_.size(); ++n) {
    const double wanted = allowed_mm_[n], sign = wanted > 0 ? 1 : -1;
    double mm = std::abs(wanted);
    for (std::size_t other = 0; other < places_.size() && mm > 0; ++other) {
      const EdgeWay& beside = places_[other];
      if (!faces(places_[n].at, beside.at)) continue;
      const double there = std::max(0.0, sign * allowed_mm_[other]);
      if (there >= mm) continue;
      const double away = glm::distance(places_[n].at.place_mm, beside.at.place_mm);
      const bool in_reach = limit_at(beside.at.place_mm) > 0;
      const double apart = beside.stays && in_reach ? std::max(0.0, away - stay_mm) : away;
      if (in_reach) mm = std::min(mm, there + steepest_way * apart);
    }
    graded[n] = sign * mm;
  }
  largest_mm_ = 0;
  for (std::size_t n = 0; n < places_.size(); ++n) {
    places_[n].mm = graded[n];
    largest_mm_ = std::max(largest_mm_, std::abs(graded[n]));
  }
  sort_into_cells();
}

bool EdgeWays::hold_back(const std::vector<Vec3>& points, const DistanceField& before, bool end) {
  std::vector<char> near(places_.size(), 0);
  for (const Vec3& point : points) {
    const double within = std::abs(before.parts().sample_nearest(point).mm) + 2 * spacing_mm_;
    for (std::size_t n = 0; n < places_.size(); ++n) {
      if (glm::distance(places_[n].at.place_mm, point) < within) near[n] = 1;
    }
  }
  bool any = false;
  for (std::size_t n = 0; n < places_.size(); ++n) {
    if (near[n] == 0 || allowed_mm_[n] == 0) continue;
    allowed_mm_[n] = end || ++halved_[n] > most_halvings ? 0 : 0.5 * places_[n].mm;
    any = true;
  }
  grade();
  return any;
}

double EdgeWays::limit_at(const Vec3& at) const {
  const double in = edit_.radius_mm - glm::distance(at, edit_.center_mm);
  return in > 0 ? std::min(edit_.most_mm, steepest_way * in * in / (in + rounded_mm)) : 0;
}

void EdgeWays::sort_into_cells() {
  cells_wide_ = static_cast<int>(std::ceil(2 * edit_.radius_mm / near_cell_mm)) + 1;
  const auto wide = static_cast<std::size_t>(cells_wide_);
  cells_.assign(wide * wide * wide, {});
  const double within =
      largest_mm_ + nodes_beyond_way * node_mm_ + blended_spacings * spacing_mm_ + 0.5 * near_cell_mm * std::sqrt(3.0);
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    const glm::ivec3 place(cell % wide, cell / wide % wide, cell / (wide * wide));
    const Vec3 middle = edit_.center_mm - edit_.radius_mm + near_cell_mm * (Vec3(place) + 0.5);
    for (std::uint32_t n = 0; n < places_.size(); ++n) {
      if (glm::distance(places_[n].at.place_mm, middle) < within) cells_[cell].push_back(n);
    }
  }
}

double EdgeWays::way_at(const Vec3& at, const Distance& before) const {
  const double most = limit_at(at);
  if (!(most > 0) || std::abs(before.mm) > largest_mm_ + nodes_beyond_way * node_mm_) return 0;
  const glm::ivec3 cell(glm::floor((at - edit_.center_mm + edit_.radius_mm) / near_cell_mm));
  const auto& near = cells_[static_cast<std::size_t>((cell.z * cells_wide_ + cell.y) * cells_wide_ + cell.x)];
  double nearest = 1e300;
  for (const std::uint32_t n : near) {
    const Vec3 away = at - places_[n].at.place_mm;
    nearest = std::min(nearest, glm::dot(away, away));
  }
  // A point off the surface blends the places that one on it would.
  const double blended = blended_spacings * spacing_mm_;
  double sum = 0, weights = 0;
  for (const std::uint32_t n : near) {
    const Vec3 away = at - places_[n].at.place_mm;
    const double in = 1 - (glm::dot(away, away) - nearest) / (blended * blended);
    if (in <= 0) continue;
    const double facing = std::max(0.0, 0.5 * (1 + glm::dot(places_[n].at.inward, before.gradient)));
    const double weight = places_[n].at.area_mm2 * std::pow(in * facing, 4);
    sum += weight * places_[n].mm;
    weights += weight;
  }
  return weights > 0 ? std::clamp(sum / weights, -most, most) : 0;
}

}  // namespace palpate::io::internal
