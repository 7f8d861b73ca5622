#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/app/vector_text.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/output_files.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"
#include "plugin/report/stroke_picture.h"
#include "plugin/report/structure_crossings.h"
#include "plugin/report/summary.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {
namespace {

struct ProfileOptions {
  SeriesOption series;
  std::string scene, from, to;
  double speed = 50;
  std::filesystem::path picture, table;
  bool json = false;
};

nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json vector(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

nlohmann::json to_json(const StructureCrossing& crossing, const modes::Scene& scene) {
  const io::ScanEdge edge = crossing.own_edge.value_or(io::ScanEdge{NAN, NAN, NAN});
  return {{"structure", scene.structures[crossing.structure].name},
          {"entering", crossing.entering},
          {"position_mm", vector(crossing.place_mm)},
          {"depth_mm", crossing.depth_mm},
          {"scan_edge_mm", number(edge.mm)},
          {"scan_edge_rise", number(edge.rise)},
          {"scan_edge_known_to_mm", number(edge.known_to_mm)},
          {"scan_edge_within_mm", scan_edge_within_mm}};
}

std::string to_json(const std::vector<StrokePoint>& stroke, const std::vector<MetBoundary>& met,
                    const std::vector<StructureCrossing>& crossings, const modes::Plan& plan,
                    const modes::Scene& scene) {
  nlohmann::json json{{"position_mm", nlohmann::json::array()}, {"proxy_mm", nlohmann::json::array()},
                      {"force_n", nlohmann::json::array()},     {"value", nlohmann::json::array()},
                      {"solver", nlohmann::json::array()},      {"error_bound_m", nlohmann::json::array()},
                      {"boundary", nlohmann::json::array()}};
  for (const StrokePoint& point : stroke) {
    json["position_mm"].push_back(vector(point.position_mm));
    json["proxy_mm"].push_back(vector(point.proxy_mm));
    json["force_n"].push_back(vector(point.force_n));
    json["value"].push_back(number(point.value));
    json["solver"].push_back(solver::name_of(point.solver));
    json["error_bound_m"].push_back(number(point.error_bound_m));
    json["boundary"].push_back(point.boundary ? nlohmann::json(display_name(scene, *point.boundary))
                                              : nlohmann::json());
  }
  for (std::size_t n = 0; n < plan.structures.size(); ++n) {
    nlohmann::json& distances = json["distance_mm"][scene.structures[plan.structures[n]].name];
    for (const StrokePoint& point : stroke) distances.push_back(point.distance_mm[n]);
  }
  json["met"] = nlohmann::json::array();
  for (const MetBoundary& boundary : met) {
    const StrokePoint& first = stroke[boundary.contact.first];
    json["met"].push_back({{"boundary", display_name(scene, boundary.contact.boundary)},
                           {"proxy_mm", vector(first.proxy_mm)},
                           {"peak_n", boundary.contact.peak_n},
                           {"strength_n", boundary.contact.strength_n},
                           {"full_strength_n", boundary.contact.full_strength_n},
                           {"depth_mm", boundary.depth_mm},
                           {"known_to_mm", number(boundary.known_to_mm.value_or(NAN))},
                           {"known_along_mm", number(boundary.known_along_mm.value_or(NAN))}});
  }
  json["crossings"] = nlohmann::json::array();
  for (const StructureCrossing& crossing : crossings) json["crossings"].push_back(to_json(crossing, scene));
  return json.dump();
}

void print_text(const std::vector<StrokePoint>& stroke, const std::vector<MetBoundary>& met,
                const std::vector<StructureCrossing>& crossings, const modes::Scene& scene) {
  put("{:>9} {:>9} {:>9} {:>9}  {:<11} {}\n", "depth mm", "force N", "proxy mm", "value", "solver", "boundary");
  const glm::dvec3 from = stroke.front().position_mm;
  const glm::dvec3 along = glm::normalize(stroke.back().position_mm - from);
  // A line every half millimeter is enough for a person; --json has every tick.
  double next = 0;
  for (const StrokePoint& point : stroke) {
    const double depth = glm::dot(point.position_mm - from, along);
    if (depth + 1e-9 >= next) {
      next += 0.5;
      put("{:9.2f} {:9.3f} {:9.2f} {:9.1f}  {:<11} {}\n", depth, glm::length(point.force_n),
          glm::dot(point.proxy_mm - from, along), point.value, solver::name_of(point.solver),
          point.boundary ? display_name(scene, *point.boundary) : "");
    }
  }
  put("\n");
  for (const MetBoundary& boundary : met) {
    const Contact& contact = boundary.contact;
    const StrokePoint& first = stroke[contact.first];
    put("{} met at depth {:.2f} mm ({}), value {:.0f}; up to {:.2f} N{}{}\n", display_name(scene, contact.boundary),
        boundary.depth_mm, patient_coordinates(first.proxy_mm), first.value, contact.peak_n,
        known_to_text(boundary.known_to_mm), strength_to_text(contact));
  }
  for (const StructureCrossing& crossing : crossings) put("{}\n", in_words(crossing, scene));
}

void run(const ProfileOptions& options) {
  const glm::dvec3 from = parse_vector(options.from, "--from");
  const glm::dvec3 to = parse_vector(options.to, "--to");
  if (!(options.speed > 0)) {
    throw WrongUsage(say("speed-has-to-be-above-0-mm"));
  }
  const io::Series series = choose_series(options.series);
  const auto volume = std::make_shared<const io::Volume>(open_scan(series, options.series.frame));
  const modes::Scene scene = scene_for(options.scene, *volume);
  std::vector<std::filesystem::path> inputs = files_read(series, scene);
  inputs.emplace_back(options.scene);
  check_outputs({options.picture, options.table}, inputs);
  const PreparedScene felt = prepare(scene, volume, glm::dvec3(0.1));
  warn_of_structures(felt);
  Profile profile{.stroke = run_stroke(*felt.plan, *felt.source, from, to, options.speed),
                  .plan = felt.plan,
                  .scene = scene,
                  .unit = volume->unit,
                  .limit_n = scene.limits.force_n};
  profile.met = met_along(profile, felt);
  if (!options.picture.empty()) write_png(charts_of(profile), options.picture);
  if (!options.table.empty()) write_csv(profile, options.table);
  const std::vector<StructureCrossing> crossings = crossings_along(from, to, felt);
  if (options.json) {
    put_json_text(to_json(profile.stroke, profile.met, crossings, *felt.plan, scene));
  } else {
    print_text(profile.stroke, profile.met, crossings, scene);
  }
}

}  // namespace

void add_profile(CLI::App& program) {
  auto options = std::make_shared<ProfileOptions>();
  CLI::App* command =
      program.add_subcommand("profile",
                             "Computes the force along a straight stroke of the probe, as a table and a picture.\n"
                             "With it you can tune a scene without a stylus.");
  add_series_option(*command, options->series);
  command->add_option("--from", options->from, "where the stroke begins: x,y,z in mm, patient space (LPS)")->required();
  command->add_option("--to", options->to, "where it ends")->required();
  command->add_option(
      "--scene", options->scene,
      "a scene's file or the name of a starting scene (default: one that suits the part of the body and the modality)");
  command->add_option("--speed", options->speed, "speed of the probe, mm/s; a tick is 1 ms")->capture_default_str();
  command->add_option("-o,--picture", options->picture, "also draw the stroke: a PNG file");
  command->add_option("--table", options->table, "also write a CSV file with a line for every tick");
  command->add_flag("--json", options->json, "print every tick as JSON");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
