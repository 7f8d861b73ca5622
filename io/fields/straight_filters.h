#pragma once

/// The sums of moments.h of first order, for large blocks of a scan whose slices lie straight above each other: plain
/// loops along a row, which the compiler turns into whatever vectors the processor has. Each voxel's sum is taken in
/// the order of moments.h, so it has the same bits.

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palpate::io::internal {

/// Weights at one distance from the middle on both sides.
struct TapPair {
  int offset = 0;  ///< voxels
  float even = 0;  ///< times the sum of the two
  float odd = 0;   ///< times their difference
};

/// One row: `in` points at the first voxel's value, with the taps' reach before and after it.
void filter_row(const float* in, float middle, const TapPair* pairs, int count, int width, float* one, float* p);

/// Three sums in a plane from filtered rows (each `one` and then `p`, of `width`); `rows` points at the row in the
/// middle, rows lie `stride` floats apart.
void filter_column(const float* rows, std::ptrdiff_t stride, float middle, const TapPair* pairs, int count, int width,
                   float* one, float* p, float* q);

/// One slice, or two slices at the same distance on both sides, whose values are added to a sum.
struct SlicePair {
  const float* below = nullptr;  ///< planes one, p, q
  const float* above = nullptr;  ///< null where there is but one slice
  float weight = 0;
  float weight_w = 0;  ///< times the offset along the normal
};
/// Sums in space of `count` voxels: 1 (unless null), p, q, w. The first pair is a single slice. A slice's planes lie
/// `plane` floats apart. A row at a time, so that the sums stay in the nearest cache.
void sum_slices(const SlicePair* pairs, int pair_count, std::size_t plane, float* s0, float* p, float* q, float* w,
                std::size_t count);

/// Gradients of a row from its sums, of a neighborhood whose weights are balanced (PlaneFit::constant is 0).
void fit_balanced_row(const glm::mat3& slope, const float* p, const float* q, const float* w, int count,
                      glm::vec3* gradients);

/// Stored values as floats.
void to_floats(const std::int16_t* stored, int count, float* values);
void to_floats(const std::uint16_t* stored, int count, float* values);

}  // namespace palpate::io::internal
