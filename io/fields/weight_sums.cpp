#include "io/fields/weight_sums.h"

#include <algorithm>

#include "io/fields/straight_sums.h"
#include "io/for_processor.h"

// Offsets within a tile, far below what an int holds.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
namespace palpate::io::internal {
namespace {

/// Sums that are added to in turn stay in the nearest cache.
[[gnu::always_inline]] inline void clear(int count, int begin, int end, float* sums) {
  for (int n = 0; n < count; ++n) std::fill(sums + n * tile_width + begin, sums + n * tile_width + end, 0.0F);
}

[[gnu::always_inline]] inline void weigh_row_in(const float* __restrict in, const Taps& taps, int begin, int end,
                                                float* __restrict sums) {
  const float middle = taps[0].weight[0];
  PALPATE_INDEPENDENT
  for (int i = begin; i < end; ++i) {
    sums[i] = middle * in[i];
    sums[i + tile_width] = 0;
    sums[i + 2 * tile_width] = 0;
  }
  for (std::size_t t = 1; t + 1 < taps.size(); t += 2) {
    const float* __restrict const left = in + taps[t].offset;
    const float* __restrict const right = in + taps[t + 1].offset;
    const float w0 = taps[t + 1].weight[0], w1 = taps[t + 1].weight[1], w2 = taps[t + 1].weight[2];
    PALPATE_INDEPENDENT
    for (int i = begin; i < end; ++i) {
      sums[i] += w0 * (right[i] + left[i]);
      sums[i + tile_width] += w1 * (right[i] - left[i]);
      sums[i + 2 * tile_width] += w2 * (right[i] + left[i]);
    }
  }
}

[[gnu::always_inline]] inline void weigh_column_in(const float* __restrict rows, const Taps& taps, int begin, int end,
                                                   float* __restrict sums) {
  const float middle = taps[0].weight[0];
  clear(weight_plane_sums, begin, end, sums);
  PALPATE_INDEPENDENT
  for (int i = begin; i < end; ++i) {
    sums[i] += middle * rows[i];
    sums[i + tile_width] += middle * rows[i + tile_width];
    sums[i + 3 * tile_width] += middle * rows[i + 2 * tile_width];
  }
  for (std::size_t t = 1; t + 1 < taps.size(); t += 2) {
    const float* __restrict const left = rows + taps[t].offset * (row_sums * tile_width);
    const float* __restrict const right = rows + taps[t + 1].offset * (row_sums * tile_width);
    const float w0 = taps[t + 1].weight[0], w1 = taps[t + 1].weight[1], w2 = taps[t + 1].weight[2];
    PALPATE_INDEPENDENT
    for (int i = begin; i < end; ++i) {
      const float even = right[i] + left[i];
      sums[i] += w0 * even;
      sums[i + tile_width] += w0 * (right[i + tile_width] + left[i + tile_width]);
      sums[i + 2 * tile_width] += w1 * (right[i] - left[i]);
      sums[i + 3 * tile_width] += w0 * (right[i + 2 * tile_width] + left[i + 2 * tile_width]);
      sums[i + 4 * tile_width] += w1 * (right[i + tile_width] - left[i + tile_width]);
      sums[i + 5 * tile_width] += w2 * even;
    }
  }
}

template <bool Pair>
[[gnu::always_inline]] inline void add_slices(const WeightPair& pair, int begin, int end, float* __restrict sums) {
  const float* __restrict const b = pair.below;
  const float* __restrict const a = Pair ? pair.above : b;
  const float w = pair.weight;
  const float wz = w * pair.offset;
  const float wzz = wz * pair.offset;
  PALPATE_INDEPENDENT
  for (int i = begin; i < end; ++i) {
    const float one = Pair ? a[i] + b[i] : b[i];
    sums[i] += w * one;
    for (int n = 1; n < 3; ++n) {
      const int at = i + n * tile_width;
      sums[at] += w * (Pair ? a[at] + b[at] : b[at]);
      sums[at + 6 * tile_width] += wz * (Pair ? a[at] - b[at] : b[at]);
    }
    sums[i + 3 * tile_width] += wz * (Pair ? a[i] - b[i] : b[i]);
    for (int n = 3; n < 6; ++n) {
      const int at = i + n * tile_width;
      sums[at + tile_width] += w * (Pair ? a[at] + b[at] : b[at]);
    }
    sums[i + 9 * tile_width] += wzz * one;
  }
}

}  // namespace

PALPATE_FOR_PROCESSOR
void weigh_row(const float* in, const Taps& taps, int begin, int end, float* sums) {
  weigh_row_in(in, taps, begin, end, sums);
}

PALPATE_FOR_PROCESSOR
void weigh_column(const float* rows, const Taps& taps, int begin, int end, float* sums) {
  weigh_column_in(rows, taps, begin, end, sums);
}

PALPATE_FOR_PROCESSOR
void weigh_slices(const WeightPair* pairs, int count, int begin, int end, float* sums) {
  clear(weight_space_sums, begin, end, sums);
  for (int n = 0; n < count; ++n) {
    if (pairs[n].above == nullptr) {
      add_slices<false>(pairs[n], begin, end, sums);
    } else {
      add_slices<true>(pairs[n], begin, end, sums);
    }
  }
}

}  // namespace palpate::io::internal

// NOLINTEND(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
