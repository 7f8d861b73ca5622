#pragma once

/// A grid of values in a file that is not DICOM: NIfTI-1 and NIfTI-2, NRRD, MetaImage. It may be a scan or a label map.

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/geometry.h"
#include "io/series.h"

namespace palpate::io {

struct LabelImage;

/// The name of a label, if the file gives one. Labels of a file with layers are numbered by label_number().
struct LabelName {
  std::string name;
  std::string color;  ///< "#rrggbb", or empty
};

struct VoxelFile {
  enum class Number : std::uint8_t { u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };
  enum class Packing : std::uint8_t {
    none,
    whole,      ///< the whole file is gzipped
    behind_it,  ///< everything after the header is packed (gzip or zlib)
    bzip2,      ///< everything after the header is packed by bzip2
    ascii,      ///< numbers as text
    hex         ///< each byte as two hexadecimal digits
  };
  /// The meaning of several numbers of one voxel.
  enum class Beside : std::uint8_t { labels, volumes, colors };

  std::filesystem::path path;       ///< where its bytes are
  std::filesystem::path voxels_at;  ///< the file with its voxels: the same, or one beside it
  Geometry geometry;
  Number number = Number::u8;
  bool swapped = false;             ///< its byte order is not this machine's
  double slope = 1, offset = 0;     ///< value = slope * stored + offset
  Packing packing = Packing::none;  ///< of the file at voxels_at
  std::int64_t first = 0;  ///< the first byte of the voxels; counted in the unpacked file if the whole file is packed
  int volumes = 1;         ///< frames: volumes of the same size, one after the other
  int layers = 1;          ///< numbers of a voxel, side by side
  Beside beside = Beside::labels;        ///< label maps on one grid; frames; or red, green, blue and perhaps alpha
  glm::ivec3 size{0};                    ///< voxels along the file's axes, the fastest one first
  std::array<int, 3> axes{0, 1, 2};      ///< the file's axes that are the geometry's i, j and k
  bool reversed = false;                 ///< the file's first slice (along axes[2]) is the geometry's last
  std::optional<Series::Window> window;  ///< the window that the file asks for
  bool said_to_be_labels = false;
  std::map<int, LabelName> names;
  std::vector<Text> remarks;  ///< what a user should know about it

  int frames() const noexcept { return beside == Beside::volumes ? layers : volumes; }

  std::size_t slice_size() const { return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y); }
  /// The count of numbers in a slice: more than its voxels if there are layers.
  std::size_t numbers_of_slice() const { return slice_size() * static_cast<std::size_t>(layers); }
};

/// A number that is unique among the labels of all layers. In the first layer it is the label's value.
constexpr int label_number(int layer, int value) noexcept {
  return layer * 65536 + value;
}

/// Bytes of a number.
std::size_t bytes_of(VoxelFile::Number number) noexcept;

/// Null if its name or its first bytes are not those of such a file. `named`: the name that the user knows, which may
/// not be `path`. Throws DicomError, with a reason that does not name the file, if it cannot be read.
std::optional<VoxelFile> open_voxel_file(const std::filesystem::path& path, const std::filesystem::path& named);

/// A format of scans and label maps: one file (interchange/<name>.cpp) and one name in io/CMakeLists.txt.
struct LabelFormat {
  std::string_view name;                      ///< for people
  std::array<std::string_view, 4> endings{};  ///< of its files' names; the rest is empty
  /// As open_voxel_file(). Null if the file has another format.
  std::optional<VoxelFile> (*open)(const std::filesystem::path& path, const std::filesystem::path& named) = nullptr;
  /// Endings of the files that are written for structures, the usual one first; the rest is empty. All are empty if
  /// `bytes` is null.
  std::array<std::string_view, 2> written{};
  /// The whole file with this ending, one of `written`. The image's slices are evenly spaced.
  std::string (*bytes)(const LabelImage& image, std::string_view ending) = nullptr;
};
/// All formats, in the order in which a file is tried.
std::span<const LabelFormat* const> label_formats();
/// Of all formats: ".nii", ".nii.gz", ...
std::vector<std::string> label_format_endings();
/// The endings of all formats that structures are written in.
std::vector<std::string> written_endings();
/// The same, separated by commas.
std::string written_endings_in_words();
/// Refuses a file whose ending is none of these.
[[noreturn]] void throw_no_known_ending(const std::filesystem::path& file);

struct LabelWriter {
  const LabelFormat* format = nullptr;
  std::string_view ending;
};
/// The format and ending for a file of that name; of two endings that fit, the longer one. Null if no format fits.
std::optional<LabelWriter> writer_of(const std::filesystem::path& name);

/// An affine map from voxels along the file's axes to LPS, mm.
struct VoxelMap {
  std::array<Vec3, 3> along{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};  ///< from one voxel to the next
  Vec3 first{0};                                                           ///< center of the first voxel
};

/// Gives the file its geometry. Two axes at right angles become i and j. The third may be oblique: then the slices are
/// sheared. They ascend along i x j. Throws DicomError if no two axes are at right angles, or a size is impossible.
void place(const VoxelMap& map, const glm::ivec3& size, VoxelFile& file);

/// Records that each voxel has this many numbers: red, green, blue and perhaps alpha. Throws DicomError unless these
/// are 3 or 4 numbers of 8 or 16 bits.
void read_as_colors(double numbers, VoxelFile& file);
/// Throws DicomError if it is not a valid count.
int count_of_volumes(double count);

/// Whether a file name has this ending. Case does not matter.
bool has_ending(const std::filesystem::path& name, const std::string& ending);
/// The file of voxels that a header names. Throws DicomError if it does not lie beside the header.
std::filesystem::path beside(const std::filesystem::path& header, const std::string& name);
/// Throws DicomError if the file is too short for its voxels, or would be too large when unpacked.
void check_size(const VoxelFile& file);

}  // namespace palpate::io
