#include "plugin/options/series_option.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "io/errors.h"
#include "io/load.h"
#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"
#include "plugin/session/scan_values.h"

namespace palpate::plugin {
namespace {

std::string list_of(const std::vector<io::Series>& series, bool usable_only) {
  std::string list;
  for (std::size_t n = 0; n < series.size(); ++n) {
    if (series[n].usable || !usable_only) list += "\n  " + describe_series(n + 1, series[n]);
  }
  return list;
}

[[noreturn]] void refuse_choice(const Text& why, const io::Catalogue& catalogue, bool usable_only) {
  throw WrongUsage(say("choose-a-series", why, list_of(numbered_series(catalogue), usable_only)));
}

io::Series named_series(const SeriesOption& option, const io::Catalogue& catalogue) {
  const std::vector<io::Series> series = numbered_series(catalogue);
  std::size_t number = 0;
  const char* const end = option.series.data() + option.series.size();
  const auto parsed = std::from_chars(option.series.data(), end, number);
  if (parsed.ec == std::errc() && parsed.ptr == end) {
    if (number >= 1 && number <= series.size()) return series[number - 1];
    refuse_choice(say("there-is-no-series", number, option.path), catalogue, false);
  }
  const auto has_uid = [&](const io::Series& s) { return s.uid == option.series; };
  const auto count = std::count_if(series.begin(), series.end(), has_uid);
  if (count == 1) return *std::find_if(series.begin(), series.end(), has_uid);
  if (count == 0) refuse_choice(say("there-is-no-series", option.series, option.path), catalogue, false);
  refuse_choice(say("volumes-do-not-fit-together", option.series, count), catalogue, false);
}

io::Series only_series(const SeriesOption& option, const io::Catalogue& catalogue) {
  const auto usable =
      std::count_if(catalogue.series.begin(), catalogue.series.end(), [](const auto& s) { return s.usable; });
  if (usable == 1) return catalogue.series.front();  // usable ones come first
  if (usable > 1) refuse_choice(say("holds-series", option.path, usable), catalogue, true);
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

std::vector<io::Series> numbered_series(const io::Catalogue& catalogue) {
  std::vector<io::Series> all = catalogue.series;
  all.insert(all.end(), catalogue.velocity_fields.begin(), catalogue.velocity_fields.end());
  return all;
}

void add_series_option(CLI::App& command, SeriesOption& option) {
  command.add_option("SERIES", option.path, "Folder or file of a DICOM series")->required();
  command.add_option("--series", option.series,
                     "Which series, where there are several: number (as info counts) or UID");
  command.add_option("--frame", option.frame, "Which frame, where several images lie at a position, from 0")
      ->check(CLI::NonNegativeNumber);
}

io::Series choose_series(const SeriesOption& option, const io::Catalogue& catalogue) {
  io::Series series = option.series.empty() ? only_series(option, catalogue) : named_series(option, catalogue);
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
  const io::Series series = choose_series(option);
  io::LoadOptions how;
  how.frame = option.frame;
  how.progress = terminal_progress("reading slices");
  io::Volume volume = scan_values(io::load(series, how));
  const auto show = [](const std::string& warning) {
    std::fprintf(stderr, "palpate: warning: %s\n", printable(warning).c_str());
  };
  std::for_each(series.warnings.begin(), series.warnings.end(), show);
  std::for_each(volume.warnings.begin(), volume.warnings.end(), show);
  return volume;
}

std::string describe_series(std::size_t number, const io::Series& series) {
  const io::Geometry& g = series.geometry;
  std::string text = fmt::format("{}  {}  \"{}\"", number, series.modality, series.description);
  if (g.dimensions.x > 0) {
    text += fmt::format("  {} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm", g.dimensions.x, g.dimensions.y,
                        g.dimensions.z, g.spacing_i, g.spacing_j, g.slice_spacing());
  }
  if (!series.part.empty()) text += ", " + series.part;
  if (series.frames_per_position > 1) text += fmt::format(", {} frames", series.frames_per_position);
  if (!series.usable) text += "  (not a volume)";
  return text + "  " + series.uid;
}

std::string printable(const std::string& text) {
  std::string shown;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const auto byte = static_cast<unsigned char>(text[n]);
    const auto next = n + 1 < text.size() ? static_cast<unsigned char>(text[n + 1]) : 0U;
    const bool is_control = (byte < 0x20 && byte != '\n') || byte == 0x7F;
    const bool is_c1 = byte == 0xC2 && next >= 0x80 && next < 0xA0;  // in UTF-8
    if (is_control || is_c1) {
      shown += fmt::format("\\x{:02x}", is_c1 ? next : byte);
      n += is_c1 ? 1 : 0;
    } else {
      shown += text[n];
    }
  }
  return shown;
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

}  // namespace palpate::plugin
