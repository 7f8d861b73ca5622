#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "modes/scene/scene_json.h"
#include "plugin/app/errors.h"
#include "plugin/app/run_session.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "plugin/options/series_option.h"
#include "plugin/recording/replay.h"
#include "plugin/session/scan_hash.h"

namespace palpate::plugin {
namespace {

struct ReplayOptions {
  std::filesystem::path recording, csv;
  SeriesOption series;
  std::vector<std::filesystem::path> structures;
  bool json = false;
};

/// Scenes of the recording on the one scan that is named.
SnapshotMaker on_scan(const std::shared_ptr<const io::Volume>& volume, StructureFiles files) {
  const std::string hash = hash_of(*volume);
  return [volume, hash, files = std::move(files)](const SceneRecord& record) mutable {
    if (record.scan_hash != hash) {
      throw InputRefused(say("recorded-on-another-scan", record.scan_hash, hash));
    }
    return snapshot_of(record, volume, files);
  };
}

std::string verdict(const Replay& replay) {
  if (replay.different == 0) {
    return "the same to the last bit";
  }
  return fmt::format(
      "{} differ, the first is frame {}: the proxy by at most {:.1e} m (certified bounds of the two together {:.1e} "
      "m), "
      "the force sent by at most {:.1e} N",
      replay.different, *replay.first_different, replay.largest_proxy_m, replay.largest_bound_m,
      replay.largest_force_n);
}

void print_json(const Replay& replay) {
  nlohmann::ordered_json json{{"frames", replay.frames},
                              {"different", replay.different},
                              {"first_different", nullptr},
                              {"largest_proxy_m", replay.largest_proxy_m},
                              {"largest_force_n", replay.largest_force_n},
                              {"largest_bound_m", replay.largest_bound_m},
                              {"after_gap", replay.after_gap}};
  if (replay.first_different) json["first_different"] = *replay.first_different;
  fmt::print("{}\n", json.dump(1));
}

void run(const ReplayOptions& options) {
  if (options.series.path.empty() && options.csv.empty()) {
    throw WrongUsage(say("replay-needs-the-series-that-was-felt"));
  }
  const Recording recording = read_recording(options.recording);
  if (!recording.complete) {
    tell(say("not-closed-in-good-order", options.recording.string(), recording.frames.size()));
  }
  if (!options.csv.empty()) {
    write_csv(recording, options.csv);
  }
  if (options.series.path.empty()) {
    return;
  }
  const auto volume = std::make_shared<const io::Volume>(load_series(options.series));
  std::vector<std::filesystem::path> places = options.structures;
  places.push_back(options.series.path);
  const Replay result = replay(recording, on_scan(volume, StructureFiles(std::move(places))));
  if (options.json) {
    print_json(result);
  } else {
    fmt::print("{} frames replayed: {}\n", result.frames, verdict(result));
    if (result.after_gap > 0) {
      fmt::print("{} frames come after some that were lost, and cannot be replayed\n", result.after_gap);
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
      "A recorded session again, frame by frame, compared with what was recorded: on the same build the same to the\n"
      "last bit, whichever stylus it was made with.");
  command->add_option("RECORDING", options->recording, "what `probe` or `record` wrote")
      ->required()
      ->check(CLI::ExistingFile);
  add_series_option(*command, options->series);
  command->get_option("SERIES")->required(false);
  command->add_option("--csv", options->csv, "also export it: a line a frame, every member a column");
  command
      ->add_option("--structures", options->structures,
                   "files and folders with the structures that were felt, where they are not beside the series")
      ->check(CLI::ExistingPath);
  command->add_flag("--json", options->json, "for machines");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
