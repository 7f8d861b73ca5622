#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/load.h"
#include "io/series.h"
#include "plugin/app/errors.h"
#include "plugin/cli/commands.h"
#include "plugin/options/series_option.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  std::vector<std::string> paths;
  bool json = false;
  bool patient = false;
};

/// A series as its header and its voxels show it.
struct Examined {
  io::Series series;
  io::Statistics values;  // of all frames; count 0 where nothing could be read
};

Examined examine(io::Series series) {
  Examined result{std::move(series), {}};
  int readable = 0;
  io::Series& s = result.series;
  for (int frame = 0; frame < s.frames_per_position; ++frame) {
    try {
      io::LoadOptions how;
      how.frame = frame;
      how.progress = terminal_progress("reading slices");
      const io::Volume volume = io::load(s, how);
      result.values = io::merge(result.values, io::statistics(volume));
      ++readable;
      s.warnings.insert(s.warnings.end(), volume.warnings.begin(), volume.warnings.end());
      if (frame == 0) s.geometry = volume.geometry;  // without the slices that turned out to be unreadable
    } catch (const io::DicomError& error) {
      // Also of what is no volume: why it shows nothing is what is asked.
      s.warnings.emplace_back(error.what());
    }
  }
  s.usable = s.usable && readable > 0;
  return result;
}

Json json_of(const glm::dvec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json json_of(const Examined& examined) {
  const io::Series& s = examined.series;
  const io::Geometry& g = s.geometry;
  const bool placed = g.dimensions.x > 0;
  const bool has_values = examined.values.count > 0;
  Json json;
  json["uid"] = s.uid;
  json["study_uid"] = s.study_uid;
  json["modality"] = s.modality;
  json["description"] = s.description;
  json["files"] = s.files.size();
  json["dimensions"] = {g.dimensions.x, g.dimensions.y, g.dimensions.z};
  json["frames_per_position"] = s.frames_per_position;
  json["spacing_mm"] = placed ? Json::array({g.spacing_i, g.spacing_j, g.slice_spacing()}) : Json();
  json["origin_mm"] = g.slice_positions.empty() ? Json() : json_of(g.slice_positions.front());
  json["direction_i"] = placed ? json_of(g.direction_i) : Json();
  json["direction_j"] = placed ? json_of(g.direction_j) : Json();
  json["step_mm"] = placed ? json_of(g.step) : Json();
  json["uniform"] = g.uniform;
  json["transfer_syntaxes"] = s.transfer_syntaxes;
  json["unit"] = s.unit;
  json["minimum"] = has_values ? Json(examined.values.minimum) : Json();
  json["maximum"] = has_values ? Json(examined.values.maximum) : Json();
  json["mean"] = has_values ? Json(examined.values.mean) : Json();
  json["usable"] = s.usable;
  json["warnings"] = s.warnings;
  return json;
}

void print_text(std::size_t number, const Examined& examined, bool patient) {
  const io::Series& s = examined.series;
  const io::Geometry& g = s.geometry;
  const auto triple = [](const glm::dvec3& v) { return fmt::format("{:.6g}, {:.6g}, {:.6g}", v.x, v.y, v.z); };
  std::string text = describe_series(number, s) + "\n";
  if (patient) {
    text += fmt::format("   patient {}, id {}, study of {}\n", s.identity.patient_name, s.identity.patient_id,
                        s.identity.study_date);
  }
  text += fmt::format("   {} file{}\n", s.files.size(), s.files.size() == 1 ? "" : "s");
  if (!g.slice_positions.empty()) {
    text += fmt::format("   first voxel at {} mm; along a row {}; along a column {}; from slice to slice {} mm{}\n",
                        triple(g.slice_positions.front()), triple(g.direction_i), triple(g.direction_j), triple(g.step),
                        g.uniform ? "" : " on average");
  }
  if (examined.values.count > 0) {
    text += fmt::format("   values {:.6g} to {:.6g}, mean {:.6g}{}{}\n", examined.values.minimum,
                        examined.values.maximum, examined.values.mean, s.unit.empty() ? "" : " ", s.unit);
  }
  for (std::size_t f = 0; f < s.frame_names.size(); ++f) {
    if (!s.frame_names[f].empty()) text += fmt::format("   frame {}: {}\n", f, s.frame_names[f]);
  }
  for (const std::string& warning : s.warnings) text += "   note: " + warning + "\n";
  std::fputs(printable(text).c_str(), stdout);
}

void print_skipped(const std::vector<io::SkippedFile>& skipped) {
  if (!skipped.empty()) fmt::print("set apart:\n");
  for (const io::SkippedFile& file : skipped) {
    fmt::print("{}", printable(fmt::format("   {}: {}\n", file.path.string(), file.reason)));
  }
}

void run(const InfoOptions& options) {
  const std::vector<std::filesystem::path> paths(options.paths.begin(), options.paths.end());
  const io::Catalogue catalogue = io::find_series(paths, terminal_progress("finding series"));
  Json series = Json::array();
  Json velocity_fields = Json::array();
  std::size_t number = 0;
  for (const io::Series& found : numbered_series(catalogue)) {
    const Examined examined = examine(found);
    if (options.json) {
      const bool joined = series.size() == catalogue.series.size();
      (joined ? velocity_fields : series).push_back(json_of(examined));
    } else {
      print_text(++number, examined, options.patient);
    }
  }
  if (options.json) {
    Json skipped = Json::array();
    for (const auto& file : catalogue.skipped)
      skipped.push_back({{"path", file.path.string()}, {"reason", file.reason}});
    Json all = {{"series", series}, {"skipped", skipped}};
    if (!velocity_fields.empty()) all["velocity_fields"] = velocity_fields;
    // A file's name may be in any encoding.
    std::puts(all.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  } else {
    print_skipped(catalogue.skipped);
  }
  if (catalogue.series.empty())
    throw InputRefused("no image series in what was given; the files and why are listed above");
}

}  // namespace

void add_info(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("info", "Series found, their geometry and values, what was set apart and why");
  const auto options = std::make_shared<InfoOptions>();
  command->add_option("PATH", options->paths, "Folders and files, searched to the bottom")->required();
  command->add_flag("--json", options->json, "JSON on stdout, patient space (LPS, mm)");
  command->add_flag("--patient", options->patient,
                    "Show name, id and date, to verify that it is the right patient (text only)");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
