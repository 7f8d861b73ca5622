#include "plugin/paraview/common/scan_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "io/errors.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

std::int64_t voxel_count(const io::Series& series) {
  const glm::ivec3& size = series.geometry.dimensions;
  return std::int64_t{size.x} * size.y * size.z * (series.usable ? 1 : -1);
}

bool has_file(const io::Series& series, const std::filesystem::path& path) {
  std::error_code ignored;
  return std::ranges::any_of(series.files, [&](const auto& file) {
    return file.filename() == path.filename() && std::filesystem::equivalent(file, path, ignored);
  });
}

/// What may be chosen instead, for a message.
std::string what_is_there(const io::Catalogue& catalogue) {
  std::string there;
  for (std::size_t n = 0; n < scan_count(catalogue); ++n) {
    there += fmt::format("\n  {}  {}", scan_name(catalogue, n), scan_label(scan_at(catalogue, n)));
  }
  if (there.empty() && !catalogue.skipped.empty()) {
    const io::SkippedFile& first = catalogue.skipped.front();
    there = fmt::format(" {}", static_cast<const std::string&>(say("no-image-among-files", catalogue.skipped.size(),
                                                                   first.path.filename().string(), first.reason)));
  }
  return there.empty() ? " nothing" : there;
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

std::vector<std::size_t> choices(const io::Catalogue& catalogue, const std::filesystem::path& path) {
  const auto& all = catalogue.series;
  std::vector<std::size_t> order(scan_count(catalogue));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::error_code ignored;
  const auto first = std::filesystem::is_regular_file(path, ignored)
                         ? std::ranges::find_if(all, [&](const auto& series) { return has_file(series, path); })
                         : std::ranges::max_element(all, {}, voxel_count);
  if (first != all.end())
    std::rotate(order.begin(), order.begin() + (first - all.begin()), order.begin() + (first - all.begin()) + 1);
  return order;
}

std::size_t choose_scan(const io::Catalogue& catalogue, const std::string& name, const std::filesystem::path& path) {
  const std::string where = path.filename().string();
  if (!name.empty()) {
    for (std::size_t n = 0; n < scan_count(catalogue); ++n) {
      if (scan_name(catalogue, n) == name) return n;
    }
    throw io::DicomError(say("no-series-there", where, name, what_is_there(catalogue)));
  }
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) {
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

}  // namespace palpate::plugin
