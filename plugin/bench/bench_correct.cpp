#include "plugin/bench/bench_correct.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "io/fresh_folder.h"
#include "plugin/bench/edit_cost.h"
#include "plugin/report/text_file.h"

namespace palpate::plugin {
namespace {

struct CorrectArguments {
  std::string output;
  int rounds = 10;
};

}  // namespace

void add_bench_correct(CLI::App& bench) {
  auto arguments = std::make_shared<CorrectArguments>();
  CLI::App* command = bench.add_subcommand("correct", "What an edit of an outline costs.");
  command->add_option("--rounds", arguments->rounds, "each edit is timed so often")->capture_default_str();
  command->add_option("-o,--output", arguments->output, "also write CSV files to this new or empty folder");
  command->callback([arguments] {
    io::write_all_or_none(arguments->output, [&](const std::filesystem::path& folder) {
      const std::string costs = tabulate_edit_costs(arguments->rounds);
      if (!folder.empty()) write_text(folder / "cost.csv", costs);
    });
  });
}

}  // namespace palpate::plugin
