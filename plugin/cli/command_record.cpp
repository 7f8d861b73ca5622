#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "plugin/app/errors.h"
#include "plugin/app/interruptible.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/ready_session.h"
#include "plugin/cli/session_option.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"

namespace palpate::plugin {
namespace {

struct RecordOptions {
  SessionOption session;
  std::filesystem::path output;
};

void run(const RecordOptions& options) {
  if (std::filesystem::exists(options.output)) {
    throw InputRefused(say("exists-name-another-file", options.output.string()));
  }
  const ReadySession session = prepare_session(options.session, make_stylus(options.session.stylus));
  const Interruptible interruptible;  // until the file is whole
  const SessionRunResult result = run_session(session.run, options.output);
  put("{}\n", in_words(result, options.output));
  if (result.recorder.stopped) {
    throw InputRefused(result.recorder.why);
  }
}

}  // namespace

void add_record(CLI::App& program) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* command = program.add_subcommand(
      "record", "Records a session in real time, until Ctrl-C, --seconds, or the end of a simulated hand's path.");
  add_session_option(*command, options->session);
  command->add_option("-o,--output", options->output, "the recording: a new HDF5 file")->required();
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
