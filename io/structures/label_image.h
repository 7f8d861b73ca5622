#pragma once

/// A lattice of labels in a file that is no DICOM: NIfTI-1 (.nii, .nii.gz) or NRRD (.nrrd, .seg.nrrd).

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "io/geometry.h"

namespace palpate::io {

/// What a label is called, where the file says it.
struct LabelName {
  std::string name;
  std::string color;  ///< "#rrggbb", or empty
};

struct LabelImage {
  enum class Number : std::uint8_t { u8, i8, u16, i16, u32, i32, f32, f64 };

  std::filesystem::path path;
  Geometry geometry;
  Number number = Number::u8;
  bool swapped = false;  ///< its bytes are in the other order than this machine's
  double slope = 1, offset = 0;
  std::int64_t first = 0;     ///< of the first voxel: a byte of the file, or of what it holds where that is compressed
  bool packed_after = false;  ///< what is compressed begins at `first`, after a header that is not
  bool reversed = false;      ///< the file's first slice is the geometry's last
  bool said_to_be_labels = false;
  std::map<int, LabelName> names;
};

/// Null where it is no such file by its name and first bytes. Throws DicomError, with a reason that does not name the
/// file, for one that cannot be read.
std::optional<LabelImage> open_nifti(const std::filesystem::path& path);
std::optional<LabelImage> open_nrrd(const std::filesystem::path& path);

/// Slice by slice in the file's order: `k` is the geometry's slice; values as they are. Ends early where `slice` gives
/// false. Throws DicomError where the file ends before its voxels do.
void read_slices(const LabelImage& image, const std::function<bool(int k, std::span<const double> values)>& slice);

/// From the columns of an affine map from voxels to LPS, mm: the slices ascend along i x j. Throws DicomError where
/// they are no lattice.
void place(const Vec3& along_i, const Vec3& along_j, const Vec3& along_k, const Vec3& first, const glm::ivec3& size,
           LabelImage& image);

}  // namespace palpate::io
