#include "plugin/options/series_option.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>

#include "io/errors.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/app/scan_choice.h"
#include "plugin/messages/messages.h"

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
  command
      .add_option("SERIES", option.path,
                  "Folder or file of a series: DICOM (also .zip, .tar.gz), NIfTI, NRRD, MetaImage")
      ->required();
  command.add_option("--series", option.series,
                     "Which series, if there are several: number or name, as `palpate info` lists them");
  command
      .add_option("--frame", option.frame, "Which frame, counted from 0, if there are several (time, b-value, echo)")
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
  return open_scan(choose_series(option), option.frame);
}

}  // namespace palpate::plugin
