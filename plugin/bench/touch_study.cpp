#include "plugin/bench/touch_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "io/quantile.h"
#include "io/structures/edits.h"
#include "io/structures/outline_places.h"
#include "modes/scene/scene_json.h"
#include "plugin/bench/hand_trace.h"
#include "plugin/bench/merged_study.h"
#include "plugin/bench/traced_bodies.h"
#include "plugin/report/chart.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

constexpr double organ_mm = 20, organ_hu = 60, around_hu = -100;
constexpr double kept_reach_mm = 8, reach_mm = 16;  // of the outline's distance; of a trace
constexpr double corrected_beyond_mm = 1;           // of an outline: there it is corrected

double true_organ(const glm::dvec3& at) {
  return organ_mm - glm::length(at);
}

struct SpoiltOutline {
  const char* what;
  OutlineMm mm;
};

std::vector<SpoiltOutline> spoilt_outlines() {
  const glm::dvec3 way = glm::normalize(glm::dvec3(1, -0.4, 0.2)), top = organ_mm * way;
  return {{"a cap of 5 mm cut off",
           [=](const glm::dvec3& at) { return std::min(true_organ(at), glm::dot(top - at, way) - 5); }},
          {"a dent of 5 mm",
           [=](const glm::dvec3& at) { return std::min(true_organ(at), glm::distance(at, top + 5.0 * way) - 10); }},
          {"a bulge of 4 mm",
           [=](const glm::dvec3& at) { return std::max(true_organ(at), 8 - glm::distance(at, top - 4.0 * way)); }},
          {"a shift of 2.5 mm", [=](const glm::dvec3& at) { return true_organ(at - 2.5 * way); }},
          {"rough by a voxel and more", [=](const glm::dvec3& at) {
             return true_organ(at) + 1.6 * std::sin(0.7 * at.x) * std::sin(0.8 * at.y) * std::sin(0.75 * at.z);
           }}};
}

std::shared_ptr<const io::Volume> organ_scan(const io::Geometry& geometry) {
  return soft_scan({.background = around_hu, .bodies = {{testdata::Ball{{0, 0, 0}, organ_mm}, organ_hu}}}, geometry);
}

/// Where the hand aims: along the true edge, slice by slice, wherever the outline is off; one way and back again.
std::vector<EdgePlace> way_over(const io::DistanceField& truth, const io::DistanceField& outline) {
  std::vector<EdgePlace> way;
  for (const io::OutlinePlace& place : io::outline_places(truth, 2)) {
    const glm::dvec3 outward = glm::normalize(place.place_mm), true_place = organ_mm * outward;
    // A trace is for one side of an organ.
    if (std::abs(outline.sample(true_place).mm) > corrected_beyond_mm && true_place.x > 0) {
      way.push_back({true_place, outward});
    }
  }
  sort_for_hand(way, glm::dvec3(0));
  return way;
}

constexpr const char* nothing_felt = R"({"version": 1, "modes": []})";
constexpr const char* edge_felt = R"({"version": 1, "modes": [{"type": "surface", "side": "entering",
  "strength_n": {"of": "value", "nodes": [[-24, 0], [-16, 1.5]]}}]})";

/// Distances of an outline from the truth, where it was off.
std::vector<double> errors_over(const std::vector<EdgePlace>& way, const io::DistanceField& outline) {
  std::vector<double> errors;
  for (const io::OutlinePlace& place : io::outline_places(outline, 1)) {
    const glm::dvec3 on_edge = organ_mm * glm::normalize(place.place_mm);
    const bool is_over =
        std::ranges::any_of(way, [&](const EdgePlace& at) { return glm::distance(at.place_mm, on_edge) < 1.5; });
    if (is_over) errors.push_back(std::abs(true_organ(place.place_mm)));
  }
  return errors;
}

double mean_of(const std::vector<double>& all) {
  double sum = 0;
  for (const double one : all) sum += one;
  return all.empty() ? 0 : sum / static_cast<double>(all.size());
}

/// Part of the corrected edge that lies nearer to the truth than so many mm.
Curve parts_within(std::vector<double> errors, const std::string& label, const Color& color) {
  std::ranges::sort(errors);
  Curve curve{.label = label, .x = {}, .y = {}, .color = color};
  for (int percent = 0; percent <= 100; ++percent) {
    curve.x.push_back(io::quantile_of_sorted(errors, percent / 100.0));
    curve.y.push_back(percent);
  }
  return curve;
}

}  // namespace

std::string study_touch(const TouchStudyOptions& options, const std::filesystem::path& folder) {
  const io::Geometry geometry = testdata::make_geometry({.size = glm::ivec3(70)});
  const auto scan = organ_scan(geometry);
  const auto truth = outline_of(geometry, true_organ, kept_reach_mm);
  std::string csv = "error,hand,before_mean_mm,before_largest_mm,after_mean_mm,after_largest_mm,path_mm,points\n";
  fmt::print(
      "\nA ball of {:.0f} mm on voxels of 1 mm, outlines spoilt, traced by {} hands (tremor {} mm, drift {} mm, aim "
      "+- {} mm):\ndistance to the true edge in the corrected region, mm\n\n{:28} {:6} {:>15} {:>15} {:>8} {:>7}\n",
      organ_mm, options.hands, hand::tremor_mm, hand::drift_mm, hand::pixel_mm, "error", "hand", "before", "after",
      "path mm", "points");
  const auto add_row = [&](const char* what, bool felt, const std::vector<double>& before,
                           const std::vector<double>& after, double path_mm, double points) {
    const auto largest = [](const std::vector<double>& all) { return all.empty() ? 0 : std::ranges::max(all); };
    const char* hand = felt ? "feels" : "sees";
    fmt::print("{:28} {:6} {:7.2f} {:7.2f} {:7.2f} {:7.2f} {:8.0f} {:7.0f}\n", what, hand, mean_of(before),
               largest(before), mean_of(after), largest(after), path_mm, points);
    csv += fmt::format("{},{},{},{},{},{},{},{}\n", what, hand, mean_of(before), largest(before), mean_of(after),
                       largest(after), path_mm, points);
  };
  std::vector<double> all_before, all_after[2];
  for (const SpoiltOutline& spoilt : spoilt_outlines()) {
    const auto outline = outline_of(geometry, spoilt.mm, kept_reach_mm);
    const std::vector<EdgePlace> way = way_over(*truth, *outline);
    const std::vector<double> before = errors_over(way, *outline);
    all_before.insert(all_before.end(), before.begin(), before.end());
    for (const bool felt : {false, true}) {
      std::vector<double> after;
      double path_mm = 0, points = 0;
      modes::Scene scene = modes::scene_from_json(felt ? edge_felt : nothing_felt, "touch study");
      scene.workspace.center_mm = glm::dvec3(0);
      for (int hand = 0; hand < options.hands; ++hand) {
        const HandTrace trace = trace_by_hand(way, scan, scene, felt, static_cast<unsigned>(hand + 1));
        const auto corrected = io::apply_edit(
            outline, io::TraceEdit{.points_mm = trace.points_mm, .known_to_mm = {}, .reach_mm = reach_mm});
        const std::vector<double> of_hand = errors_over(way, *corrected);
        after.insert(after.end(), of_hand.begin(), of_hand.end());
        path_mm += trace.path_mm / options.hands;
        points += static_cast<double>(trace.points_mm.size()) / options.hands;
      }
      add_row(spoilt.what, felt, before, after, path_mm, points);
      auto& all = all_after[felt ? 1 : 0];
      all.insert(all.end(), after.begin(), after.end());
    }
  }
  fmt::print("\nall: {:.2f} mm before, {:.2f} mm by the hand that sees, {:.2f} mm by the hand that feels, too\n",
             mean_of(all_before), mean_of(all_after[0]), mean_of(all_after[1]));
  fmt::print(
      "\nA ball in a socket whose outlines were merged over a gap of 3 mm, cut apart along it with Remove:\n"
      "distance from both true edges to the outline, mm\n\n");
  for (const bool felt : {false, true}) {
    const MergedResult merged = study_merged(options.hands, felt);
    add_row("two parts merged", felt, merged.before_mm, merged.after_mm, merged.path_mm, merged.points);
  }
  if (!folder.empty()) {
    Chart chart{.title = "A simulated hand corrects spoilt outlines",
                .x = {.label = "distance to the true edge (mm)", .minimum = 0, .maximum = 4},
                .y = {.label = "part of the corrected edge (%)", .minimum = 0, .maximum = 100},
                .curves = {parts_within(all_before, "before", colors::black),
                           parts_within(all_after[0], "sees the edge", colors::sky),
                           parts_within(all_after[1], "sees and feels it", colors::vermilion)},
                .marks = {}};
    write_png(chart, folder / "touch.png");
  }
  return csv;
}

}  // namespace palpate::plugin
