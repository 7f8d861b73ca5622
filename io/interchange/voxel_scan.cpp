#include "io/interchange/voxel_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <type_traits>

#include "io/dicom/grouping.h"
#include "io/dicom/series_source.h"
#include "io/dicom/slice_reader.h"
#include "io/errors.h"
#include "io/interchange/voxel_bytes.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

using Number = VoxelFile::Number;

// FNV-1a, of the first bytes of header and voxels.
std::string uid_of(const VoxelFile& file) {
  std::uint64_t hash = 14695981039346656037U;
  for (const auto& path : {file.path, file.voxels_at}) {
    std::array<char, 1U << 16> bytes{};
    std::ifstream stream(path, std::ios::binary);
    stream.read(bytes.data(), bytes.size());
    for (std::streamsize n = 0; n < stream.gcount(); ++n) {
      hash = (hash ^ static_cast<unsigned char>(bytes[static_cast<std::size_t>(n)])) * 1099511628211U;
    }
  }
  return "2.25." + std::to_string(hash);  // PS3.5 B.2
}

/// Where a voxel of the file is among the volume's.
struct Strides {
  std::ptrdiff_t start = 0;
  std::array<std::ptrdiff_t, 3> along{};  ///< an axis of the file each

  explicit Strides(const VoxelFile& file) {
    const glm::ivec3& size = file.geometry.dimensions;
    const std::ptrdiff_t slice = std::ptrdiff_t{size.x} * size.y;
    const std::array<std::ptrdiff_t, 3> of_volume{1, size.x, file.reversed ? -slice : slice};
    for (std::size_t a = 0; a < 3; ++a) along[static_cast<std::size_t>(file.axes[a])] = of_volume[a];
    start = file.reversed ? slice * (size.z - 1) : 0;
  }
};

/// A voxel's luma: how bright a color is (ITU-R BT.601, as DICOM's Y; alpha counts for nothing). Of grays the gray.
double luma_at(Number number, const std::uint8_t* from) {
  const std::size_t next = bytes_of(number);
  return std::round(0.299 * number_at(number, from) + 0.587 * number_at(number, from + next) +
                    0.114 * number_at(number, from + 2 * next));
}

/// Unusual numbers that a reader finds.
struct Oddities {
  bool any_hole = false;     ///< what is no number
  bool any_rounded = false;  ///< integers of more digits than a float has
};

/// Puts slice `n` of the file to its places, which are counted from `begin` on. `beside`: which of a voxel's numbers.
template <typename Stored>
void put_slice(const VoxelFile& file, int n, int beside, std::span<const std::uint8_t> raw, std::ptrdiff_t begin,
               std::vector<Stored>& voxels, Oddities& odd) {
  const Strides strides(file);
  const std::size_t number = bytes_of(file.number), voxel = number * static_cast<std::size_t>(file.layers);
  const bool is_color = file.beside == VoxelFile::Beside::colors;
  constexpr double exact = 9007199254740992;  // 2^53: beyond, a double has not all digits either
  const bool is_integer = file.number != Number::f32 && file.number != Number::f64;
  const std::uint8_t* from = raw.data() + static_cast<std::size_t>(beside) * number;
  for (int j = 0; j < file.size.y; ++j) {
    std::ptrdiff_t at = strides.start + n * strides.along[2] + j * strides.along[1] - begin;
    for (int i = 0; i < file.size.x; ++i, from += voxel, at += strides.along[0]) {
      if (at < 0 || at >= static_cast<std::ptrdiff_t>(voxels.size())) continue;  // of a slice that was not asked for
      const double stored = is_color ? luma_at(file.number, from) : number_at(file.number, from);
      if constexpr (std::is_same_v<Stored, float>) {
        const auto value = static_cast<float>(stored * file.slope + file.offset);
        odd.any_hole |= !std::isfinite(value);
        odd.any_rounded |=
            is_integer && (static_cast<double>(static_cast<float>(stored)) != stored || std::abs(stored) >= exact);
        voxels[static_cast<std::size_t>(at)] = std::isfinite(value) ? value : internal::float_padding;
      } else {
        voxels[static_cast<std::size_t>(at)] = static_cast<Stored>(stored);
      }
    }
  }
}

Volume::Voxels allocate(Number number, std::size_t count, const std::string& name) {
  const bool is_unsigned = number == Number::u8 || number == Number::u16;
  const bool is_short = is_unsigned || number == Number::i8 || number == Number::i16;
  try {
    if (is_unsigned) return std::vector<std::uint16_t>(count);
    if (is_short) return std::vector<std::int16_t>(count);
    return std::vector<float>(count);
  } catch (const std::bad_alloc&) {
    const std::size_t bytes = is_short ? sizeof(std::int16_t) : sizeof(float);
    throw DicomError(say("needs-more-memory-than-there", name, bytes * count >> 20));
  }
}

/// Slices of the geometry.
LoadOptions::Range checked_range(const VoxelFile& file, const std::string& name, const LoadOptions& options) {
  if (options.frame < 0 || options.frame >= file.frames()) {
    throw DicomError(say("no-such-frame", name, file.frames() - 1, options.frame));
  }
  const int all = file.geometry.dimensions.z;
  const LoadOptions::Range range = options.slices.value_or(LoadOptions::Range{0, all});
  if (range.first < 0 || range.count < 1 || range.count > all - range.first) {
    throw DicomError(say("no-such-slice", name, all - 1, range.count, range.first));
  }
  return range;
}

Geometry part_of(Geometry whole, const LoadOptions::Range& range) {
  const auto begin = whole.slice_positions.begin() + range.first;
  whole.slice_positions = std::vector<Vec3>(begin, begin + range.count);
  whole.dimensions.z = range.count;
  return whole;
}

/// The file's slices that hold the range: those alone where slices are the geometry's, else all.
std::pair<int, int> slices_to_read(const VoxelFile& file, const LoadOptions::Range& range) {
  if (file.axes[2] != 2) return {0, file.size.z};
  const int begin = file.reversed ? file.size.z - range.first - range.count : range.first;
  return {begin, begin + range.count};
}

}  // namespace

Series series_of(VoxelFile file, const std::filesystem::path& path, std::shared_ptr<const void> keeper) {
  if (file.layers > 1 && file.beside == VoxelFile::Beside::labels) {
    throw DicomError(say("voxels-have-several-values", file.layers));
  }
  Series series;
  series.uid = uid_of(file);
  series.modality = "OT";  // DICOM's word for what is not said
  series.description = path.filename().string();
  series.files = {path};
  series.geometry = file.geometry;
  series.details.orientation = internal::orientation_of(file.geometry);
  series.frames_per_position = file.frames();
  series.frame_names.resize(static_cast<std::size_t>(file.frames()));
  series.window = file.window;
  series.usable = file.geometry.dimensions.z > 1;
  if (!series.usable) series.warnings.push_back(say("one-slice-alone-is-no-volume"));
  series.warnings.push_back(say("file-names-no-modality"));
  series.warnings.insert(series.warnings.end(), file.remarks.begin(), file.remarks.end());
  auto source = std::make_shared<SeriesSource>();
  source->keeper = std::move(keeper);
  source->voxel_file = std::make_shared<const VoxelFile>(std::move(file));
  series.source = std::move(source);
  return series;
}

Volume load_voxels(const VoxelFile& file, const std::string& name, const LoadOptions& options) {
  const LoadOptions::Range range = checked_range(file, name, options);
  Volume volume;
  volume.modality = "OT";
  volume.geometry = part_of(file.geometry, range);
  const std::ptrdiff_t slice = std::ptrdiff_t{volume.geometry.dimensions.x} * volume.geometry.dimensions.y;
  volume.voxels = allocate(file.number, static_cast<std::size_t>(slice * range.count), name);
  const auto [begin, end] = slices_to_read(file, range);
  const bool is_beside = file.beside == VoxelFile::Beside::volumes;
  const int at = is_beside ? 0 : options.frame, beside = is_beside ? options.frame : 0;
  Oddities odd;
  try {
    read_raw_slices(file, at, begin, end, [&, first = begin, last = end](int n, auto raw) {
      std::visit([&](auto& voxels) { put_slice(file, n, beside, raw, slice * range.first, voxels, odd); },
                 volume.voxels);
      if (options.progress && !options.progress(static_cast<double>(n + 1 - first) / (last - first))) throw Cancelled();
      return true;
    });
  } catch (const DicomError& error) {
    throw DicomError(say("series-cannot-be-read", name, error.text()));
  }
  if (std::holds_alternative<std::vector<float>>(volume.voxels)) {
    if (odd.any_rounded) volume.warnings.push_back(say("values-are-rounded"));
    if (odd.any_hole) volume.padding = {internal::float_padding, internal::float_padding};
  } else {
    volume.slope = file.slope;
    volume.intercept = file.offset;
  }
  return volume;
}

}  // namespace palpate::io
