#pragma once

/// How a scan's fields are interpolated between its voxels.

#include <cstddef>
#include <cstdint>
#include <limits>

namespace palpate::io {

/// The value between voxels.
enum class ValueMethod : std::uint8_t {
  cubic,     ///< smooth, from 64 voxels (cubic_spline.h): boundaries are at the right place; blurs by 0.58 voxels
  trilinear  ///< exact at the voxels' centers, from 8 voxels; makes round bodies too flat
};

/// The source of the gradient.
enum class GradientMethod : std::uint8_t {
  gaussian,             ///< derivative of Gaussian at a scale
  central_differences,  ///< sharper, noisier, without a scale
  cubic  ///< of the cubic value (cubic_spline.h), which is then used as the value, too, for any ValueMethod
};

/// Slices of a scan, both ends included; none if last < first.
struct SliceRange {
  int first = 0;
  int last = std::numeric_limits<int>::max();

  bool operator==(const SliceRange&) const = default;
};

struct FieldOptions {
  GradientMethod gradient = GradientMethod::gaussian;
  ValueMethod value = ValueMethod::cubic;
  std::size_t brick_bytes = std::size_t{64} << 20;  ///< bound on the memory for bricks; 0: no bricks
  bool background = true;                           ///< whether a worker fills bricks ahead
  SliceRange ahead = {};  ///< bricks hold only these slices; elsewhere each sample computes its own

  bool operator==(const FieldOptions&) const = default;
};

}  // namespace palpate::io
