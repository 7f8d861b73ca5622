#pragma once

/// How the fields of a scan are made between its voxels.

#include <cstddef>
#include <cstdint>
#include <limits>

namespace palpate::io {

/// The value between voxels.
enum class ValueMethod : std::uint8_t {
  cubic,     ///< smooth, from 64 voxels (cubic_spline.h): a boundary is felt where it is; blurred by 0.58 voxels
  trilinear  ///< exact at the voxels' centers, from 8 voxels; makes round bodies too flat
};

/// Where the gradient comes from.
enum class GradientMethod : std::uint8_t {
  gaussian,             ///< derivative of Gaussian at a scale
  central_differences,  ///< sharper, noisier, without a scale
  cubic                 ///< of the cubic value (cubic_spline.h), which then is also the value, whatever ValueMethod is
};

/// Slices of a scan, both ends included; none where last < first.
struct SliceRange {
  int first = 0;
  int last = std::numeric_limits<int>::max();

  bool operator==(const SliceRange&) const = default;
};

struct FieldOptions {
  GradientMethod gradient = GradientMethod::gaussian;
  ValueMethod value = ValueMethod::cubic;
  std::size_t brick_bytes = std::size_t{64} << 20;  ///< bound on the memory for bricks; 0: none are kept
  bool background = true;                           ///< whether a worker fills bricks ahead
  SliceRange ahead = {};  ///< bricks hold these slices and no others: elsewhere each sample computes its own

  bool operator==(const FieldOptions&) const = default;
};

}  // namespace palpate::io
