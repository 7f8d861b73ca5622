#pragma once

/// The second-order sums of moments.h over weights, for stretches of rows: as straight_sums.h, with the same bits as
/// moments.h. Sums of one voxel are tile_width floats apart.

#include <cstddef>

#include "io/fields/slice_kernel.h"

namespace palpate::io::internal {

inline constexpr int row_sums = 3;            ///< 1, p, pp
inline constexpr int weight_plane_sums = 6;   ///< 1, p, q, pp, pq, qq
inline constexpr int weight_space_sums = 10;  ///< 1, p, q, w, pp, pq, qq, pw, qw, ww

/// `in` points at the value of the tile's first voxel, with valid values before and after as far as the taps reach.
/// Handles the voxels from `begin` to `end` of the row.
void weigh_row(const float* in, const Taps& taps, int begin, int end, float* sums);

/// From rows that are row_sums * tile_width floats apart; `rows` points at the row in the middle.
void weigh_column(const float* rows, const Taps& taps, int begin, int end, float* sums);

/// A slice, or two slices at the same distance on both sides.
struct WeightPair {
  const float* below = nullptr;  ///< rows of a plane's sums
  const float* above = nullptr;  ///< null if there is only one
  float weight = 0;
  float offset = 0;  ///< along the normal
};
void weigh_slices(const WeightPair* pairs, int count, int begin, int end, float* sums);

}  // namespace palpate::io::internal
