#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "io/fresh_folder.h"
#include "plugin/app/errors.h"
#include "plugin/app/interruptible.h"
#include "plugin/app/open_scan.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/ready_session.h"
#include "plugin/cli/session_option.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
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

/// A folder of that name, which is new or empty.
void make_folder(const std::filesystem::path& name) {
  io::FreshFolder(name).commit();
}

/// The summary of the recording and its pictures.
struct Results {
  Summary summary;
  std::string words;
  std::vector<std::string> pictures;
};

Results write_results(const std::filesystem::path& file, const SessionRun& session, const io::Volume& volume,
                      const device::Specification& stylus) {
  const std::filesystem::path folder = file.parent_path();
  const Recording recording = read_recording(file);
  Results results{.summary = summarize(recording, *session.felt.plan), .words = {}, .pictures = {}};
  add_uncertainty(results.summary, session.scene, *session.felt.source, volume.geometry);
  results.words = to_text(results.summary, session.scene, describe_scan(*session.felt.volume), stylus.name);
  write_text(folder / "summary.txt", results.words);
  results.pictures = write_session_pictures(recording, results.summary, session.scene, *session.felt.plan,
                                            *session.felt.source, volume.unit, folder);
  return results;
}

void run(const ProbeOptions& options) {
  // Everything that can be refused is refused before anything is loaded or written.
  const std::shared_ptr<device::Stylus> stylus = make_stylus(options.session.stylus);
  { const io::FreshFolder can_be_made(options.output); }
  auto [volume, session, simulated] = prepare_session(options.session, stylus);
  session.at_clock_pace = options.at_clock_pace || !simulated;
  const Interruptible interruptible;  // to the last picture
  // The folder has its name before the session begins: whatever ends the program, what was recorded is found there.
  make_folder(options.output);
  const std::filesystem::path file = options.output / "recording.h5";
  try {
    const SessionRunResult result = run_session(session, file);
    if (result.recorder.stopped) throw InputRefused(result.recorder.why);
    const Results results = write_results(file, session, *volume, stylus->specification());
    if (options.json) {
      put_json_text(to_json(results.summary, session.scene));
    } else {
      put("{}\nWritten to {}: recording.h5, summary.txt, {}\n", results.words, options.output.string(),
          fmt::join(results.pictures, ", "));
    }
  } catch (...) {
    std::error_code not_empty;
    std::filesystem::remove(options.output, not_empty);  // nothing was recorded
    if (std::filesystem::exists(file)) tell(say("recording-is-kept", file.string()));
    throw;
  }
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
