#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "palpate/device/simulated_stylus.h"
#include "palpate/plugin/command.h"
#include "palpate/plugin/probe_path.h"
#include "palpate/plugin/run_session.h"
#include "palpate/plugin/series_option.h"
#include "palpate/plugin/stylus_option.h"

namespace palpate::plugin {
namespace {

struct Arguments {
  SeriesOption series;
  StylusOption stylus;
  ProbePathOption path;
  std::string scene;
  std::filesystem::path output;
  double seconds = 0;
  bool live = false;
};

void run(const Arguments& arguments) {
  if (std::filesystem::exists(arguments.output)) {
    throw InputRefused(arguments.output.string() + " exists; name another file");
  }
  const std::shared_ptr<device::Stylus> stylus = make_stylus(arguments.stylus);
  const auto volume = std::make_shared<const io::Volume>(load_series(arguments.series));
  SessionRun session{.scene = suited_to(scene_for(arguments.scene, *volume), stylus->specification()),
                     .felt = {},
                     .scan_hash = hash_of(*volume),
                     .unit = volume->unit,
                     .stylus = stylus,
                     .seed = arguments.stylus.seed,
                     .seconds = arguments.seconds,
                     .at_clock_pace = true,
                     .live = arguments.live || stderr_is_terminal()};
  session.felt = prepare(session.scene, volume, stylus->specification().workspace_half_extent);
  if (auto* simulated = dynamic_cast<device::SimulatedStylus*>(stylus.get())) {
    const double end = follow_probe_path(arguments.path, *volume, session.scene, session.felt, *simulated);
    session.seconds = arguments.seconds > 0 ? arguments.seconds : end;
  }
  const SessionRunResult result = run_session(session, arguments.output);
  fmt::print("{} frames in {}; missed ticks {}, frames lost {}\n", result.recorder.written, arguments.output.string(),
             result.missed, result.recorder.lost);
  if (result.recorder.stopped) {
    throw InputRefused(result.recorder.why);
  }
}

}  // namespace

void add_record(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand(
      "record",
      "A session to a file, at the clock's pace: until Ctrl-C, --seconds, or the end of a simulated hand's path.");
  add_series_option(*command, arguments->series);
  command->add_option("-o,--output", arguments->output, "the recording: an HDF5 file that is not there yet")
      ->required();
  command->add_option("--scene", arguments->scene,
                      "a scene's file or the name of a starting scene (default: one that suits the modality)");
  add_probe_path_option(*command, arguments->path);
  add_stylus_option(*command, arguments->stylus);
  command->add_option("--seconds", arguments->seconds, "how long (default: until it ends or Ctrl-C)");
  command->add_flag("--live", arguments->live, "show what is felt, also where stderr is no terminal");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace palpate::plugin
