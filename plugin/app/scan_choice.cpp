#include "plugin/app/scan_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "io/choose_first.h"
#include "io/errors.h"
#include "io/whole_scan.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

bool has_file(const io::Series& series, const std::filesystem::path& path) {
  std::error_code ignored;
  return std::ranges::any_of(series.files, [&](const auto& file) {
    return file.filename() == path.filename() && std::filesystem::equivalent(file, path, ignored);
  });
}

/// A DICOM file stands for its series.
bool is_part_of_a_series(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && !io::holds_whole_scans(path);
}

/// What may be chosen instead, for a message.
std::string what_is_there(const io::Catalogue& catalogue) {
  if (scan_count(catalogue) > 0) return list_scans(catalogue);
  if (catalogue.skipped.empty()) return " nothing";
  const io::SkippedFile& first = catalogue.skipped.front();
  return fmt::format(" {}", static_cast<const std::string&>(say("no-image-among-files", catalogue.skipped.size(),
                                                                first.path.filename().string(), first.reason)));
}

}  // namespace

std::size_t scan_count(const io::Catalogue& catalogue) {
  return catalogue.series.size() + catalogue.velocity_fields.size();
}

const io::Series& scan_at(const io::Catalogue& catalogue, std::size_t index) {
  return is_velocity(catalogue, index) ? catalogue.velocity_fields[index - catalogue.series.size()]
                                       : catalogue.series[index];
}

std::string scan_name(const io::Catalogue& catalogue, std::size_t index) {
  if (is_velocity(catalogue, index)) return scan_at(catalogue, index).uid;  // of its series, joined
  const std::string& uid = catalogue.series[index].uid;
  const auto end = catalogue.series.begin() + static_cast<std::ptrdiff_t>(index);
  const auto before = std::count_if(catalogue.series.begin(), end, [&](const auto& s) { return s.uid == uid; });
  return before == 0 ? uid : fmt::format("{}#{}", uid, before + 1);
}

std::string scan_label(const io::Series& series) {
  const glm::ivec3& size = series.geometry.dimensions;
  std::string label = fmt::format("{} {}, {} x {} x {}", series.modality,
                                  series.description.empty() ? "series" : series.description, size.x, size.y, size.z);
  if (!series.part.empty()) label += ", " + series.part;
  if (series.frames_per_position > 1) label += fmt::format(" x {}", series.frames_per_position);
  return series.usable ? label : label + " (not a volume)";
}

std::string describe_series(std::size_t number, const io::Series& series, const std::string& name) {
  const io::Geometry& g = series.geometry;
  std::string text = fmt::format("{}  {}  \"{}\"", number, series.modality, series.description);
  if (g.dimensions.x > 0) {
    text += fmt::format("  {} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm", g.dimensions.x, g.dimensions.y,
                        g.dimensions.z, g.spacing_i, g.spacing_j, g.slice_spacing());
  }
  if (!series.part.empty()) text += ", " + series.part;
  if (series.frames_per_position > 1) text += fmt::format(", {} frames", series.frames_per_position);
  if (!series.usable) text += "  (not a volume)";
  return text + "  " + name;
}

std::string list_scans(const io::Catalogue& catalogue, bool usable_only) {
  std::string list;
  for (std::size_t n = 0; n < scan_count(catalogue); ++n) {
    const io::Series& series = scan_at(catalogue, n);
    if (series.usable || !usable_only) list += "\n  " + describe_series(n + 1, series, scan_name(catalogue, n));
  }
  return list;
}

std::optional<std::size_t> find_scan(const io::Catalogue& catalogue, const std::string& name) {
  std::size_t number = 0;
  const char* const end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data(), end, number);
  if (parsed.ec == std::errc() && parsed.ptr == end) {
    return number >= 1 && number <= scan_count(catalogue) ? std::optional(number - 1) : std::nullopt;
  }
  for (std::size_t n = 0; n < scan_count(catalogue); ++n) {
    if (scan_name(catalogue, n) == name) return n;
  }
  return {};
}

std::size_t volumes_of(const io::Catalogue& catalogue, const std::string& uid) {
  return static_cast<std::size_t>(std::ranges::count(catalogue.series, uid, &io::Series::uid));
}

std::optional<std::size_t> only_scan(const io::Catalogue& catalogue) {
  std::optional<std::size_t> only;
  for (std::size_t n = 0; n < scan_count(catalogue); ++n) {
    if (!scan_at(catalogue, n).usable) continue;
    if (only) return {};
    only = n;
  }
  return only;
}

std::vector<std::size_t> choices(const io::Catalogue& catalogue, const std::filesystem::path& path) {
  std::vector<std::size_t> order(scan_count(catalogue));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::optional<std::size_t> meant;
  if (is_part_of_a_series(path)) {
    const auto with =
        std::ranges::find_if(catalogue.series, [&](const auto& series) { return has_file(series, path); });
    if (with != catalogue.series.end()) meant = static_cast<std::size_t>(with - catalogue.series.begin());
  } else if (const auto first = io::choose_first(catalogue.series)) {
    meant = first->index;
  }
  if (meant) {
    const auto at = order.begin() + static_cast<std::ptrdiff_t>(*meant);
    std::rotate(order.begin(), at, at + 1);
  }
  return order;
}

std::size_t choose_scan(const io::Catalogue& catalogue, const std::string& name, const std::filesystem::path& path) {
  const std::string where = path.filename().string();
  if (!name.empty()) {
    if (const auto found = find_scan(catalogue, name)) return *found;
    throw io::DicomError(say("no-series-there", where, name, what_is_there(catalogue)));
  }
  if (is_part_of_a_series(path)) {
    if (std::ranges::none_of(catalogue.series, [&](const auto& series) { return has_file(series, path); })) {
      throw io::DicomError(say("not-part-of-a-series", where, what_is_there(catalogue)));
    }
    return choices(catalogue, path).front();
  }
  if (std::ranges::none_of(catalogue.series, [](const auto& series) { return series.usable; })) {
    throw io::DicomError(say("no-series-that-is-a-volume", where, what_is_there(catalogue)));
  }
  return choices(catalogue, path).front();
}

int frame_at(int frames, double time) {
  return static_cast<int>(std::clamp(std::round(time), 0.0, frames - 1.0));
}

}  // namespace palpate::plugin
