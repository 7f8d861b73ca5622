#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/output_files.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"
#include "plugin/report/compare_strokes.h"

namespace palpate::plugin {
namespace {

struct CompareOptions {
  std::filesystem::path first, second, picture, table;
  SeriesOption series;
  bool json = false;
};

RecordedSession read_session(const std::filesystem::path& file, const io::Volume& volume) try {
  return RecordedSession(read_recording(file), volume);
} catch (const Refusal& error) {
  const std::string name = file.string();
  throw InputRefused(error.text().starts_with(name) ? error.text() : at_place(name, error.text()));
} catch (const std::exception& error) {
  throw InputRefused(say("cannot-read-the-recording", file.string(), error.what()));
}

void run(const CompareOptions& options) {
  const io::Series series = choose_series(options.series);
  std::vector<std::filesystem::path> inputs = series.files;
  inputs.insert(inputs.end(), {options.first, options.second});
  check_outputs({options.picture, options.table}, inputs);
  const io::Volume volume = open_scan(series, options.series.frame);
  const Comparison comparison =
      compare_strokes(read_session(options.first, volume), read_session(options.second, volume));
  if (!options.picture.empty()) {
    write_png(charts_of(comparison, options.first.stem().string(), options.second.stem().string()), options.picture);
  }
  if (!options.table.empty()) write_csv(comparison, options.table);
  if (options.json) {
    const nlohmann::ordered_json json{{"along_mm", comparison.along_mm},
                                      {"first_n", comparison.first_n},
                                      {"second_n", comparison.second_n},
                                      {"apart_mm", comparison.apart_mm},
                                      {"most_apart_mm", comparison.most_apart_mm},
                                      {"largest_difference_n", comparison.largest_difference_n},
                                      {"largest_difference_at_mm", comparison.largest_difference_at_mm},
                                      {"mean_difference_n", comparison.mean_difference_n}};
    put_json(json);
  } else {
    put("{}\n", in_words(comparison));
  }
}

}  // namespace

void add_compare(CLI::App& program) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = program.add_subcommand("compare",
                                             "Compares the forces of two recordings of one stroke through a scan, at "
                                             "equal places along it. The speeds may differ.");
  command->add_option("FIRST", options->first, "a recording")->required()->check(CLI::ExistingFile);
  command->add_option("SECOND", options->second, "another, made on the same scan")
      ->required()
      ->check(CLI::ExistingFile);
  add_series_option(*command, options->series);
  command->add_option("-o,--picture", options->picture, "also draw both, as a PNG file");
  command->add_option("--table", options->table, "also write a CSV file with a line for each step of the stroke");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
