#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "io/errors.h"
#include "io/structures/doubtful_places.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/structure_option.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"

namespace palpate::plugin {
namespace {

struct SuspectsOptions {
  SeriesOption series;
  std::string structure;
  bool json = false;
};

nlohmann::ordered_json json_of(const io::DoubtfulPlaces& found) {
  nlohmann::ordered_json places = nlohmann::ordered_json::array();
  for (const io::DoubtfulPlace& place : found.places) {
    const io::Vec3 &at = place.position_mm, &normal = place.normal;
    places.push_back({{"position_mm", {at.x, at.y, at.z}},
                      {"normal", {normal.x, normal.y, normal.z}},
                      {"area_mm2", place.area_mm2},
                      {"mean_mm", place.mean_mm},
                      {"largest_mm", place.largest_mm},
                      {"known_to_mm", place.known_to_mm},
                      {"kind", io::name_of(place.kind)}});
  }
  return {{"places", std::move(places)}, {"sampled", found.sampled}, {"without_edge", found.without_edge}};
}

std::string in_words(const io::DoubtfulPlace& place) {
  switch (place.kind) {
    case io::DoubtKind::edge:
      return fmt::format("the scan's edge lies {:.1f} mm {} in the mean, {:.1f} at most, +- {:.1f}",
                         std::abs(place.mean_mm), place.mean_mm > 0 ? "outside" : "inside", std::abs(place.largest_mm),
                         place.known_to_mm);
    case io::DoubtKind::no_edge:
      return "the scan has no edge here, and the tissue is alike on both sides";
    case io::DoubtKind::island:
      return fmt::format("a small separate part, {:.1f} mm deep", std::abs(place.largest_mm));
    case io::DoubtKind::hole:
      return fmt::format("a small hole, {:.1f} mm deep", std::abs(place.largest_mm));
  }
  return {};
}

void print(const std::string& name, const io::DoubtfulPlaces& found) {
  put("{}: {} doubtful place{}; {} places of the outline were looked at, at {} the scan has no edge\n", name,
      found.places.size(), found.places.size() == 1 ? "" : "s", found.sampled, found.without_edge);
  if (!found.places.empty()) put("{:>4} {:>24} {:>9}\n", "", "x, y, z (LPS, mm)", "cm2");
  for (std::size_t n = 0; n < found.places.size(); ++n) {
    const io::DoubtfulPlace& place = found.places[n];
    const io::Vec3& at = place.position_mm;
    put("{:4} {:>24} {:9.1f}  {}: {}\n", n + 1, fmt::format("{:.1f}, {:.1f}, {:.1f}", at.x, at.y, at.z),
        place.area_mm2 / 100, io::name_of(place.kind), in_words(place));
  }
}

void run_suspects(const SuspectsOptions& options) try {
  const io::Series series = choose_series(options.series);
  const auto scan = std::make_shared<const io::Volume>(open_scan(series, options.series.frame));
  const io::Structure structure = choose_structure(options.structure, *scan);
  io::DistanceOptions distance;
  distance.reach_mm = io::doubt_within_mm;
  distance.scan = &scan->geometry;
  const auto field = io::load_distance(structure, distance);
  const std::shared_ptr<const io::FieldSource> fields = io::edge_fields(scan);
  const io::DoubtfulPlaces found =
      io::doubtful_places({*fields, scan->geometry}, *field, terminal_progress("looking for the scan's edges"));
  if (options.json) {
    put_json(json_of(found));
  } else {
    print(structure.name, found);
  }
} catch (const io::DicomError& error) {
  throw InputRefused(error.text());
}

}  // namespace

void add_suspects(CLI::App& program) {
  const auto options = std::make_shared<SuspectsOptions>();
  CLI::App* command =
      program.add_subcommand("suspects", "Lists the places at which a structure's outline is doubtful on a scan");
  command->footer(
      "Every 2 mm the scan's own edge is searched along the outline's normal, up to 6 mm away.\n"
      "kind           edge: from the outline to the scan's edge it is more than half a voxel, and more than twice "
      "known_to_mm\n"
      "               no_edge: the scan has no edge over more than 1 cm2, and the tissue is alike on both sides;\n"
      "               reported only if a third of the outline has an edge\n"
      "               island, hole: smaller than a tenth of the largest part\n"
      "position_mm    a point on the outline, in patient space (LPS)\n"
      "normal         the outline's normal at that point, outwards\n"
      "mean_mm        mean distance from the outline to the scan's edge, positive outwards; island, hole: volume / "
      "area\n"
      "largest_mm     largest distance to the scan's edge; island, hole: their depth\n"
      "known_to_mm    uncertainty of the scan's edge (two standard deviations)\n"
      "The list is ordered by area times distance. no_edge has no distance: 0 is printed, and the order uses 6 mm "
      "instead.");
  add_series_option(*command, options->series);
  command->add_option("--structure", options->structure, "FILE or FILE:SEGMENT")->required();
  command->add_flag("--json", options->json, "Print JSON, in patient space (LPS, mm)");
  command->callback([options] { run_suspects(*options); });
}

}  // namespace palpate::plugin
