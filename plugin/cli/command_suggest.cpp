#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/structures/structure.h"
#include "modes/scene/scene_json.h"
#include "modes/scene/suggest.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/output_files.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"
#include "plugin/report/suggestion_picture.h"
#include "plugin/report/text_file.h"
#include "plugin/structures/study_registrations.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

struct SuggestOptions {
  SeriesOption series;
  std::vector<std::filesystem::path> structures;
  std::string output;
};

void print_words(const modes::Suggestion& suggestion, const std::string& unit) {
  put("tissues\n");
  for (std::size_t t = 0; t < suggestion.typical.size(); ++t) {
    put("  {:<24} typically {:.0f}{}\n", suggestion.scene.tissues[t].name, suggestion.typical[t], unit);
  }
  put("boundaries\n");
  for (const modes::FoundBoundary& boundary : suggestion.boundaries) {
    put("  {:<36} felt at {:.0f}{}; {:.1f} % of what lies at boundaries\n", suggestion.scene.modes[boundary.mode].name,
        boundary.middle, unit, 100 * boundary.share);
  }
}

/// A structure that lies with the scan: felt on it where a mode names it, or not, and why.
struct Offer {
  io::Structure structure;
  std::string name;  ///< in the scene
  Text why_not;
  Text off;  ///< that it lies wholly outside the scan
};

/// Empty if unknown: then the structure cannot be felt, and the attempt reports that.
Text off(const io::Structure& structure, const io::Geometry& scan) {
  try {
    return off_scan(structure, io::box_of(structure), scan);
  } catch (const io::DicomError&) {
    return {};
  }
}

/// The structures of the study, put into the scene where they can be felt. No mode reads them yet.
std::vector<Offer> offer_structures(const SuggestOptions& options, const io::Volume& volume, modes::Scene& scene) {
  std::vector<std::filesystem::path> places = options.structures;
  places.emplace_back(options.series.path);
  std::vector<Offer> offers;
  StudyRegistrations study(terminal_progress("looking for registrations"));
  for (io::Structure& found : io::find_structures(places, terminal_progress("finding structures")).structures) {
    Offer offer{.structure = std::move(found), .name = {}, .why_not = {}, .off = {}};
    io::Structure& structure = offer.structure;
    structure.file = std::filesystem::absolute(structure.file);
    offer.why_not = place_on(structure, study.beside(structure, volume), volume).why_not;
    if (offer.why_not.empty()) {
      offer.name = name_in_scene(scene, structure);
      offer.off = off(structure, volume.geometry);
    }
    offers.push_back(std::move(offer));
  }
  return offers;
}

void print_offers(const std::vector<Offer>& offers) {
  if (offers.empty()) return;
  put("structures of the study\n");
  std::string first;
  for (const Offer& offer : offers) {
    const std::string file = offer.structure.file.filename().string();
    if (!offer.why_not.empty()) {
      put("  {:<36} cannot be felt: {}\n", offer.structure.name, offer.why_not);
      continue;
    }
    put("  {:<36} {}, {}\n", offer.name, io::name_of(offer.structure.kind), file);
    if (!offer.off.empty()) put("    note: {}\n", offer.off);
    if (first.empty()) first = offer.name;
  }
  if (!first.empty()) {
    put("  one is felt where a mode names it: {}\n",
        nlohmann::ordered_json{{"type", "surface"}, {"structure", first}, {"strength_n", 1}}.dump());
  }
}

/// The picture of a scene that is to be written; empty if none is. It replaces no picture that is not a scene's.
std::filesystem::path picture_beside(const std::filesystem::path& scene) {
  if (scene.empty()) return {};
  std::filesystem::path picture = scene;
  picture.replace_extension(".png");
  if (picture == scene) throw InputRefused(say("scene-is-no-picture", scene.string()));
  if (std::filesystem::exists(picture) && !std::filesystem::exists(scene)) {
    throw InputRefused(say("picture-is-there", picture.string(), scene.string()));
  }
  return picture;
}

std::vector<std::filesystem::path> files_of(const std::vector<Offer>& offers) {
  std::vector<std::filesystem::path> files;
  for (const Offer& offer : offers) files.push_back(offer.structure.file);
  return files;
}

void run(const SuggestOptions& options) {
  const io::Series series = choose_series(options.series);
  const std::filesystem::path scene = options.output, picture = picture_beside(scene);
  std::vector<std::filesystem::path> inputs = options.structures;
  inputs.insert(inputs.end(), series.files.begin(), series.files.end());
  check_outputs({scene, picture}, inputs);
  const auto volume = std::make_shared<const io::Volume>(open_scan(series, options.series.frame));
  modes::Suggestion suggestion = modes::suggest(volume, terminal_progress("looking for tissues"));
  if (suggestion.boundaries.empty()) {
    throw InputRefused(say("no-boundary-between-tissues-was-found", options.series.path));
  }
  const std::vector<Offer> offers = offer_structures(options, *volume, suggestion.scene);
  const std::string text = modes::to_json(suggestion.scene);
  if (options.output.empty()) {
    put_json_text(text);
    return;
  }
  check_outputs({scene, picture}, files_of(offers));
  // The picture first: without it there shall be no scene that looks complete.
  write_suggestion_png(suggestion, volume, picture);
  write_text(scene, text + "\n");
  print_words(suggestion, volume->unit.empty() ? "" : " " + volume->unit);
  print_offers(offers);
  put("\nwritten: {} and {}\nfeel it: palpate probe {} --scene {}\n", scene.string(), picture.string(),
      options.series.path, scene.string());
}

}  // namespace

void add_suggest(CLI::App& program) {
  auto options = std::make_shared<SuggestOptions>();
  CLI::App* command =
      program.add_subcommand("suggest",
                             "Proposes a scene: the tissues, boundaries and transfer functions found in "
                             "the scan, and the structures of the study.");
  add_series_option(*command, options->series);
  command
      ->add_option(
          "--structures", options->structures,
          "more files and folders to search for structures (SEG, RTSTRUCT, label maps); SERIES itself is always "
          "searched. The scene names the structures that can be felt")
      ->check(CLI::ExistingPath);
  command->add_option("-o,--output", options->output,
                      "write the scene to this file and a picture beside it (default: print the scene)");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
