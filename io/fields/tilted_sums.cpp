#include "io/fields/tilted_sums.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "io/fields/passes.h"
#include "io/fields/straight_sums.h"
#include "io/for_processor.h"

// Offsets within a tile, far below what an int holds.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
namespace palpate::io::internal {
namespace {

// A sum starts at 0, as in moments.h: so no sum is a negative zero.
template <int Count, bool First>
[[gnu::always_inline]] inline void add_row_taps(const float* __restrict in, const Tap* __restrict taps, int width,
                                                float* __restrict sums) {
  std::array<const float*, Count> at;  // of no taps at all, too
  std::array<float, Count> w0, w1;
  for (int n = 0; n < Count; ++n) {
    at[n] = in + taps[n].offset;
    w0[n] = taps[n].weight[0];
    w1[n] = taps[n].weight[1];
  }
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    float one = First ? 0 : sums[i];
    float p = First ? 0 : sums[i + tile_width];
    for (int n = 0; n < Count; ++n) {
      one += w0[n] * at[n][i];
      p += w1[n] * at[n][i];
    }
    sums[i] = one;
    sums[i + tile_width] = p;
  }
}

template <int Count, bool First>
[[gnu::always_inline]] inline void add_column_taps(const float* __restrict rows, const Tap* __restrict taps, int width,
                                                   float* __restrict sums) {
  std::array<const float*, Count> at;  // of no taps at all, too
  std::array<float, Count> w0, w1;
  for (int n = 0; n < Count; ++n) {
    at[n] = rows + taps[n].offset * (2 * tile_width);
    w0[n] = taps[n].weight[0];
    w1[n] = taps[n].weight[1];
  }
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    float one = First ? 0 : sums[i];
    float p = First ? 0 : sums[i + tile_width];
    float q = First ? 0 : sums[i + 2 * tile_width];
    for (int n = 0; n < Count; ++n) {
      one += w0[n] * at[n][i];
      p += w0[n] * at[n][i + tile_width];
      q += w1[n] * at[n][i];
    }
    sums[i] = one;
    sums[i + tile_width] = p;
    sums[i + 2 * tile_width] = q;
  }
}

}  // namespace

PALPATE_FOR_PROCESSOR
void sum_tilted_row(const float* in, const Taps& taps, int width, float* sums) {
  const Tap* const first = taps.data();
  in_passes(
      static_cast<int>(taps.size()), [=]<int Count, bool First>(int done) __attribute__((always_inline)) {
        add_row_taps<Count, First>(in, first + done, width, sums);
      });
}

PALPATE_FOR_PROCESSOR
void sum_tilted_column(const float* rows, const Taps& taps, int width, float* sums) {
  const Tap* const first = taps.data();
  in_passes(
      static_cast<int>(taps.size()), [=]<int Count, bool First>(int done) __attribute__((always_inline)) {
        add_column_taps<Count, First>(rows, first + done, width, sums);
      });
}

PALPATE_FOR_PROCESSOR
void add_tilted(const float* plane, const Contribution& slice, int width, float* sums) {
  const float w = slice.weight, x = slice.offset[0], y = slice.offset[1], z = slice.offset[2];
  const float* __restrict const in = plane;
  float* __restrict const out = sums;
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    const float one = in[i];
    const float p = in[i + tile_width] + x * one;
    const float q = in[i + 2 * tile_width] + y * one;
    out[i] += w * one;
    out[i + tile_width] += w * p;
    out[i + 2 * tile_width] += w * q;
    out[i + 3 * tile_width] += w * (z * one);
  }
}

PALPATE_FOR_PROCESSOR
void fit_sums(const float* sums, const float* fits, int begin, int end, glm::vec3* gradients) {
  const float* __restrict const s = sums;
  const float* __restrict const m = fits;
  float* __restrict const out = &gradients->x;
  PALPATE_INDEPENDENT
  for (int i = begin; i < end; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const float* const f = m + axis * tile_width + i;
      out[3 * i + axis] = ((f[0] * s[i + tile_width] + f[3 * tile_width] * s[i + 2 * tile_width]) +
                           (f[6 * tile_width] * s[i + 3 * tile_width] + f[9 * tile_width] * s[i])) +
                          0.0F;
    }
  }
}

}  // namespace palpate::io::internal

// NOLINTEND(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
