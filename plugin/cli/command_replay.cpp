#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "modes/scene/scene_json.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/app/run_session.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/output_files.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"
#include "plugin/recording/replay.h"
#include "plugin/report/summary.h"
#include "plugin/session/scan_hash.h"

namespace palpate::plugin {
namespace {

struct ReplayOptions {
  std::filesystem::path recording, csv;
  SeriesOption series;
  std::vector<std::filesystem::path> structures;
  bool json = false;
};

/// The frame of the series that was felt last; another one takes its place, so that one at a time is in memory.
struct FeltFrame {
  int number = -1;
  std::shared_ptr<const io::Volume> volume;
  std::string hash;
};

/// Each scene of the recording, on the frame of the series where it was felt; if the recording does not contain the
/// frame, on the one of --frame.
SnapshotMaker on_series(const io::Series& series, int otherwise, StructureFiles files) {
  return [series, otherwise, files = std::move(files), felt = FeltFrame()](const SceneRecord& record) mutable {
    const int told = record.frame ? record.frame->number : otherwise;
    const int number = told < series.frames_per_position ? told : otherwise;
    if (number != felt.number) {
      felt = {number, std::make_shared<const io::Volume>(open_scan(series, number)), {}};
      felt.hash = hash_of(*felt.volume);
    }
    if (record.scan_hash != felt.hash) {
      throw InputRefused(say("recorded-on-another-scan", record.scan_hash, felt.hash));
    }
    return snapshot_of(record, felt.volume, files);
  };
}

Replay replay_of(const Recording& recording, const SnapshotMaker& make_snapshot,
                 const std::filesystem::path& file) try {
  return replay(recording, make_snapshot);
} catch (const DamagedRecording& error) {
  throw InputRefused(at_place(file.string(), error.text()));
}

/// The uncertainty of the boundaries that held the proxy, over the ticks for which it is known.
Percentiles known_to_of(const Recording& recording) {
  std::vector<double> known;
  std::ranges::copy_if(recording.known_to_mm, std::back_inserter(known), [](double mm) { return std::isfinite(mm); });
  return percentiles_of(std::move(known));
}

/// "frame 2 of 0 to 16"; empty for a series with one frame, and where the recording does not tell.
std::string frames_in_words(const std::vector<ScanFrame>& frames) {
  std::string words;
  for (const ScanFrame& frame : frames) {
    if (frame.count > 1) words += fmt::format("{}{}", words.empty() ? "" : ", ", frame.number);
  }
  return words.empty() ? words : fmt::format("frame {} of 0 to {}", words, frames.front().count - 1);
}

std::string verdict(const Replay& replay) {
  if (replay.different == 0) {
    return "the same to the last bit";
  }
  return fmt::format(
      "{} differ, the first is tick {}: the proxy by at most {:.1e} m (certified bounds of the two together {:.1e} "
      "m), "
      "the force sent by at most {:.1e} N",
      replay.different, *replay.first_different, replay.largest_proxy_m, replay.largest_bound_m,
      replay.largest_force_n);
}

void print_json(const Replay& replay, const Recording& recording) {
  nlohmann::ordered_json json{{"frames", replay.ticks},
                              {"different", replay.different},
                              {"first_different", nullptr},
                              {"largest_proxy_m", replay.largest_proxy_m},
                              {"largest_force_n", replay.largest_force_n},
                              {"largest_bound_m", replay.largest_bound_m},
                              {"after_gap", replay.after_gap}};
  json["scan_frames"] = nlohmann::json::array();
  for (const ScanFrame& frame : scan_frames_of(recording)) json["scan_frames"].push_back(frame.number);
  json["registered"] = nlohmann::json::array();
  for (const RegisteredStructure& one : registered_of(recording)) {
    json["registered"].push_back(
        {{"structure", one.structure}, {"registration", one.file_hash}, {"moved_by", in_words(one.motion)}});
  }
  const Percentiles known = known_to_of(recording);
  json["known_to_mm"] =
      known.largest > 0 ? nlohmann::json{{"median", known.median}, {"largest", known.largest}} : nlohmann::json();
  if (replay.first_different) json["first_different"] = *replay.first_different;
  put_json(json, 1);
}

void run(const ReplayOptions& options) {
  if (options.series.path.empty() && options.csv.empty()) {
    throw WrongUsage(say("replay-needs-the-series-that-was-felt"));
  }
  std::vector<std::filesystem::path> inputs = options.structures;
  inputs.push_back(options.recording);
  std::optional<io::Series> series;
  if (!options.series.path.empty()) {
    series = choose_series(options.series);
    inputs.insert(inputs.end(), series->files.begin(), series->files.end());
  }
  check_outputs({options.csv}, inputs);
  const Recording recording = read_recording(options.recording);
  if (!recording.complete) {
    tell(say("not-closed-in-good-order", options.recording.string(), recording.ticks.size()));
  }
  if (!options.csv.empty()) {
    write_csv(recording, options.csv);
  }
  if (!series) return;
  std::vector<std::filesystem::path> places = options.structures;
  const std::filesystem::path beside = structures_beside(options.recording);
  if (std::filesystem::is_directory(beside)) places.push_back(beside);
  places.push_back(options.series.path);
  const Replay result = replay_of(
      recording, on_series(*series, options.series.frame, StructureFiles(std::move(places))), options.recording);
  if (options.json) {
    print_json(result, recording);
  } else {
    put("{} ticks replayed: {}\n", result.ticks, verdict(result));
    if (const std::string frames = frames_in_words(scan_frames_of(recording)); !frames.empty()) {
      put("felt: {}\n", frames);
    }
    for (const RegisteredStructure& one : registered_of(recording)) {
      put("{} is moved by {}, as it was then: the registration {}\n", one.structure, in_words(one.motion),
          one.file_hash);
    }
    if (const Percentiles known = known_to_of(recording); known.largest > 0) {
      put("boundaries that were felt: known to +-{:.2g} mm (median), at most +-{:.2g} mm\n", known.median,
          known.largest);
    }
    if (result.after_gap > 0) {
      put("{} ticks come after some that were lost, and cannot be replayed\n", result.after_gap);
    }
  }
  // Another build may differ by what both certify; more than that is another session.
  if (!(result.largest_proxy_m <= result.largest_bound_m) || !std::isfinite(result.largest_force_n)) {
    throw InputRefused(say("replay-is-not-the-session"));
  }
}

}  // namespace

void add_replay(CLI::App& program) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = program.add_subcommand(
      "replay",
      "Runs a recorded session again, tick by tick, and compares the forces with the recorded ones. On the same build\n"
      "they are equal to the last bit. The stylus is not needed.");
  command->add_option("RECORDING", options->recording, "a recording that `probe` or `record` has written")
      ->required()
      ->check(CLI::ExistingFile);
  add_series_option(*command, options->series);
  command->get_option("SERIES")->required(false);
  command->get_option("--frame")->description(
      "Which frame (from 0); recordings made before 0.2.0 do not contain the number");
  command->add_option("--csv", options->csv, "also write a CSV file with a line for every tick");
  command
      ->add_option(
          "--structures", options->structures,
          "files and folders with the structures that were felt, if they are neither beside the series nor in the "
          "recording's folder FILE.structures")
      ->check(CLI::ExistingPath);
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
