#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "io/fresh_folder.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/ready_session.h"
#include "plugin/cli/session_option.h"
#include "plugin/options/put.h"
#include "plugin/report/session_pictures.h"
#include "plugin/report/summary.h"
#include "plugin/report/text_file.h"

namespace palpate::plugin {
namespace {

struct ProbeOptions {
  SessionOption session;
  std::filesystem::path output = "palpate-session";
  bool at_clock_pace = false, json = false;
};

void run(const ProbeOptions& options) {
  // Everything that can be refused is refused before anything is loaded or written.
  const std::shared_ptr<device::Stylus> stylus = make_stylus(options.session.stylus);
  io::FreshFolder folder(options.output);
  auto [volume, session, simulated] = prepare_session(options.session, stylus);
  session.at_clock_pace = options.at_clock_pace || !simulated;
  const SessionRunResult result = run_session(session, folder.path() / "recording.h5");
  if (result.recorder.stopped) {
    throw InputRefused(result.recorder.why);
  }

  const Recording recording = read_recording(folder.path() / "recording.h5");
  Summary summary = summarize(recording, *session.felt.plan);
  add_uncertainty(summary, session.scene, *session.felt.source, volume->geometry);
  const std::string words =
      to_text(summary, session.scene, describe_scan(*session.felt.volume), stylus->specification().name);
  write_text(folder.path() / "summary.txt", words);
  const auto pictures = write_session_pictures(recording, summary, session.scene, *session.felt.plan,
                                               *session.felt.source, volume->unit, folder.path());
  folder.commit();

  if (options.json) {
    put_json_text(to_json(summary, session.scene));
    return;
  }
  put("{}\nWritten to {}: recording.h5, summary.txt, {}\n", words, options.output.string(), fmt::join(pictures, ", "));
}

}  // namespace

void add_probe(CLI::App& program) {
  auto options = std::make_shared<ProbeOptions>();
  CLI::App* command = program.add_subcommand(
      "probe",
      "Feels a scan with a stylus, and writes a recording, a summary and pictures.\n"
      "Without --path a simulated hand presses on the first boundary between --from and --to, slides along it, pushes\n"
      "through to the next ones and lifts off. This is computed as fast as possible, or in real time with --clock.");
  add_session_option(*command, options->session);
  command->add_flag("--clock", options->at_clock_pace, "run the simulated stylus in real time, on the servo thread");
  command->add_option("-o,--output", options->output, "folder for the results; it must be new or empty")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
