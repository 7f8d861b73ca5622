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
#include "plugin/app/open_scan.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"
#include "plugin/structures/registered_structure.h"
#include "plugin/structures/structure_files.h"
#include "plugin/structures/study_registrations.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

struct StructuresOptions {
  std::vector<std::string> paths;
  std::string scan;  ///< a folder or file; empty: none
  bool json = false;
};

/// A structure with its measures; without them, and with `refused`, if it cannot be felt.
struct MeasuredStructure {
  io::Structure structure;
  std::optional<io::StructureMeasures> measures;
  Text refused;
};

/// `scan`: the scan for feeling it, or null.
MeasuredStructure measured(io::Structure structure, const io::Volume* scan, StudyRegistrations& study) {
  MeasuredStructure result{.structure = std::move(structure)};
  io::Structure& found = result.structure;
  try {
    if (scan) result.refused = place_on(found, study.beside(found, *scan), *scan).why_not;
    result.measures = io::measure(found, scan ? &scan->geometry : nullptr);
    if (!scan || !result.refused.empty()) return result;
    const io::StructureBox box{result.measures->box_low_mm, result.measures->box_high_mm};
    if (const Text off = off_scan(found, box, scan->geometry); !off.empty()) found.warnings.push_back(off);
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
  put("{}", text);
}

/// A registration's parts: the frames that it joins, or why it cannot.
nlohmann::ordered_json registration_json(const io::Registration& registration) {
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const io::Registration::Part& part : registration.parts) {
    nlohmann::ordered_json json{{"frame_of_reference_uid", part.frame_of_reference_uid}};
    if (part.unfit.empty()) {
      json["moved_by"] = in_words(part.motion);
    } else {
      json["refused"] = part.unfit;
    }
    parts.push_back(json);
  }
  return {{"file", registration.file.string()},
          {"hash", hash_of_file(registration.file)},
          {"to_frame_of_reference_uid", registration.frame_of_reference_uid},
          {"parts", parts}};
}

void print_registration(const io::Registration& registration) {
  put("{}: registration {} to frame of reference {}\n", registration.file.string(), hash_of_file(registration.file),
      registration.frame_of_reference_uid);
  for (const io::Registration::Part& part : registration.parts) {
    if (!part.unfit.empty()) {
      put("         note: {}\n", std::string(part.unfit));
    } else if (part.frame_of_reference_uid != registration.frame_of_reference_uid) {
      put("         moves what lies in {} by {}\n", part.frame_of_reference_uid, in_words(part.motion));
    }
  }
}

void run_structures(const StructuresOptions& options) {
  const std::vector<std::filesystem::path> paths(options.paths.begin(), options.paths.end());
  std::optional<io::Volume> scan;
  if (!options.scan.empty()) scan = load_series({.path = options.scan, .series = {}});
  const io::StructureCatalogue catalogue = io::find_structures(paths, terminal_progress("finding structures"));
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::filesystem::path file;
  StudyRegistrations study(terminal_progress("looking for registrations"));
  for (const io::Structure& structure : catalogue.structures) {
    const MeasuredStructure found = measured(structure, scan ? &*scan : nullptr, study);
    if (options.json) {
      list.push_back(structure_json(found));
      continue;
    }
    if (file != structure.file) {
      file = structure.file;
      put("{}: {}, frame of reference {}\n", file.string(), io::name_of(structure.kind),
          structure.frame_of_reference_uid.empty() ? "not said" : structure.frame_of_reference_uid);
    }
    print_structure(found);
  }
  if (options.json) {
    nlohmann::ordered_json skipped = nlohmann::ordered_json::array();
    for (const io::SkippedFile& one : catalogue.skipped) {
      skipped.push_back({{"path", one.path.string()}, {"reason", one.reason}});
    }
    nlohmann::ordered_json registrations = nlohmann::ordered_json::array();
    for (const io::Registration& one : catalogue.registrations) registrations.push_back(registration_json(one));
    const nlohmann::ordered_json all{{"structures", list}, {"registrations", registrations}, {"skipped", skipped}};
    put_json(all, 2);
  } else {
    for (const io::Registration& one : catalogue.registrations) print_registration(one);
    if (!catalogue.skipped.empty()) put("set apart:\n");
    for (const io::SkippedFile& one : catalogue.skipped) put("   {}: {}\n", one.path.string(), one.reason);
  }
  if (catalogue.structures.empty()) {
    throw InputRefused(say("no-structures-in-what-was-given"));
  }
}

}  // namespace

void add_structures(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "structures", "Lists outlined structures: segments, ROIs and labels with their names, volumes and places");
  const auto options = std::make_shared<StructuresOptions>();
  // Not required by CLI11: `compare` needs none.
  command->add_option("PATH", options->paths, "Folders (with subfolders), and files");
  command->add_option("--scan", options->scan, "Also say which of them cannot be felt on this scan, or lie outside it");
  command->add_flag("--json", options->json, "Print JSON, in patient space (LPS, mm)");
  add_compare_structures(*command);
  command->callback([command, options] {
    if (!command->get_subcommands().empty()) return;
    if (options->paths.empty()) throw CLI::RequiredError("PATH");
    run_structures(*options);
  });
}

}  // namespace palpate::plugin
