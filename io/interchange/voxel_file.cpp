#include "io/interchange/voxel_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "io/dicom/decode.h"
#include "io/errors.h"
#include "io/messages.h"
#include "io/reach.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;

constexpr double most_voxels = 2147483648.0, most_of_a_slice = 67108864.0;

// The geometry's axes: the file's own order, unless its first two are sheared against each other and others are not.
std::optional<std::array<int, 3>> axes_of(const std::array<Vec3, 3>& along) {
  constexpr double square = 1e-3;
  const auto at_right_angles = [&](std::size_t a, std::size_t b) {
    return std::abs(glm::dot(along[a], along[b])) <= square * glm::length(along[a]) * glm::length(along[b]);
  };
  for (const auto& [i, j, k] : {std::array{0, 1, 2}, std::array{0, 2, 1}, std::array{1, 2, 0}}) {
    if (at_right_angles(static_cast<std::size_t>(i), static_cast<std::size_t>(j))) return std::array{i, j, k};
  }
  return std::nullopt;
}

// All of it spans a volume, and not a plane.
bool spans_a_volume(const VoxelMap& map) {
  constexpr double least = 1e-6;  // of a box of the same edges
  const auto& [i, j, k] = map.along;
  const double box = glm::length(i) * glm::length(j) * glm::length(k);
  return std::isfinite(box + glm::length(map.first)) && box > 0 &&
         std::abs(glm::dot(glm::cross(i, j), k)) > least * box;
}

}  // namespace

std::size_t bytes_of(VoxelFile::Number number) noexcept {
  using Number = VoxelFile::Number;
  switch (number) {
    case Number::u8:
    case Number::i8:
      return 1;
    case Number::u16:
    case Number::i16:
      return 2;
    case Number::u32:
    case Number::i32:
    case Number::f32:
      return 4;
    case Number::u64:
    case Number::i64:
    case Number::f64:
      break;
  }
  return 8;
}

void read_as_colors(double numbers, VoxelFile& file) {
  const bool is_color =
      (numbers == 3 || numbers == 4) && (file.number == VoxelFile::Number::u8 || file.number == VoxelFile::Number::u16);
  if (!is_color) {
    throw DicomError(say("voxels-have-several-values", static_cast<int>(std::clamp(numbers, 0.0, 1e6))));
  }
  file.layers = static_cast<int>(numbers);
  file.beside = VoxelFile::Beside::colors;
  file.remarks.push_back(say("colors-are-read-as-gray"));
}

int count_of_volumes(double count) {
  constexpr double most = 1e6;
  if (!(count >= 1 && count <= most)) throw DicomError(say("voxels-on-no-lattice"));
  return static_cast<int>(count);
}

bool has_ending(const fs::path& name, const std::string& ending) {
  std::string text = name.filename().string();
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text.ends_with(ending);
}

fs::path beside(const fs::path& header, const std::string& named) {
  std::string name = named;
  while (name.starts_with("./")) name.erase(0, 2);
  const bool plain = !name.empty() && name != "LIST" && name.find('%') == std::string::npos &&
                     fs::path(name).filename() == name && name != "." && name != "..";
  fs::path file = header.parent_path() / name;
  std::error_code ignored;
  if (!plain || !fs::is_regular_file(file, ignored)) throw DicomError(say("voxels-in-other-files"));
  return file;
}

void check_size(const VoxelFile& file) {
  const auto voxels = static_cast<std::uint64_t>(file.numbers_of_slice()) * static_cast<std::uint64_t>(file.size.z) *
                      static_cast<std::uint64_t>(file.volumes);
  const std::uint64_t needed = voxels * bytes_of(file.number);
  std::error_code ignored;
  const std::uint64_t present = fs::file_size(file.voxels_at, ignored);
  using Packing = VoxelFile::Packing;
  const bool in_words = file.packing == Packing::ascii || file.packing == Packing::hex;
  if (file.packing != Packing::none && !in_words) {
    internal::check_inflation(needed, present);
    return;
  }
  // A number in text form has at least a digit and a separator, except the last one.
  const std::uint64_t least = file.packing == Packing::ascii ? 2 * voxels - 1 : in_words ? 2 * needed : needed;
  if (present < least + static_cast<std::uint64_t>(file.first)) throw DicomError(say("voxels-end-early"));
}

void place(const VoxelMap& map, const glm::ivec3& size, VoxelFile& file) {
  const auto axes = axes_of(map.along);
  if (size.x < 1 || size.y < 1 || size.z < 1 || !spans_a_volume(map) || !axes) {
    throw DicomError(say("voxels-on-no-lattice"));
  }
  if (static_cast<double>(size.x) * size.y > most_of_a_slice ||
      static_cast<double>(size.x) * size.y * size.z > most_voxels) {
    throw DicomError(say("voxels-on-too-fine-a-lattice", size.x, size.y, size.z));
  }
  double reach = glm::length(map.first), finest = internal::farthest_place_mm;
  for (int axis = 0; axis < 3; ++axis) {
    const double spacing = glm::length(map.along[static_cast<std::size_t>(axis)]);
    reach += size[axis] * spacing;
    finest = std::min(finest, spacing);
  }
  if (reach > internal::farthest_place_mm || finest < internal::least_spacing_mm)
    throw DicomError(say("voxels-beyond-any-patient"));
  file.size = size;
  file.axes = *axes;
  const auto along = [&](std::size_t axis) { return map.along[static_cast<std::size_t>((*axes)[axis])]; };
  const Vec3 along_i = along(0), along_j = along(1), along_k = along(2);
  Geometry& geometry = file.geometry;
  geometry.dimensions = {size[(*axes)[0]], size[(*axes)[1]], size[(*axes)[2]]};
  geometry.spacing_i = glm::length(along_i);
  geometry.spacing_j = glm::length(along_j);
  geometry.direction_i = along_i / geometry.spacing_i;
  geometry.direction_j = along_j / geometry.spacing_j;
  file.reversed = glm::dot(glm::cross(along_i, along_j), along_k) < 0;
  geometry.step = file.reversed ? -along_k : along_k;
  const int slices = geometry.dimensions.z;
  const Vec3 lowest = file.reversed ? map.first + (slices - 1.0) * along_k : map.first;
  geometry.slice_positions.clear();
  for (int n = 0; n < slices; ++n) geometry.slice_positions.push_back(lowest + static_cast<double>(n) * geometry.step);
  geometry.uniform = true;
}

std::optional<VoxelFile> open_voxel_file(const fs::path& path, const fs::path& named) {
  for (const LabelFormat* const format : label_formats()) {
    if (auto file = format->open(path, named)) return file;
  }
  return std::nullopt;
}

// The list of formats comes from io/CMakeLists.txt: FORMAT(nifti) FORMAT(nrrd) ...
#define FORMAT(name) extern const LabelFormat name##_format;
PALPATE_LABEL_FORMATS
#undef FORMAT

std::span<const LabelFormat* const> label_formats() {
#define FORMAT(name) &name##_format,
  static constexpr std::array formats{PALPATE_LABEL_FORMATS};
#undef FORMAT
  return formats;
}

namespace {

template <typename Endings>
std::vector<std::string> endings_in(Endings LabelFormat::*of) {
  std::vector<std::string> all;
  for (const LabelFormat* const format : label_formats()) {
    for (const std::string_view ending : format->*of) {
      if (!ending.empty()) all.emplace_back(ending);
    }
  }
  return all;
}

}  // namespace

std::vector<std::string> label_format_endings() {
  return endings_in(&LabelFormat::endings);
}

std::vector<std::string> written_endings() {
  return endings_in(&LabelFormat::written);
}

std::string written_endings_in_words() {
  return fmt::format("{}", fmt::join(written_endings(), ", "));
}

void throw_no_known_ending(const fs::path& file) {
  throw DicomError(say("outline-of-no-known-ending", file.filename().string(), written_endings_in_words()));
}

std::optional<LabelWriter> writer_of(const fs::path& name) {
  LabelWriter best;
  for (const LabelFormat* const format : label_formats()) {
    for (const std::string_view ending : format->written) {
      if (ending.size() > best.ending.size() && has_ending(name, std::string(ending))) best = {format, ending};
    }
  }
  return best.format ? std::optional(best) : std::nullopt;
}

}  // namespace palpate::io
