#include "plugin/bench/organ_touch_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <random>
#include <utility>

#include "io/errors.h"
#include "io/quantile.h"
#include "io/structures/edits.h"
#include "io/structures/outline_places.h"
#include "plugin/app/errors.h"
#include "plugin/bench/hand_trace.h"
#include "plugin/bench/traced_bodies.h"
#include "plugin/messages/messages.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

constexpr double around_place_mm = 26, spoilt_within_mm = 13, traced_reach_mm = 16, kept_mm = 8;
constexpr std::size_t most_organs = 3;

struct SpoiltOrgan {
  const char* what;
  OutlineMm mm;
};

/// Errors around a place of the outline. Parts that were merged are cut apart with *Remove* (merged_study.h).
std::vector<SpoiltOrgan> spoilt_organs(const OutlineMm& truth, const EdgePlace& place) {
  const glm::dvec3 at0 = place.place_mm, out = place.outward;
  const auto from = [=](double mm) { return [=](const glm::dvec3& at) { return glm::distance(at, at0 + mm * out); }; };
  const glm::dvec3 aside = glm::normalize(glm::cross(out, glm::dvec3(0.3, 0.2, 1)));
  return {
      {"a cap of 5 mm cut off", [=](const glm::dvec3& at) { return std::min(truth(at), from(15)(at) - 20); }},
      {"a leak of 5 mm", [=](const glm::dvec3& at) { return std::max(truth(at), 6 - from(-1)(at)); }},
      {"a shift of 2.5 mm", [=](const glm::dvec3& at) { return truth(at - 2.5 * glm::normalize(out + 0.3 * aside)); }},
      {"noise of a voxel", [=](const glm::dvec3& at) {
         // A function of the place alone, so that every call gives the same value.
         const double wave = std::sin(91.7 * at.x + 57.3 * at.y + 113.1 * at.z) * 43758.5453;
         return truth(at) + 4.0 * (wave - std::floor(wave) - 0.5);
       }}};
}

/// The part of a scan's lattice around a place.
io::Geometry lattice_around(const io::Geometry& scan, const glm::dvec3& place) {
  const glm::dvec3 middle = scan.to_index(place);
  const glm::dvec3 half = around_place_mm / glm::dvec3(scan.spacing_i, scan.spacing_j, scan.slice_spacing());
  const glm::ivec3 low(glm::max(glm::floor(middle - half), glm::dvec3(0)));
  const glm::ivec3 high(glm::min(glm::ceil(middle + half), glm::dvec3(scan.dimensions - 1)));
  io::Geometry part = scan;
  part.dimensions = high - low + 1;
  part.slice_positions.clear();
  for (int k = low.z; k <= high.z; ++k) part.slice_positions.push_back(scan.to_patient(glm::dvec3(low.x, low.y, k)));
  return part;
}

/// A place in whose surroundings most of the outline has an edge of the scan within a millimeter.
std::optional<EdgePlace> place_with_edges(const io::DistanceField& organ, const io::ScanValues& scan) {
  const double low = scan.geometry.slice_positions.front().z, high = scan.geometry.slice_positions.back().z;
  std::vector<io::OutlinePlace> places = io::outline_places(organ, 4);
  std::erase_if(places, [&](const io::OutlinePlace& one) {
    const double z = one.place_mm.z;
    return z < std::min(low, high) + 2 || z > std::max(low, high) - 2;
  });
  std::vector<char> has_edge;
  for (const io::OutlinePlace& one : places) {
    const auto edge = io::scan_edge(scan, organ, one.place_mm, one.inward, 2);
    has_edge.push_back(edge && std::abs(edge->mm) < 1 ? 1 : 0);
  }
  std::optional<EdgePlace> best;
  double most = 0;
  for (const io::OutlinePlace& one : places) {
    // In the middle of the slices, so that the hand finds all of it in the scan.
    if (std::abs(one.place_mm.z - 0.5 * (low + high)) > 5 || std::abs(one.inward.z) > 0.5) continue;
    double all = 0, with_edge = 0;
    for (std::size_t n = 0; n < places.size(); ++n) {
      if (glm::distance(places[n].place_mm, one.place_mm) > spoilt_within_mm) continue;
      all += 1;
      with_edge += has_edge[n];
    }
    if (all < 20 || with_edge / all <= most) continue;
    most = with_edge / all;
    best = EdgePlace{one.place_mm, -one.inward};
  }
  return best;
}

/// A surface where the value is half-way between the organ's and that around it, as *Snap* makes it.
modes::Scene felt_edge(const io::DistanceField& organ, const io::ScanValues& scan, const EdgePlace& place, bool felt) {
  constexpr double beyond_edge_mm = 3, sets_in = 0.05, newtons = 1.5;
  modes::Scene scene;
  scene.workspace.center_mm = place.place_mm;
  if (!felt) return scene;
  std::vector<double> in, out;
  for (const io::OutlinePlace& one : io::outline_places(organ, 2)) {
    if (glm::distance(one.place_mm, place.place_mm) > spoilt_within_mm) continue;
    for (const double sign : {-1.0, 1.0}) {
      const io::Sample there =
          scan.source.sample(one.place_mm + sign * beyond_edge_mm * one.inward, io::FieldSet::value);
      if (there.inside) (sign > 0 ? in : out).push_back(there.value);
    }
  }
  const double inside = io::quantile(in, 0.5), outside = io::quantile(out, 0.5);
  const double middle = 0.5 * (inside + outside), half = sets_in * std::abs(inside - outside);
  const bool up = inside > outside;
  modes::Mode mode;
  mode.type = "surface";
  mode.name = "edge";
  mode.side = up ? modes::Side::entering : modes::Side::leaving;
  mode.strength_of = modes::Datum::value;
  mode.strength_n = modes::TransferFunction({{middle - half, up ? 0 : newtons}, {middle + half, up ? newtons : 0}});
  scene.modes.push_back(mode);
  return scene;
}

/// Distances of an outline from the truth, beside the places that were traced.
std::vector<double> errors_beside(const std::vector<EdgePlace>& way, const io::DistanceField& outline,
                                  const io::DistanceField& truth) {
  std::vector<double> errors;
  for (const io::OutlinePlace& place : io::outline_places(outline, 1)) {
    const io::Distance there = truth.sample(place.place_mm);
    const glm::dvec3 on_edge = place.place_mm - there.mm * there.gradient;
    const bool beside =
        std::ranges::any_of(way, [&](const EdgePlace& at) { return glm::distance(at.place_mm, on_edge) < 1.5; });
    if (beside) errors.push_back(std::abs(there.mm));
  }
  return errors;
}

struct MeanAndLargest {
  double mean = 0, largest = 0;
};
MeanAndLargest mean_and_largest(const std::vector<double>& all) {
  MeanAndLargest both;
  for (const double one : all) {
    both.mean += one / static_cast<double>(all.size());
    both.largest = std::max(both.largest, one);
  }
  return both;
}

struct OrganOnScan {
  std::string name;
  std::shared_ptr<const io::DistanceField> field;
  EdgePlace place;
};

std::vector<OrganOnScan> chosen_organs(const io::ScanValues& values, const std::vector<io::Structure>& structures,
                                       const OrganTouchOptions& options) {
  std::vector<std::pair<double, io::Structure>> by_size;
  for (const io::Structure& one : structures) {
    const bool named = options.organs.empty() || std::ranges::find(options.organs, one.name) != options.organs.end();
    if (named && one.unfit.empty()) by_size.emplace_back(io::measure(one).volume_mm3, one);
  }
  std::ranges::stable_sort(by_size, std::greater<>(), [](const auto& one) { return one.first; });
  std::vector<OrganOnScan> organs;
  for (const auto& [volume, structure] : by_size) {
    if (options.organs.empty() && organs.size() == most_organs) break;
    io::DistanceOptions distance;
    distance.reach_mm = kept_mm;
    distance.scan = &values.geometry;
    const auto field = io::load_distance(structure, distance);
    if (const auto place = place_with_edges(*field, values)) organs.push_back({structure.name, field, *place});
  }
  if (organs.empty()) throw InputRefused(say("no-structure-lies-on-the-scan"));
  return organs;
}

}  // namespace

std::string study_touch_on_organs(const std::shared_ptr<const io::Volume>& scan,
                                  const std::vector<io::Structure>& structures, const OrganTouchOptions& options) {
  const auto fields = io::edge_fields(scan);
  const io::ScanValues values{*fields, scan->geometry};
  std::string csv =
      "organ,error,hand,before_mean_mm,before_largest_mm,after_mean_mm,after_largest_mm,path_mm,points,refused\n";
  fmt::print(
      "\nOrgans, outlines spoilt where the scan has an edge, traced by {} hands:\ndistance to the organ's own outline "
      "in the corrected region, mm\n\n{:20} {:24} {:6} {:>15} {:>15} {:>8} {:>7} {:>7}\n",
      options.hands, "organ", "error", "hand", "before", "after", "path mm", "points", "refused");
  for (const auto& [name, field, place] : chosen_organs(values, structures, options)) {
    const io::Geometry lattice = lattice_around(scan->geometry, place.place_mm);
    const OutlineMm mm = [&organ = *field](const glm::dvec3& at) { return organ.sample(at).mm; };
    const auto truth = outline_of(lattice, mm, kept_mm);
    for (const SpoiltOrgan& spoilt : spoilt_organs(mm, place)) {
      const auto outline = outline_of(lattice, spoilt.mm, kept_mm);
      std::vector<EdgePlace> way;
      for (const io::OutlinePlace& one : io::outline_places(*truth, 2)) {
        const glm::dvec3& at = one.place_mm;
        const double half = 0.5 * std::abs(lattice.slice_positions.back().z - lattice.slice_positions.front().z);
        const double middle = 0.5 * (lattice.slice_positions.back().z + lattice.slice_positions.front().z);
        if (glm::distance(at, place.place_mm) > spoilt_within_mm || std::abs(at.z - middle) > half - 2) continue;
        if (glm::dot(one.inward, place.outward) < 0 && std::abs(outline->sample(at).mm) > 1) {
          way.push_back({at, -one.inward});
        }
      }
      if (way.size() < 4) continue;
      sort_for_hand(way, place.place_mm - 3 * spoilt_within_mm * place.outward);
      const MeanAndLargest before = mean_and_largest(errors_beside(way, *outline, *truth));
      for (const bool felt : {false, true}) {
        std::vector<double> after;
        double path_mm = 0, points = 0;
        int refused = 0;
        // A trace that is refused changes nothing.
        const auto corrected_by = [&](const io::TraceEdit& trace) {
          try {
            return io::apply_edit(outline, trace);
          } catch (const InvalidInput&) {
            ++refused;
            return outline;
          }
        };
        for (int hand = 0; hand < options.hands; ++hand) {
          const HandTrace trace =
              trace_by_hand(way, scan, felt_edge(*field, values, place, felt), felt, static_cast<unsigned>(hand + 1));
          const auto corrected =
              corrected_by({.points_mm = trace.points_mm, .known_to_mm = {}, .reach_mm = traced_reach_mm});
          const std::vector<double> of_hand = errors_beside(way, *corrected, *truth);
          after.insert(after.end(), of_hand.begin(), of_hand.end());
          path_mm += trace.path_mm / options.hands;
          points += static_cast<double>(trace.points_mm.size()) / options.hands;
        }
        const MeanAndLargest now = mean_and_largest(after);
        const char* hand = felt ? "feels" : "sees";
        fmt::print("{:20} {:24} {:6} {:7.2f} {:7.2f} {:7.2f} {:7.2f} {:8.0f} {:7.0f} {:7}\n", name, spoilt.what, hand,
                   before.mean, before.largest, now.mean, now.largest, path_mm, points, refused);
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", name, spoilt.what, hand, before.mean, before.largest,
                           now.mean, now.largest, path_mm, points, refused);
      }
    }
  }
  return csv;
}

}  // namespace palpate::plugin
