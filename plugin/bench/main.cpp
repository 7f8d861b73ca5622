// `palpate-bench`: run time and accuracy of solvers, fields, loading and the tick.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "io/fresh_folder.h"
#include "plugin/bench/bench_correct.h"
#include "plugin/bench/bench_fields.h"
#include "plugin/bench/bench_forces.h"
#include "plugin/bench/bench_load.h"
#include "plugin/bench/bench_soak.h"
#include "plugin/bench/bench_solvers.h"
#include "plugin/bench/bench_structures.h"
#include "plugin/bench/bench_subdivision.h"
#include "plugin/bench/bench_suggest.h"
#include "plugin/bench/bench_tick.h"
#include "plugin/bench/bench_waits.h"
#include "plugin/bench/extremes_study.h"
#include "plugin/bench/loop_studies.h"
#include "plugin/options/run_program.h"
#include "plugin/options/version.h"

namespace palpate::plugin {
namespace {

struct StabilityArguments {
  LoopStudyOptions options;
  std::string output;
};

void add_stability(CLI::App& bench) {
  auto arguments = std::make_shared<StabilityArguments>();
  CLI::App* command =
      bench.add_subcommand("stability",
                           "Solvers with extreme values, over many ticks and in a simulated hand: errors, "
                           "creep, drift, chatter, and the largest stiffness that is steady on each arm.");
  command->add_option("--seconds", arguments->options.seconds, "length of each study over ticks")
      ->capture_default_str();
  command->add_option("--hands", arguments->options.hands, "number of seeded tremors of each hand")
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "also write CSV and pictures to this new or empty folder");
  command->callback([arguments] {
    io::write_all_or_none(arguments->output, [&](const std::filesystem::path& folder) {
      run_extremes(folder);
      run_loop_studies(arguments->options, folder);
    });
  });
}

}  // namespace

}  // namespace palpate::plugin

int main(int argc, char** argv) {
  using namespace palpate::plugin;
  CLI::App program{"Measures error against run time, as tables, CSV files and pictures.", "palpate-bench"};
  program.set_version_flag("--version", version_text());
  add_stability(program);
  add_bench_correct(program);
  add_bench_fields(program);
  add_bench_forces(program);
  add_bench_load(program);
  add_bench_soak(program);
  add_bench_solvers(program);
  add_bench_structures(program);
  add_bench_subdivision(program);
  add_bench_suggest(program);
  add_bench_tick(program);
  add_bench_waits(program);
  return run_program(program, argc, argv);
}
