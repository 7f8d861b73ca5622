#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "io/errors.h"
#include "io/interchange/voxel_file.h"
#include "io/structures/edits.h"
#include "io/structures/label_image.h"
#include "modes/scene/edit_text.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/structure_option.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"

namespace palpate::plugin {
namespace {

struct CorrectOptions {
  SeriesOption series;
  std::string structure, name;
  std::filesystem::path edits, output;
  bool rtstruct = false, force = false;
};

constexpr const char* drawn_color = "#e69f00";  // of a structure that contours make: orange, seen on gray

/// The corrected structure and its label. A new structure is named after its file, unless it is given a name.
struct Corrected {
  std::shared_ptr<const io::DistanceField> field;  ///< null: it is made of contours
  io::StructureLabel label;
};

/// As far as the edge may move: how far it did is read from the distances there.
double reach_of(const std::vector<io::Edit>& edits) {
  constexpr double most_mm = 20;
  double reach = io::DistanceOptions().reach_mm;
  for (const io::Edit& edit : edits) {
    if (const auto* const add = std::get_if<io::AddEdit>(&edit)) reach = std::max(reach, 2 * add->tube.radius_mm);
    if (const auto* const remove = std::get_if<io::RemoveEdit>(&edit)) {
      reach = std::max(reach, 2 * remove->tube.radius_mm);
    }
  }
  return std::min(reach, most_mm);
}

Corrected what_is_corrected(const CorrectOptions& options, const io::Volume& scan, double reach_mm) {
  if (options.structure.empty()) {
    std::string name = options.name.empty() ? options.output.filename().string() : options.name;
    if (options.name.empty()) name.resize(std::min(name.find('.', 1), name.size()));
    return {.field = nullptr, .label = {.name = name, .color = drawn_color}};
  }
  const io::Structure structure = choose_structure(options.structure, scan);
  io::DistanceOptions distance;
  distance.scan = &scan.geometry;
  distance.reach_mm = reach_mm;
  return {.field = io::load_distance(structure, distance), .label = io::label_of(structure)};
}

io::Edited edited(const Corrected& before, const std::vector<io::Edit>& edits,
                  const std::shared_ptr<const io::Volume>& scan) {
  std::shared_ptr<const io::FieldSource> fields;
  std::optional<io::ScanValues> values;
  const auto asks_the_scan = [](const io::Edit& edit) { return std::holds_alternative<io::ScanEdgeEdit>(edit); };
  if (std::ranges::any_of(edits, asks_the_scan)) {
    fields = io::edge_fields(scan);
    values.emplace(io::ScanValues{*fields, scan->geometry});
  }
  io::EditOptions options;
  options.scan = values ? &*values : nullptr;
  options.distance.scan = &scan->geometry;
  return io::apply_edits(before.field, edits, options);
}

void print(const std::vector<io::Edit>& edits, const io::Edited& done) {
  for (std::size_t n = 0; n < edits.size(); ++n) {
    const io::EditOutcome& outcome = done.outcomes[n];
    put("edit {}: {}: ", n + 1, io::name_of(edits[n]));
    if (std::holds_alternative<io::ContoursEdit>(edits[n])) {
      put("a new outline");
    } else {
      put("the edge moved by {:.2f} mm at most", outcome.largest_mm);
    }
    if (std::holds_alternative<io::ScanEdgeEdit>(edits[n])) {
      put("; {} places of it were looked at", outcome.points);
    } else if (outcome.points > 0) {
      put(", through {} points", outcome.points);
    }
    if (outcome.without_edge > 0) put("; at {} the scan has no edge, and it stays", outcome.without_edge);
    if (outcome.held_back > 0) put("; at {} it does not go all the way to the scan's edge", outcome.held_back);
    put("\n");
  }
}

void run_correct(const CorrectOptions& options) try {
  const io::StructureForm form = io::form_of(options.output, options.rtstruct);
  const std::vector<io::Edit> edits = modes::load_edits(options.edits);
  const bool anew = !edits.empty() && std::holds_alternative<io::ContoursEdit>(edits.front());
  if (options.structure.empty() && !anew) throw WrongUsage(say("edits-need-a-structure"));
  const io::Series series = choose_series(options.series);
  const auto scan = std::make_shared<const io::Volume>(open_scan(series, options.series.frame));
  const Corrected before = what_is_corrected(options, *scan, reach_of(edits));
  const io::Edited after = [&] {
    try {
      return edited(before, edits, scan);
    } catch (const InvalidInput& error) {
      throw InputRefused(at_place(options.edits.string(), error.text()));
    }
  }();
  const io::SignedDistance distance = [field = after.field](const io::Vec3& at) { return field->sample(at).mm; };
  io::write_structure(before.label, series, scan->geometry, distance, {}, form, options.output,
                      {.overwrite = options.force, .software_version = PALPATE_VERSION, .frame = options.series.frame},
                      terminal_progress("sampling the outline"));
  print(edits, after);
  put("{}: \"{}\", {} edit{}\n", options.output.string(), before.label.name, edits.size(),
      edits.size() == 1 ? "" : "s");
} catch (const io::DicomError& error) {
  throw InputRefused(error.text());
}

}  // namespace

void add_correct(CLI::App& program) {
  const auto options = std::make_shared<CorrectOptions>();
  CLI::App* command = program.add_subcommand(
      "correct", "Applies edits to a structure's outline, and writes the corrected outline on the scan's grid");
  command->footer(
      "The file name extension of OUT selects the format: .dcm is a DICOM SEG, or an RTSTRUCT with --rtstruct; label "
      "maps are " +
      io::written_endings_in_words() + ".\n" +
      "A SEG or RTSTRUCT goes into the scan's study, and refers to its images and to the outline that was corrected.\n"
      "EDITS: {\"version\": 1, \"edits\": [...]}, applied in their order, in patient space (LPS, mm):\n"
      "  {\"type\": \"trace\", \"points_mm\": [[x, y, z], ...], \"known_to_mm\": [...], \"reach_mm\": 8}\n"
      "  {\"type\": \"add\" or \"remove\", \"path_mm\": [[x, y, z], ...], \"radius_mm\": 3}\n"
      "  {\"type\": \"scan_edge\", \"center_mm\": [x, y, z], \"radius_mm\": 10, \"most_mm\": 3}\n"
      "  {\"type\": \"contours\", \"loops_mm\": [[[x, y, z], ...], ...]}: a new structure: it must be the first edit, "
      "without "
      "--structure");
  add_series_option(*command, options->series);
  command->add_option("--structure", options->structure,
                      "The structure to correct: FILE or FILE:SEGMENT; without --structure the first edit makes a new "
                      "one from contours");
  command->add_option("--name", options->name, "Name of a structure made from contours (default: the name of OUT)")
      ->excludes("--structure");
  command->add_option("--edits", options->edits, "A JSON file with the edits (below)")->required();
  command->add_option("-o,--output", options->output, "The file to write: OUT")->required();
  command->add_flag("--rtstruct", options->rtstruct, "Write contours (RTSTRUCT) as .dcm");
  command->add_flag("--force", options->force, "Overwrite OUT if it exists; the input is never overwritten");
  command->callback([options] { run_correct(*options); });
}

}  // namespace palpate::plugin
