#pragma once

/// The first-order sums of moments.h for large blocks of a scan with straight slices: plain loops along a row, which
/// the compiler vectorizes for any processor. Each voxel's sum is taken in the order of moments.h, so it has the same
/// bits.

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palpate::io::internal {

/// The largest width of a tile, voxels, and the distance between the sums of one voxel, floats. It is a constant so
/// that every sum in a loop is at a constant distance from one pointer.
inline constexpr int tile_width = 256;

/// Weights at one distance from the middle on both sides; entry n of an array (from 0) is at a distance of n + 1
/// voxels.
struct TapPair {
  float even = 0;  ///< times the sum of the two
  float odd = 0;   ///< times their difference
};

/// One row of a tile: `in` points at the first voxel's value, with valid values before and after as far as the taps
/// reach. Writes rows one, p.
void sum_row(const float* in, float middle, const TapPair* pairs, int count, int width, float* sums);

/// Three sums in a plane (rows one, p, q) from consecutive rows of sums; `rows` points at the row in the middle.
void sum_column(const float* rows, float middle, const TapPair* pairs, int count, int width, float* sums);

/// The rows of each voxel's fit: slope (by sum, then by axis), constant (by axis), in PlaneFit's order.
inline constexpr int fit_rows = 12;

/// One slice, or two slices at the same distance on both sides, whose values are added to a sum.
struct SlicePair {
  const float* below = nullptr;  ///< rows one, p, q
  const float* above = nullptr;  ///< null if there is only one slice
  float weight = 0;
  float weight_w = 0;  ///< times the offset along the normal
};
/// Gradients of a row of voxels from slices at any distances, each voxel with its own fit. The first pair is a single
/// slice. The row starts `row` floats after the pairs' pointers. `sums`: scratch of 4 rows.
void fit_any_slices(const SlicePair* pairs, int pair_count, std::ptrdiff_t row, const float* fits, int width,
                    float* sums, glm::vec3* gradients);

/// How many slices are summed together, so that their shared input stays in the nearest cache.
inline constexpr int slices_at_once = 4;
/// The largest number of pairs of even slices.
inline constexpr int most_even_pairs = 8;
/// A slice with pairs of slices around it at even distances.
struct EvenSlices {
  const float* const* slices = nullptr;  ///< rows one, p, q: those of the slice at index 0, its neighbors' around it
  std::ptrdiff_t row = 0;                ///< floats from these pointers to the current row
  float middle = 0;                      ///< weight, and weight times offset
  float middle_w = 0;
  const TapPair* pairs = nullptr;
  int count = 0;
};
/// Gradients of a row of voxels with balanced neighborhoods (PlaneFit::constant is 0), and of the same row in the
/// `slices` - 1 slices above (1 or slices_at_once slices in all); the slices' outputs are `apart` gradients apart.
void fit_balanced_slices(const EvenSlices& even, int slices, const glm::mat3& slope, int width, glm::vec3* gradients,
                         std::ptrdiff_t apart);
/// Gradients of the voxels from `begin` to `end` of a row, each with its own fit.
void fit_even_slices(const EvenSlices& even, const float* fits, int begin, int end, glm::vec3* gradients);

}  // namespace palpate::io::internal
