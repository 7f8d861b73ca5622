#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/structures/structure.h"
#include "plugin/app/errors.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/options/series_option.h"

namespace palpate::plugin {
namespace {

struct StructuresOptions {
  std::vector<std::string> paths;
  bool json = false;
};

/// A structure and what it comes to; nothing, and `refused`, where it cannot be felt.
struct MeasuredStructure {
  io::Structure structure;
  std::optional<io::StructureMeasures> measures;
  Text refused;
};

MeasuredStructure measured(io::Structure structure) {
  MeasuredStructure result{.structure = std::move(structure)};
  try {
    result.measures = io::measure(result.structure);
  } catch (const io::DicomError& error) {
    result.refused = error.text();
  }
  return result;
}

std::vector<Text> warnings_of(const MeasuredStructure& found) {
  std::vector<Text> warnings = found.structure.warnings;
  if (found.measures) {
    warnings.insert(warnings.end(), found.measures->warnings.begin(), found.measures->warnings.end());
  }
  if (!found.refused.empty()) warnings.push_back(found.refused);
  return warnings;
}

nlohmann::ordered_json structure_json(const MeasuredStructure& found) {
  const io::Structure& structure = found.structure;
  const auto vector = [](const io::Vec3& v) { return nlohmann::ordered_json::array({v.x, v.y, v.z}); };
  nlohmann::ordered_json json{{"file", structure.file.string()}, {"kind", io::name_of(structure.kind)},
                              {"number", structure.number},      {"name", structure.name},
                              {"code", structure.code},          {"color", structure.color}};
  if (found.measures) {
    const io::StructureMeasures& measures = *found.measures;
    if (measures.voxels) json["voxels"] = *measures.voxels;
    if (measures.contours) json["contours"] = *measures.contours;
    json["volume_mm3"] = measures.volume_mm3;
    json["centroid_mm"] = vector(measures.centroid_mm);
    json["box_mm"] = nlohmann::ordered_json::array({vector(measures.box_low_mm), vector(measures.box_high_mm)});
  }
  json["frame_of_reference_uid"] = structure.frame_of_reference_uid;
  json["warnings"] = warnings_of(found);
  return json;
}

void print_structure(const MeasuredStructure& found) {
  const io::Structure& structure = found.structure;
  std::string text = fmt::format("   {:>4}  {}", structure.number, structure.name);
  if (!structure.code.empty()) text += " [" + structure.code + "]";
  if (!structure.color.empty()) text += " " + structure.color;
  if (found.measures) {
    const io::StructureMeasures& measures = *found.measures;
    const io::Vec3& at = measures.centroid_mm;
    text += fmt::format(": {:.2f} ml, ", measures.volume_mm3 / 1000);
    text += measures.voxels ? fmt::format("{} voxels", *measures.voxels)
                            : fmt::format("{} contours", measures.contours.value_or(0));
    text += fmt::format(", around {:.1f}, {:.1f}, {:.1f} mm", at.x, at.y, at.z);
  }
  text += "\n";
  for (const std::string& warning : warnings_of(found)) text += "         note: " + warning + "\n";
  std::fputs(text.c_str(), stdout);
}

void run_structures(const StructuresOptions& options) {
  const std::vector<std::filesystem::path> paths(options.paths.begin(), options.paths.end());
  const io::StructureCatalogue catalogue = io::find_structures(paths, terminal_progress("finding structures"));
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::filesystem::path file;
  for (const io::Structure& structure : catalogue.structures) {
    const MeasuredStructure found = measured(structure);
    if (options.json) {
      list.push_back(structure_json(found));
      continue;
    }
    if (file != structure.file) {
      file = structure.file;
      fmt::print("{}: {}, frame of reference {}\n", file.string(), io::name_of(structure.kind),
                 structure.frame_of_reference_uid.empty() ? "not said" : structure.frame_of_reference_uid);
    }
    print_structure(found);
  }
  if (options.json) {
    nlohmann::ordered_json skipped = nlohmann::ordered_json::array();
    for (const io::SkippedFile& one : catalogue.skipped) {
      skipped.push_back({{"path", one.path.string()}, {"reason", one.reason}});
    }
    const nlohmann::ordered_json all{{"structures", list}, {"skipped", skipped}};
    std::puts(all.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
  } else {
    if (!catalogue.skipped.empty()) fmt::print("set apart:\n");
    for (const io::SkippedFile& one : catalogue.skipped) fmt::print("   {}: {}\n", one.path.string(), one.reason);
  }
  if (catalogue.structures.empty()) {
    throw InputRefused(say("no-structures-in-what-was-given"));
  }
}

}  // namespace

void add_structures(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "structures", "What somebody has outlined: segments, ROIs and labels, their names, volumes and places");
  const auto options = std::make_shared<StructuresOptions>();
  command->add_option("PATH", options->paths, "Folders and files, searched to the bottom")->required();
  command->add_flag("--json", options->json, "JSON on stdout, patient space (LPS, mm)");
  command->callback([options] { run_structures(*options); });
}

}  // namespace palpate::plugin
