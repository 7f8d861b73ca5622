#pragma once

/// What one file's header says, as far as grouping, placing and decoding its images needs it.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "palpate/io/geometry.h"
#include "palpate/io/series.h"

namespace palpate::io::internal {

/// Where one image lies in the patient (ImagePositionPatient, ImageOrientationPatient, PixelSpacing).
struct Placement {
  Vec3 position{0};           ///< mm, centre of the first pixel
  Vec3 direction_i{1, 0, 0};  ///< unit, along a row
  Vec3 direction_j{0, 1, 0};  ///< unit, along a column
  double spacing_i = 1;       ///< mm between columns
  double spacing_j = 1;       ///< mm between rows
};

/// From the attributes' values (3, 6 and 2 of them, in DICOM's order); nothing where they are no placement.
std::optional<Placement> make_placement(const std::vector<double>& position, const std::vector<double>& orientation,
                                        const std::vector<double>& spacing);

/// One image: a file, or a frame of a multi-frame file, or a tile of a mosaic.
struct Plane {
  std::uint32_t frame = 0;  ///< in the file's pixel data, from 0
  std::uint32_t tile = 0;   ///< in the mosaic, from 0
  std::optional<Placement> placement;
  double slope = 1;  ///< RescaleSlope
  double intercept = 0;
};

struct PixelFormat {
  int columns = 0;  ///< of one image as stored (a whole mosaic)
  int rows = 0;
  int bits_allocated = 16;
  int bits_stored = 16;
  int high_bit = 15;
  bool is_signed = false;

  bool operator==(const PixelFormat&) const = default;
  std::size_t bytes_per_frame() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
           static_cast<std::size_t>(bits_allocated / 8);
  }
};

struct FileHeader {
  std::filesystem::path path;
  std::string transfer_syntax;  ///< UID
  std::string sop_class;        ///< UID
  std::string sop_instance;     ///< UID
  std::string series;           ///< UID
  std::string study;            ///< UID
  std::string modality;
  std::string description;
  std::string image_type;  ///< all its values, separated by backslashes
  std::string unit;
  Series::Identity identity;
  double instance_number = 0;
  double thickness = 0;  ///< SliceThickness, mm; 0 where unknown

  PixelFormat format;
  std::optional<std::pair<double, double>> padding;  ///< stored values, both ends included
  std::uint64_t pixels_at = 0;                       ///< where the pixel data's value starts in the file
  std::vector<Plane> planes;

  std::string unfit;   ///< why its images cannot be part of a volume (colour, no position); empty where they can
  std::string defect;  ///< why its pixels cannot be read (truncated); empty where they can
};

/// Reads a file up to its pixel data. Throws DicomError with a reason (that does not name the file) where it holds no
/// image.
FileHeader read_file_header(const std::filesystem::path& path);

}  // namespace palpate::io::internal
