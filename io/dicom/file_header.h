#pragma once

/// The attributes of one file that are needed to group, place and decode its images.

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/dicom/dataset.h"
#include "io/dicom/fragments.h"
#include "io/geometry.h"
#include "io/series.h"
#include "solver/text/message.h"

namespace palpate::io::internal {

/// The position of one image in the patient (ImagePositionPatient, ImageOrientationPatient, PixelSpacing).
struct Placement {
  Vec3 position{0};           ///< mm, center of the first pixel
  Vec3 direction_i{1, 0, 0};  ///< unit, along a row
  Vec3 direction_j{0, 1, 0};  ///< unit, along a column
  double spacing_i = 1;       ///< mm between columns
  double spacing_j = 1;       ///< mm between rows
};

/// From the values of these attributes (3, 6 and 2 of them, in DICOM's order); nothing if they are not valid.
std::optional<Placement> make_placement(const std::vector<double>& position, const std::vector<double>& orientation,
                                        const std::vector<double>& spacing);

/// Attributes that may distinguish images at one position, the most reliable first.
enum class Label {
  image_type,
  kernel,
  laterality,
  echo_time,
  b_value,
  diffusion_direction,
  velocity_encoding,
  time_point,
  trigger_time,
  acquisition
};
constexpr std::size_t label_count = 10;
/// One text for each label, numbers as text; empty if unknown.
using Labels = std::array<std::string, label_count>;

/// The velocity encoding of a phase-contrast image: the speed along a direction is slope * stored + intercept, m/s.
struct VelocityEncoding {
  Vec3 direction{0};  ///< unit, patient axes
  double slope = 0;
  double intercept = 0;
};

/// One image: a file, or a frame of a multi-frame file, or a tile of a mosaic.
struct Plane {
  std::uint32_t frame = 0;                      ///< in the file's pixel data, from 0
  std::uint32_t tile_column = 0, tile_row = 0;  ///< first pixel of the tile in the frame
  std::optional<Placement> placement;
  double slope = 1;  ///< RescaleSlope
  double intercept = 0;
  Labels labels;
  std::optional<Series::Window> window;
  std::optional<VelocityEncoding> velocity;
};

struct PixelFormat {
  int columns = 0;  ///< of a frame as stored (all of a mosaic)
  int rows = 0;
  int bits_allocated = 16;
  int bits_stored = 16;
  int high_bit = 15;
  bool is_signed = false;
  bool is_float = false;  ///< numbers of 32 or 64 bits, IEEE 754

  /// Whether stored values do not fit into 16 bits.
  bool is_wide() const { return is_float || bits_allocated > 16; }
  std::size_t bytes_per_frame() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
           static_cast<std::size_t>(bits_allocated / 8);
  }
};

enum class PixelCoding { native, deflated, encapsulated };

/// A modality look-up table (PS3.3 C.11.1): maps stored values to values. Stored values before its first or after its
/// last entry get that entry's value.
struct ModalityTable {
  double first = 0;  ///< the stored value of its first entry
  std::vector<float> values;

  double value_of(double stored) const {
    const double last = static_cast<double>(values.size() - 1);
    return static_cast<double>(values[static_cast<std::size_t>(std::clamp(stored - first, 0.0, last))]);
  }
};

struct FileHeader {
  std::filesystem::path
      path;  ///< as shown to the user; for a file in an archive file, the archive's path and the path inside
  std::filesystem::path stored_at;  ///< the file with its bytes
  /// Keeps that file in existence; null for a file of the user's.
  std::shared_ptr<const void> keeper;
  std::string transfer_syntax;     ///< UID
  std::string sop_class;           ///< UID
  std::string sop_instance;        ///< UID
  std::string series;              ///< UID
  std::string study;               ///< UID
  std::string frame_of_reference;  ///< UID; empty if missing
  std::string modality;
  std::string description;
  std::string image_type;  ///< all its values, separated by backslashes
  std::string unit;
  Series::Details details;
  Series::Identity identity;
  double instance_number = 0;
  std::string acquisition_time;  ///< date and time, for comparison only
  std::string content_time;      ///< as acquisition_time
  double thickness = 0;          ///< SliceThickness, mm; 0 if unknown

  PixelFormat format;
  int columns = 0;  ///< of one image (of a tile of a mosaic)
  int rows = 0;
  std::optional<std::pair<double, double>> padding;  ///< stored values, both ends included
  std::shared_ptr<const ModalityTable> table;        ///< replaces the rescale; null if there is none
  /// Whether the padding value does not fit into BitsStored and takes all of BitsAllocated.
  bool padding_is_wide() const;

  PixelCoding coding = PixelCoding::native;
  bool big_endian = false;
  bool swapped_words = false;   ///< 8-bit pixels in big-endian 16-bit words
  bool swapped_wholes = false;  ///< big-endian 32-bit integers that were swapped as a whole, not word by word
  DatasetStart start;           ///< where the dataset is
  std::uint64_t pixels_at = 0;  ///< the pixels' offset in the file, or in the inflated dataset
  std::vector<std::vector<Fragment>> fragments;  ///< of each frame, where encapsulated

  std::vector<Plane> planes;
  std::vector<Text> remarks;  ///< what a user should know of the series; all files of the series share this text
  Text unfit;                 ///< why its images cannot be part of a volume (color, no position); empty if they can
  Text defect;                ///< why its pixels cannot be read (truncated); empty if they can
};

/// The file's name without its folder, for messages.
std::string name_of(const FileHeader& file);

/// Reads a file up to its pixel data. Throws DicomError with a reason (that does not name the file) if it holds no
/// image.
FileHeader read_file_header(const std::filesystem::path& stored_at);

}  // namespace palpate::io::internal
