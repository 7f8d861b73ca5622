#include "io/fields/straight_sums.h"

#include <algorithm>

#include "io/fields/passes.h"
#include "io/for_processor.h"

// Offsets within a tile, far below what an int holds.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
namespace palpate::io::internal {
namespace {

template <int Count, bool First>
[[gnu::always_inline]] inline void add_row_pairs(const float* __restrict in, float middle,
                                                 const TapPair* __restrict pairs, int done, int width,
                                                 float* __restrict sums) {
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    float even = First ? middle * in[i] : sums[i];
    float odd = First ? 0 : sums[i + tile_width];
    for (int n = 0; n < Count; ++n) {
      const float right = in[i + (First ? 0 : done) + n + 1];
      const float left = in[i - (First ? 0 : done) - n - 1];
      even += pairs[n].even * (right + left);
      odd += pairs[n].odd * (right - left);
    }
    sums[i] = even;
    sums[i + tile_width] = odd;
  }
}

template <int Count, bool First>
[[gnu::always_inline]] inline void add_column_pairs(const float* __restrict rows, float middle,
                                                    const TapPair* __restrict pairs, int done, int width,
                                                    float* __restrict sums) {
  constexpr std::ptrdiff_t row = 2 * tile_width;
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    float s0 = First ? middle * rows[i] : sums[i];
    float s1 = First ? middle * rows[i + tile_width] : sums[i + tile_width];
    float s2 = First ? 0 : sums[i + 2 * tile_width];
    for (int n = 0; n < Count; ++n) {
      const float* const right = rows + ((First ? 0 : done) + n + 1) * row;
      const float* const left = rows - ((First ? 0 : done) + n + 1) * row;
      s0 += pairs[n].even * (right[i] + left[i]);
      s1 += pairs[n].even * (right[i + tile_width] + left[i + tile_width]);
      s2 += pairs[n].odd * (right[i] - left[i]);
    }
    sums[i] = s0;
    sums[i + tile_width] = s1;
    sums[i + 2 * tile_width] = s2;
  }
}

template <int Count, int Slices>
[[gnu::always_inline]] inline void fit_balanced(const EvenSlices& even, const glm::mat3& slope, int width,
                                                glm::vec3* gradients, std::ptrdiff_t apart) {
  const float* at[2 * Count + Slices];
  for (int n = 0; n < 2 * Count + Slices; ++n) at[n] = even.slices[n - Count] + even.row;
  float m[9];
  for (int n = 0; n < 9; ++n) m[n] = slope[n / 3][n % 3];
  const TapPair* __restrict const pairs = even.pairs;
  const float middle = even.middle;
  const float middle_w = even.middle_w;
  for (int k = 0; k < Slices; ++k) {
    float* __restrict const out = &(gradients + k * apart)->x;
    PALPATE_INDEPENDENT
    for (int i = 0; i < width; ++i) {
      float p = middle * at[k + Count][i + tile_width];
      float q = middle * at[k + Count][i + 2 * tile_width];
      float w = middle_w * at[k + Count][i];
      for (int n = 0; n < Count; ++n) {
        const float* const a = at[k + Count + n + 1];
        const float* const b = at[k + Count - n - 1];
        p += pairs[n].even * (a[i + tile_width] + b[i + tile_width]);
        q += pairs[n].even * (a[i + 2 * tile_width] + b[i + 2 * tile_width]);
        w += pairs[n].odd * (a[i] - b[i]);
      }
      for (int axis = 0; axis < 3; ++axis) {
        out[3 * i + axis] = ((m[axis] * p + m[3 + axis] * q) + m[6 + axis] * w) + 0.0F;
      }
    }
  }
}

/// gradient_of() with the fit of voxel i.
[[gnu::always_inline]] inline void fit_voxel(const float* fits, int i, float one, float p, float q, float w,
                                             float* gradient) {
  for (int axis = 0; axis < 3; ++axis) {
    const float* const m = fits + axis * tile_width + i;
    gradient[axis] = ((m[0] * p + m[3 * tile_width] * q) + (m[6 * tile_width] * w + m[9 * tile_width] * one)) + 0.0F;
  }
}

template <int Count>
[[gnu::always_inline]] inline void fit_even(const EvenSlices& even, const float* __restrict fits, int begin, int end,
                                            glm::vec3* gradients) {
  const float* at[2 * Count + 1];
  for (int n = 0; n < 2 * Count + 1; ++n) at[n] = even.slices[n - Count] + even.row;
  const TapPair* __restrict const pairs = even.pairs;
  float* __restrict const out = &gradients->x;
  PALPATE_INDEPENDENT
  for (int i = begin; i < end; ++i) {
    float one = even.middle * at[Count][i];
    float p = even.middle * at[Count][i + tile_width];
    float q = even.middle * at[Count][i + 2 * tile_width];
    float w = even.middle_w * at[Count][i];
    for (int n = 0; n < Count; ++n) {
      const float* const a = at[Count + n + 1];
      const float* const b = at[Count - n - 1];
      one += pairs[n].even * (a[i] + b[i]);
      p += pairs[n].even * (a[i + tile_width] + b[i + tile_width]);
      q += pairs[n].even * (a[i + 2 * tile_width] + b[i + 2 * tile_width]);
      w += pairs[n].odd * (a[i] - b[i]);
    }
    fit_voxel(fits, i, one, p, q, w, out + 3 * i);
  }
}

template <bool Pair>
[[gnu::always_inline]] inline void add_slices(const SlicePair& slices, std::ptrdiff_t row, int width,
                                              float* __restrict sums) {
  const float* __restrict const b = slices.below + row;
  const float* __restrict const a = Pair ? slices.above + row : b;
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    for (int n = 0; n < 3; ++n) {
      const int at = i + n * tile_width;
      sums[at] += slices.weight * (Pair ? a[at] + b[at] : b[at]);
    }
    sums[i + 3 * tile_width] += slices.weight_w * (Pair ? a[i] - b[i] : b[i]);
  }
}

}  // namespace

PALPATE_FOR_PROCESSOR
void sum_row(const float* in, float middle, const TapPair* pairs, int count, int width, float* sums) {
  in_passes(
      count, [=]<int Count, bool First>(int done) __attribute__((always_inline)) {
        add_row_pairs<Count, First>(in, middle, pairs + done, done, width, sums);
      });
}

PALPATE_FOR_PROCESSOR
void sum_column(const float* rows, float middle, const TapPair* pairs, int count, int width, float* sums) {
  in_passes(
      count, [=]<int Count, bool First>(int done) __attribute__((always_inline)) {
        add_column_pairs<Count, First>(rows, middle, pairs + done, done, width, sums);
      });
}

PALPATE_FOR_PROCESSOR
void fit_any_slices(const SlicePair* pairs, int pair_count, std::ptrdiff_t row, const float* fits, int width,
                    float* sums, glm::vec3* gradients) {
  std::fill(sums, sums + 4 * tile_width, 0.0F);
  for (int c = 0; c < pair_count; ++c) {
    if (pairs[c].above == nullptr) {
      add_slices<false>(pairs[c], row, width, sums);
    } else {
      add_slices<true>(pairs[c], row, width, sums);
    }
  }
  const float* __restrict const s = sums;
  float* __restrict const out = &gradients->x;
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    fit_voxel(fits, i, s[i], s[i + tile_width], s[i + 2 * tile_width], s[i + 3 * tile_width], out + 3 * i);
  }
}

PALPATE_FOR_PROCESSOR
void fit_balanced_slices(const EvenSlices& even, int slices, const glm::mat3& slope, int width, glm::vec3* gradients,
                         std::ptrdiff_t apart) {
  with_count(
      even.count, [&]<int Count>() __attribute__((always_inline)) {
        slices == slices_at_once ? fit_balanced<Count, slices_at_once>(even, slope, width, gradients, apart)
                                 : fit_balanced<Count, 1>(even, slope, width, gradients, apart);
      });
}

PALPATE_FOR_PROCESSOR
void fit_even_slices(const EvenSlices& even, const float* fits, int begin, int end, glm::vec3* gradients) {
  static_assert(most_even_pairs <= most_at_once);
  with_count(
      even.count, [&]<int Count>()
                      __attribute__((always_inline)) { fit_even<Count>(even, fits, begin, end, gradients); });
}

}  // namespace palpate::io::internal

// NOLINTEND(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
