#include "plugin/bench/bench_correct.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/fresh_folder.h"
#include "io/structures/structure.h"
#include "plugin/bench/edit_cost.h"
#include "plugin/bench/organ_touch_study.h"
#include "plugin/bench/touch_study.h"
#include "plugin/options/series_option.h"
#include "plugin/report/text_file.h"

namespace palpate::plugin {
namespace {

struct CorrectArguments {
  std::string output;
  int rounds = 10;
  TouchStudyOptions study;
  SeriesOption series;
  std::vector<std::filesystem::path> structures;
  std::vector<std::string> organs;
};

}  // namespace

void add_bench_correct(CLI::App& bench) {
  auto arguments = std::make_shared<CorrectArguments>();
  CLI::App* command =
      bench.add_subcommand("correct", "What an edit of an outline costs, and whether touch helps a simulated hand.");
  command->add_option("--rounds", arguments->rounds, "how many times each edit is timed")->capture_default_str();
  command->add_option("--hands", arguments->study.hands, "seeded hands for each error")->capture_default_str();
  add_series_option(*command, arguments->series);
  CLI::Option* const structures =
      command
          ->add_option("--structures", arguments->structures,
                       "also on organs that were outlined on SERIES: SEG, RTSTRUCT, label map, or a folder of them")
          ->check(CLI::ExistingPath);
  command->get_option("SERIES")->required(false)->needs(structures);
  structures->needs("SERIES");
  command->add_option("--organs", arguments->organs, "names of these organs (default: the largest three)")
      ->needs(structures);
  command->add_option("-o,--output", arguments->output,
                      "also write CSV files and a picture to this new or empty folder");
  command->callback([arguments] {
    io::write_all_or_none(arguments->output, [&](const std::filesystem::path& folder) {
      const std::string costs = tabulate_edit_costs(arguments->rounds);
      const std::string touch = study_touch(arguments->study, folder);
      std::string organs;
      if (!arguments->series.path.empty()) {
        const auto scan = std::make_shared<const io::Volume>(load_series(arguments->series));
        organs = study_touch_on_organs(scan, io::find_structures(arguments->structures).structures,
                                       {.organs = arguments->organs, .hands = arguments->study.hands});
      }
      if (folder.empty()) return;
      if (!organs.empty()) write_text(folder / "organs.csv", organs);
      write_text(folder / "cost.csv", costs);
      write_text(folder / "touch.csv", touch);
    });
  });
}

}  // namespace palpate::plugin
