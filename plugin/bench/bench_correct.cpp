#include "plugin/bench/bench_correct.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "io/fresh_folder.h"
#include "plugin/bench/edit_cost.h"
#include "plugin/bench/touch_study.h"
#include "plugin/report/text_file.h"

namespace palpate::plugin {
namespace {

struct CorrectArguments {
  std::string output;
  int rounds = 10;
  TouchStudyOptions study;
};

}  // namespace

void add_bench_correct(CLI::App& bench) {
  auto arguments = std::make_shared<CorrectArguments>();
  CLI::App* command =
      bench.add_subcommand("correct", "What an edit of an outline costs, and whether touch helps a simulated hand.");
  command->add_option("--rounds", arguments->rounds, "each edit is timed so often")->capture_default_str();
  command->add_option("--hands", arguments->study.hands, "seeded hands for each error")->capture_default_str();
  command->add_option("-o,--output", arguments->output,
                      "also write CSV files and a picture to this new or empty folder");
  command->callback([arguments] {
    io::write_all_or_none(arguments->output, [&](const std::filesystem::path& folder) {
      const std::string costs = tabulate_edit_costs(arguments->rounds);
      const std::string touch = study_touch(arguments->study, folder);
      if (folder.empty()) return;
      write_text(folder / "cost.csv", costs);
      write_text(folder / "touch.csv", touch);
    });
  });
}

}  // namespace palpate::plugin
