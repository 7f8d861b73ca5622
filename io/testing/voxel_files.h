#pragma once

/// Scans in NIfTI and MetaImage, made byte by byte for the tests of their readers, and the right place of each voxel.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>

#include "io/geometry.h"
#include "io/volume.h"

namespace palpate::io::internal {

constexpr int nx = 4, ny = 3, nz = 5;  ///< voxels of each file along its own axes

/// The stored value at voxel (a, b, c) of the file. All differ, and some are below 0.
int stored(int a, int b, int c);

/// Voxels to RAS (NIfTI) or LPS (MetaImage), mm: three rows of four, as a NIfTI header holds its sform.
using Rows = std::array<std::array<double, 4>, 3>;
Vec3 place_of(const Rows& rows, int a, int b, int c);
const Vec3 ras_to_lps(-1, -1, 1);

/// Checks that every voxel of the file lies at its place (mm) with its value, for any order of the volume's axes.
void expect_all(const Volume& volume, const std::function<Vec3(int, int, int)>& lps,
                const std::function<double(int, int, int)>& value);

/// The only volume in the file. If there is none, a test failure and an empty volume.
Volume only_volume(const std::filesystem::path& file, int frame = 0);
/// Why a named file is not listed as a scan; "read" if it is.
std::string verdict_on(const std::string& name, const std::string& bytes);
/// The same, or why its voxels are not loaded; "loaded" if they are.
std::string verdict_on_voxels(const std::string& bytes, const std::string& name = "a.nrrd");
inline const std::string no_lattice =
    "its voxels are on no lattice that can be felt (no size, or axes that are sheared): resample it with axes at right "
    "angles";
/// Why a file of that name and content is refused.
std::string refusal_of(const std::string& name, const std::string& bytes);

template <typename Number>
std::string as_bytes(Number number, bool big = false) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  if (big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// All stored values in the order of the file, `volumes` times, each time 1000 higher.
template <typename Number>
std::string voxels(bool big = false, int volumes = 1) {
  std::string bytes;
  for (int v = 0; v < volumes; ++v) {
    for (int n = 0; n < nx * ny * nz; ++n) {
      const int value = stored(n % nx, n / nx % ny, n / (nx * ny));
      bytes += as_bytes(static_cast<Number>(value + 1000 * v), big);
    }
  }
  return bytes;
}

/// Compressed by zlib with these window bits: 15 writes zlib, 31 gzip.
std::string packed(std::string bytes, int window_bits);
/// 0, and 7 from the third slice on, as int16.
std::string labels();

/// A header of NIfTI-1 (nifti1.h), of int16 voxels.
class Nifti {
 public:
  explicit Nifti(bool big = false) : big_(big) {
    put<std::int32_t>(0, 348);
    const std::array<std::int16_t, 8> size{3, nx, ny, nz, 1, 1, 1, 1};
    for (std::size_t n = 0; n < 8; ++n) put(40 + 2 * n, size[n]);
    put<std::int16_t>(70, 4).put<std::int16_t>(72, 16).put<float>(108, 352).put<std::uint8_t>(123, 2);
    for (std::size_t n = 0; n < 4; ++n) put<float>(76 + 4 * n, 1);
    std::memcpy(bytes_.data() + 344, "n+1", 3);
  }
  template <typename T>
  Nifti& put(std::size_t at, T value) {
    std::ranges::copy(as_bytes(value, big_), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
    return *this;
  }
  Nifti& sform(const Rows& rows) {
    put<std::int16_t>(254, 1);
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t n = 0; n < 4; ++n) put(280 + 16 * row + 4 * n, static_cast<float>(rows[row][n]));
    }
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  bool big_;
  std::string bytes_ = std::string(352, '\0');
};

/// An orthogonal matrix with axes oblique to the patient; and the same with the first axis reversed: left-handed.
Rows oblique();
Rows flipped();

/// A MetaImage header of int16 voxels with further fields.
std::string meta_image(const std::string& fields);
/// A row of TransformMatrix is the direction of an axis of the file (itk::MetaImageIO), in LPS.
inline const std::string meta_place =
    "TransformMatrix = 0.6 0.8 0 -0.8 0.6 0 0 0 -1\nOffset = -12 5 90\nElementSpacing = 0.5 2 3\n";
const Rows meta_rows{{{0.3, -1.6, 0, -12}, {0.4, 1.2, 0, 5}, {0, 0, -3, 90}}};

}  // namespace palpate::io::internal
