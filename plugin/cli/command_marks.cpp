#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "io/fresh_folder.h"
#include "plugin/app/errors.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"
#include "plugin/recording/marks.h"
#include "plugin/recording/recorded_session.h"
#include "plugin/report/mark_results.h"
#include "plugin/report/marks_text.h"

namespace palpate::plugin {
namespace {

struct MarksOptions {
  std::filesystem::path recording, output;
  SeriesOption series;
  bool csv = false, json = false, markups = false;
};

void print_marks(const Marks& marks, const std::string& unit) {
  for (const FeltMark& mark : marks.points) {
    put("{}  at {:.2f} s: {:.2f}, {:.2f}, {:.2f} mm  {}  {:.4g} {}  {:.2f} N\n", mark.name, mark.time_s,
        mark.position_mm.x, mark.position_mm.y, mark.position_mm.z,
        mark.boundary.empty() ? "nothing felt" : mark.boundary, mark.value, unit, mark.force_n);
  }
  for (const MarkedPath& path : marks.paths) {
    put("{}  {:.2f} to {:.2f} s: {:.2f} mm long\n", path.name, path.begin_s, path.end_s, path.length_mm);
  }
  for (const MarkedDistance& distance : marks.distances) {
    put("{} to {}: {:.2f} mm\n", marks.points[distance.from].name, marks.points[distance.to].name, distance.mm);
  }
  for (const MarkedAngle& angle : marks.angles) {
    put("angle at {}: {:.1f} degrees\n", marks.points[angle.at].name, angle.degrees);
  }
  if (marks.points.empty() && marks.paths.empty()) {
    put("no marks: the stylus' second button was never pressed\n");
  }
}

void run_marks(const MarksOptions& options) {
  const io::Volume volume = load_series(options.series);
  const Marks marks = marks_of(RecordedSession(read_recording(options.recording), volume));
  if (options.csv) {
    put("{}", marks_as_csv(marks));
  } else if (options.json) {
    put_json_text(marks_as_json(marks, volume.unit), "");
  } else if (options.markups) {
    put_json_text(marks_as_markups(marks), "");
  } else {
    print_marks(marks, volume.unit);
  }
}

void run_export(const MarksOptions& options) {
  const io::Series series = choose_series(options.series);
  const auto volume = std::make_shared<const io::Volume>(load_series(options.series));
  const Marks marks = marks_of(RecordedSession(read_recording(options.recording), *volume));
  if (marks.points.empty() && marks.paths.empty()) {
    throw InputRefused(say("holds-no-marks", options.recording.string()));
  }
  io::FreshFolder folder(options.output);
  const std::size_t pictures = write_results(series, volume, marks, folder.path()).size() - 1;
  folder.commit();
  put("{}: a report of {} marks, {} distances, {} angles and {} paths, and {} pictures; `palpate send` sends them\n",
      options.output.string(), marks.points.size(), marks.distances.size(), marks.angles.size(), marks.paths.size(),
      pictures);
}

CLI::App* add_marks_command(CLI::App& program, const char* name, const char* what,
                            const std::shared_ptr<MarksOptions>& options) {
  CLI::App* command = program.add_subcommand(name, what);
  command->add_option("RECORDING", options->recording, "a recording that `probe` or `record` has written")
      ->required()
      ->check(CLI::ExistingFile);
  add_series_option(*command, options->series);
  return command;
}

}  // namespace

void add_marks(CLI::App& program) {
  const auto options = std::make_shared<MarksOptions>();
  CLI::App* command = add_marks_command(
      program, "marks", "Lists the marks of a recording: points, paths, distances, angles (LPS, mm)", options);
  CLI::App* format = command->add_option_group("format", "how to print the marks; default: as text");
  format->require_option(0, 1);
  format->add_flag("--csv", options->csv, "print CSV, one line for each mark, path, distance and angle");
  format->add_flag("--json", options->json, "print JSON");
  format->add_flag("--mrk.json", options->markups, "print 3D Slicer's markups; save them as NAME.mrk.json");
  command->callback([options] { run_marks(*options); });
}

void add_export(CLI::App& program) {
  const auto options = std::make_shared<MarksOptions>();
  CLI::App* command = add_marks_command(
      program, "export", "Writes a recording's marks as DICOM files of the scan's study: an SR (TID 1500) and pictures",
      options);
  command->add_option("-o,--output", options->output, "a new or empty folder")->required();
  command->callback([options] { run_export(*options); });
}

}  // namespace palpate::plugin
