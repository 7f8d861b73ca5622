#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "modes/scene/scene_json.h"
#include "modes/scene/suggest.h"
#include "plugin/app/errors.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/options/series_option.h"
#include "plugin/report/suggestion_picture.h"
#include "plugin/report/text_file.h"

namespace palpate::plugin {
namespace {

struct SuggestOptions {
  SeriesOption series;
  std::string output;
};

void print_words(const modes::Suggestion& suggestion, const std::string& unit) {
  fmt::print("tissues\n");
  for (std::size_t t = 0; t < suggestion.typical.size(); ++t) {
    fmt::print("  {:<24} typically {:.0f}{}\n", suggestion.scene.tissues[t].name, suggestion.typical[t], unit);
  }
  fmt::print("boundaries\n");
  for (const modes::FoundBoundary& boundary : suggestion.boundaries) {
    fmt::print("  {:<36} felt at {:.0f}{}; {:.1f} % of what lies at boundaries\n",
               suggestion.scene.modes[boundary.mode].name, boundary.middle, unit, 100 * boundary.share);
  }
}

void run(const SuggestOptions& options) {
  const auto volume = std::make_shared<const io::Volume>(load_series(options.series));
  const modes::Suggestion suggestion = modes::suggest(volume, terminal_progress("looking for tissues"));
  if (suggestion.boundaries.empty()) {
    throw InputRefused(say("no-boundary-between-tissues-was-found", options.series.path));
  }
  const std::string text = modes::to_json(suggestion.scene);
  if (options.output.empty()) {
    fmt::print("{}\n", text);
    return;
  }
  const std::filesystem::path scene = options.output;
  std::filesystem::path picture = scene;
  picture.replace_extension(".png");
  // The picture first: without it there shall be no scene that looks complete.
  write_suggestion_png(suggestion, volume, picture);
  write_text(scene, text + "\n");
  print_words(suggestion, volume->unit.empty() ? "" : " " + volume->unit);
  fmt::print("\nwritten: {} and {}\nfeel it: palpate probe {} --scene {}\n", scene.string(), picture.string(),
             options.series.path, scene.string());
}

}  // namespace

void add_suggest(CLI::App& program) {
  auto options = std::make_shared<SuggestOptions>();
  CLI::App* command = program.add_subcommand(
      "suggest", "Tissues, boundaries and transfer functions proposed from the data: a scene to edit and to feel.");
  add_series_option(*command, options->series);
  command->add_option("-o,--output", options->output,
                      "the scene's file, and beside it a picture of what was found (default: the scene to stdout)");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
