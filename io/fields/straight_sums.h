#pragma once

/// The sums of moments.h of first order, for large blocks of a scan whose slices lie straight above each other: plain
/// loops along a row, which the compiler turns into whatever vectors the processor has. Each voxel's sum is taken in
/// the order of moments.h, so it has the same bits.

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palpate::io::internal {

/// Rows are summed a tile at a time, no wider than this many voxels. Sums of one voxel lie this many floats apart: as
/// the compiler knows it, every sum that a loop reads is at a constant distance from one pointer.
inline constexpr int tile_width = 256;

/// Weights at one distance from the middle on both sides; the n-th of an array (from 0) is at n + 1 voxels.
struct TapPair {
  float even = 0;  ///< times the sum of the two
  float odd = 0;   ///< times their difference
};

/// One row of a tile: `in` points at the first voxel's value, with the taps' reach before and after it. Writes rows
/// one, p.
void sum_row(const float* in, float middle, const TapPair* pairs, int count, int width, float* sums);

/// Three sums in a plane (rows one, p, q) from rows of sums that lie one after another; `rows` points at the row in
/// the middle.
void sum_column(const float* rows, float middle, const TapPair* pairs, int count, int width, float* sums);

/// Each voxel's fit: rows slope (by sum, then by axis), constant (by axis), in PlaneFit's order.
inline constexpr int fit_rows = 12;

/// One slice, or two slices at the same distance on both sides, whose values are added to a sum.
struct SlicePair {
  const float* below = nullptr;  ///< rows one, p, q
  const float* above = nullptr;  ///< null if there is but one slice
  float weight = 0;
  float weight_w = 0;  ///< times the offset along the normal
};
/// Gradients of a row of voxels from any slices, each voxel by its own fit; the first pair is a single slice. A row
/// lies `row` floats after what the pairs point at. `sums`: scratch of 4 rows.
void fit_any_slices(const SlicePair* pairs, int pair_count, std::ptrdiff_t row, const float* fits, int width,
                    float* sums, glm::vec3* gradients);

/// The number of slices that are summed at once, so that shared data stays in the nearest cache.
inline constexpr int slices_at_once = 4;
/// Pairs of even slices at most.
inline constexpr int most_even_pairs = 8;
/// A slice with pairs of slices around it at even distances.
struct EvenSlices {
  const float* const* slices = nullptr;  ///< rows one, p, q: at 0 of the slice, around it of its neighbors
  std::ptrdiff_t row = 0;                ///< floats from there to the current row
  float middle = 0;                      ///< weight, and that times its offset
  float middle_w = 0;
  const TapPair* pairs = nullptr;
  int count = 0;
};
/// Gradients of a row of voxels, whose neighborhoods' weights are balanced (PlaneFit::constant is 0), and of the same
/// row of the `slices` - 1 slices above (1 or slices_at_once), which lie `apart` gradients apart.
void fit_balanced_slices(const EvenSlices& even, int slices, const glm::mat3& slope, int width, glm::vec3* gradients,
                         std::ptrdiff_t apart);
/// Gradients of the voxels from `begin` to `end` of a row, each by its own fit.
void fit_even_slices(const EvenSlices& even, const float* fits, int begin, int end, glm::vec3* gradients);

}  // namespace palpate::io::internal
