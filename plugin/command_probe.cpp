#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>

#include "palpate/plugin/command.h"
#include "palpate/plugin/session_option.h"
#include "palpate/plugin/session_pictures.h"
#include "palpate/plugin/summary.h"
#include "palpate/testdata/fresh_folder.h"

namespace palpate::plugin {
namespace {

struct Arguments {
  SessionOption session;
  std::filesystem::path output = "palpate-session";
  bool at_clock_pace = false, json = false;
};

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  if (!stream.flush()) {
    throw std::runtime_error("cannot write " + file.string() + " (is the disk full?)");
  }
}

void run(const Arguments& arguments) {
  // Everything that can be refused is refused before anything is loaded or written.
  const std::shared_ptr<device::Stylus> stylus = make_stylus(arguments.session.stylus);
  testdata::FreshFolder folder(arguments.output);
  auto [volume, session, simulated] = prepare_session(arguments.session, stylus);
  session.at_clock_pace = arguments.at_clock_pace || !simulated;
  const SessionRunResult result = run_session(session, folder.path() / "recording.h5");
  if (result.recorder.stopped) {
    throw InputRefused(result.recorder.why);
  }

  const Recording recording = read_recording(folder.path() / "recording.h5");
  const Summary summary = summarize(recording, *session.felt.plan);
  const std::string words = to_text(summary, session.scene, describe_scan(*volume), stylus->specification().name);
  write_text(folder.path() / "summary.txt", words);
  const auto pictures = write_session_pictures(recording, summary, session.scene, *session.felt.plan,
                                               *session.felt.source, volume->unit, folder.path());
  folder.commit();

  if (arguments.json) {
    fmt::print("{}\n", to_json(summary, session.scene));
    return;
  }
  fmt::print("{}\nWritten to {}: recording.h5, summary.txt, {}\n", words, arguments.output.string(),
             fmt::join(pictures, ", "));
}

}  // namespace

void add_probe(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand(
      "probe",
      "The main job: feel a scan with a stylus, and leave its recording, a summary and pictures.\n"
      "Without --path a simulated hand presses on the first boundary between --from and --to, slides along it, pushes\n"
      "through to the next ones and lifts off; it is as fast as the arithmetic, or at --clock's pace.");
  add_session_option(*command, arguments->session);
  command->add_flag("--clock", arguments->at_clock_pace,
                    "the simulated stylus, too, at the clock's pace on the servo thread");
  command->add_option("-o,--output", arguments->output, "folder for the results; new or empty")->capture_default_str();
  command->add_flag("--json", arguments->json, "the summary for machines");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace palpate::plugin
