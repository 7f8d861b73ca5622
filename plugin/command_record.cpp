#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "palpate/plugin/command.h"
#include "palpate/plugin/session_option.h"

namespace palpate::plugin {
namespace {

struct Arguments {
  SessionOption session;
  std::filesystem::path output;
};

void run(const Arguments& arguments) {
  if (std::filesystem::exists(arguments.output)) {
    throw InputRefused(arguments.output.string() + " exists; name another file");
  }
  const ReadySession session = prepare_session(arguments.session, make_stylus(arguments.session.stylus));
  const SessionRunResult result = run_session(session.run, arguments.output);
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
  add_session_option(*command, arguments->session);
  command->add_option("-o,--output", arguments->output, "the recording: an HDF5 file that is not there yet")
      ->required();
  command->callback([arguments] { run(*arguments); });
}

}  // namespace palpate::plugin
