#include "plugin/options/series_option.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "io/errors.h"
#include "io/load.h"
#include "modes/scene/starting_scene.h"
#include "plugin/app/errors.h"
#include "plugin/app/scan_choice.h"
#include "plugin/messages/messages.h"
#include "plugin/session/scan_values.h"
#include "solver/text/printable.h"

namespace palpate::plugin {
namespace {

[[noreturn]] void refuse_choice(const Text& why, const io::Catalogue& catalogue, bool usable_only) {
  throw WrongUsage(say("choose-a-series", why, list_scans(catalogue, usable_only)));
}

std::size_t named_series(const SeriesOption& option, const io::Catalogue& catalogue) {
  if (const std::size_t count = volumes_of(catalogue, option.series); count > 1) {
    refuse_choice(say("volumes-do-not-fit-together", option.series, count), catalogue, false);
  }
  if (const auto found = find_scan(catalogue, option.series)) return *found;
  refuse_choice(say("there-is-no-series", option.series, option.path), catalogue, false);
}

std::size_t only_series(const SeriesOption& option, const io::Catalogue& catalogue) {
  if (const auto only = only_scan(catalogue)) return *only;
  const auto usable = std::ranges::count_if(catalogue.series, &io::Series::usable);
  if (usable > 0) refuse_choice(say("holds-series", option.path, usable), catalogue, true);
  std::string why;
  if (!catalogue.series.empty()) {
    why = catalogue.series.front().warnings.empty() ? "" : ": " + catalogue.series.front().warnings.front();
  } else if (!catalogue.skipped.empty()) {
    const io::SkippedFile& first = catalogue.skipped.front();
    why = say("none-is-an-image", catalogue.skipped.size(), first.path.filename().string(), first.reason);
  }
  throw InputRefused(say("no-usable-series", option.path, why));
}

}  // namespace

void add_series_option(CLI::App& command, SeriesOption& option) {
  command.add_option("SERIES", option.path, "Folder or file of a series: DICOM, packed or not; NIfTI, NRRD, MetaImage")
      ->required();
  command.add_option("--series", option.series,
                     "Which series, if there are several: number or name, as `palpate info` lists them");
  command.add_option("--frame", option.frame, "Which frame, from 0, if several images lie at a position")
      ->check(CLI::NonNegativeNumber);
}

io::Series choose_series(const SeriesOption& option, const io::Catalogue& catalogue) {
  const io::Series& series =
      scan_at(catalogue, option.series.empty() ? only_series(option, catalogue) : named_series(option, catalogue));
  if (option.frame >= series.frames_per_position) {
    throw WrongUsage(say("no-such-frame", option.frame, series.uid, series.frames_per_position,
                         series.frames_per_position == 1 ? "" : "s"));
  }
  return series;
}

io::Series choose_series(const SeriesOption& option) {
  const std::array paths{std::filesystem::path(option.path)};
  return choose_series(option, io::find_series(paths, terminal_progress("finding series")));
}

io::Volume load_series(const SeriesOption& option) {
  return load_series(choose_series(option), option.frame);
}

io::Volume load_series(const io::Series& series, int frame) {
  io::LoadOptions how;
  how.frame = frame;
  how.progress = terminal_progress("reading slices");
  io::Volume volume = scan_values(io::load(series, how));
  const auto show = [](const std::string& warning) {
    std::fprintf(stderr, "palpate: warning: %s\n", printable(warning).c_str());
  };
  std::for_each(series.warnings.begin(), series.warnings.end(), show);
  std::for_each(volume.warnings.begin(), volume.warnings.end(), show);
  return volume;
}

io::Progress terminal_progress(std::string what) {
  if (::isatty(STDERR_FILENO) == 0) return {};
  return [what = std::move(what), shown = -1](double done) mutable {
    const int percent = static_cast<int>(100 * done);
    if (percent != shown)
      std::fprintf(stderr, "\r%s %3d %%%s", what.c_str(), percent, percent == 100 ? "\r\033[K" : "");
    shown = percent;
    return true;
  };
}

std::string scene_name(const std::string& given, const io::Series& series, const io::Volume& volume) {
  return given.empty() && !volume.vectors ? modes::starting_scene(series) : given;
}

}  // namespace palpate::plugin
