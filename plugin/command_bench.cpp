#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "palpate/plugin/bench_fields.h"
#include "palpate/plugin/bench_load.h"
#include "palpate/plugin/bench_soak.h"
#include "palpate/plugin/bench_solvers.h"
#include "palpate/plugin/bench_subdivision.h"
#include "palpate/plugin/bench_tick.h"
#include "palpate/plugin/command.h"
#include "palpate/plugin/extremes_study.h"
#include "palpate/plugin/loop_studies.h"
#include "palpate/testdata/fresh_folder.h"

namespace palpate::plugin {
namespace {

struct StabilityArguments {
  LoopStudyOptions options;
  std::string output;
};

void add_stability(CLI::App& bench) {
  auto arguments = std::make_shared<StabilityArguments>();
  CLI::App* command = bench.add_subcommand(
      "stability",
      "Solvers at extremes, over frames and in the hand: errors, creep, drift, chatter, and the stiffness that holds.");
  command->add_option("--seconds", arguments->options.seconds, "of each study over frames")->capture_default_str();
  command->add_option("--hands", arguments->options.hands, "seeded hands")->capture_default_str();
  command->add_option("-o,--output", arguments->output, "also write CSV and pictures to this folder; new or empty");
  command->callback([arguments] {
    testdata::write_all_or_none(arguments->output, [&](const std::filesystem::path& folder) {
      run_extremes(folder);
      run_loop_studies(arguments->options, folder);
    });
  });
}

}  // namespace

void add_bench(CLI::App& program) {
  CLI::App* bench = program.add_subcommand("bench", "Error against run time, as tables, CSV files and pictures.");
  bench->require_subcommand(1);
  add_stability(*bench);
  add_bench_fields(*bench);
  add_bench_load(*bench);
  add_bench_soak(*bench);
  add_bench_solvers(*bench);
  add_bench_subdivision(*bench);
  add_bench_tick(*bench);
}

}  // namespace palpate::plugin
