#include "palpate/io/internal/straight_filters.h"

#include "palpate/io/internal/for_processor.h"

namespace palpate::io::internal {
namespace {

// Several pairs in one pass over the row, so that the sums stay in registers meanwhile.
constexpr int at_once = 4;

[[gnu::always_inline]] inline void add_row_pairs(const float* __restrict in, const TapPair* pairs, int count, int width,
                                                 float* __restrict one, float* __restrict p) {
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    float even = one[i];
    float odd = p[i];
    for (int n = 0; n < count; ++n) {
      const float right = in[i + pairs[n].offset];
      const float left = in[i - pairs[n].offset];
      even += pairs[n].even * (right + left);
      odd += pairs[n].odd * (right - left);
    }
    one[i] = even;
    p[i] = odd;
  }
}

[[gnu::always_inline]] inline void add_column_pairs(const float* __restrict rows, std::ptrdiff_t stride,
                                                    const TapPair* pairs, int count, int width, float* __restrict one,
                                                    float* __restrict p, float* __restrict q) {
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    float s0 = one[i];
    float s1 = p[i];
    float s2 = q[i];
    for (int n = 0; n < count; ++n) {
      const float* const right = rows + pairs[n].offset * stride;
      const float* const left = rows - pairs[n].offset * stride;
      s0 += pairs[n].even * (right[i] + left[i]);
      s1 += pairs[n].even * (right[i + width] + left[i + width]);
      s2 += pairs[n].odd * (right[i] - left[i]);
    }
    one[i] = s0;
    p[i] = s1;
    q[i] = s2;
  }
}

/// A piece of the voxels, so small that its sums stay in the nearest cache.
struct Piece {
  std::size_t first;
  std::size_t count;
  std::size_t plane;
  float* s0;  ///< null: not wanted
  float* p;
  float* q;
  float* w;
};

template <int Count, bool Total>
[[gnu::always_inline]] inline void add_slice_pairs(const SlicePair* pairs, const Piece& piece) {
  float* __restrict const s0 = piece.s0;
  float* __restrict const p = piece.p;
  float* __restrict const q = piece.q;
  float* __restrict const w = piece.w;
  const std::size_t plane = piece.plane;
  const float* a[Count];
  const float* b[Count];
  float weight[Count];
  float weight_w[Count];
  for (int c = 0; c < Count; ++c) {
    a[c] = pairs[c].above + piece.first;
    b[c] = pairs[c].below + piece.first;
    weight[c] = pairs[c].weight;
    weight_w[c] = pairs[c].weight_w;
  }
  const std::size_t count = piece.count;
  PALPATE_INDEPENDENT
  for (std::size_t n = 0; n < count; ++n) {
    float sum0 = Total ? s0[n] : 0;
    float sum1 = p[n];
    float sum2 = q[n];
    float sum3 = w[n];
    for (int c = 0; c < Count; ++c) {
      if constexpr (Total) sum0 += weight[c] * (a[c][n] + b[c][n]);
      sum1 += weight[c] * (a[c][n + plane] + b[c][n + plane]);
      sum2 += weight[c] * (a[c][n + 2 * plane] + b[c][n + 2 * plane]);
      sum3 += weight_w[c] * (a[c][n] - b[c][n]);
    }
    if constexpr (Total) s0[n] = sum0;
    p[n] = sum1;
    q[n] = sum2;
    w[n] = sum3;
  }
}

template <bool Total>
[[gnu::always_inline]] inline void add_slice(const SlicePair& slice, const Piece& piece) {
  float* __restrict const s0 = piece.s0;
  float* __restrict const p = piece.p;
  float* __restrict const q = piece.q;
  float* __restrict const w = piece.w;
  const float* __restrict const b = slice.below + piece.first;
  const std::size_t plane = piece.plane;
  const float weight = slice.weight;
  const float weight_w = slice.weight_w;
  const std::size_t count = piece.count;
  PALPATE_INDEPENDENT
  for (std::size_t n = 0; n < count; ++n) {
    if constexpr (Total) s0[n] += weight * b[n];
    p[n] += weight * b[n + plane];
    q[n] += weight * b[n + 2 * plane];
    w[n] += weight_w * b[n];
  }
}

template <bool Total>
[[gnu::always_inline]] inline void add_all_slices(const SlicePair* pairs, int pair_count, const Piece& piece) {
  for (int c = 0; c < pair_count;) {
    if (pairs[c].above == nullptr) {
      add_slice<Total>(pairs[c], piece);
      ++c;
    } else if (c + 1 < pair_count && pairs[c + 1].above != nullptr) {
      add_slice_pairs<2, Total>(pairs + c, piece);
      c += 2;
    } else {
      add_slice_pairs<1, Total>(pairs + c, piece);
      ++c;
    }
  }
}

}  // namespace

PALPATE_FOR_PROCESSOR
void filter_row(const float* in, float middle, const TapPair* pairs, int count, int width, float* one, float* p) {
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    one[i] = middle * in[i];
    p[i] = 0;
  }
  int n = 0;
  for (; n + at_once <= count; n += at_once) add_row_pairs(in, pairs + n, at_once, width, one, p);
  for (; n < count; ++n) add_row_pairs(in, pairs + n, 1, width, one, p);
}

PALPATE_FOR_PROCESSOR
void filter_column(const float* rows, std::ptrdiff_t stride, float middle, const TapPair* pairs, int count, int width,
                   float* one, float* p, float* q) {
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    one[i] = middle * rows[i];
    p[i] = middle * rows[i + width];
    q[i] = 0;
  }
  int n = 0;
  for (; n + at_once <= count; n += at_once) add_column_pairs(rows, stride, pairs + n, at_once, width, one, p, q);
  for (; n < count; ++n) add_column_pairs(rows, stride, pairs + n, 1, width, one, p, q);
}

PALPATE_FOR_PROCESSOR
void sum_slices(const SlicePair* pairs, int pair_count, std::size_t plane, float* s0, float* p, float* q, float* w,
                std::size_t count) {
  constexpr std::size_t longest = 512;
  for (std::size_t first = 0; first < count; first += longest) {
    const std::size_t length = count - first < longest ? count - first : longest;
    const Piece piece{first, length, plane, s0 != nullptr ? s0 + first : nullptr, p + first, q + first, w + first};
    for (std::size_t n = 0; n < length; ++n) piece.p[n] = piece.q[n] = piece.w[n] = 0;
    if (s0 == nullptr) {
      add_all_slices<false>(pairs, pair_count, piece);
    } else {
      for (std::size_t n = 0; n < length; ++n) piece.s0[n] = 0;
      add_all_slices<true>(pairs, pair_count, piece);
    }
  }
}

PALPATE_FOR_PROCESSOR
void fit_balanced_row(const glm::mat3& slope, const float* p, const float* q, const float* w, int count,
                      glm::vec3* gradients) {
  float m[9];
  for (int n = 0; n < 9; ++n) m[n] = slope[n / 3][n % 3];
  float* const out = &gradients->x;
  PALPATE_INDEPENDENT
  for (int i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      out[3 * i + axis] = ((m[axis] * p[i] + m[3 + axis] * q[i]) + m[6 + axis] * w[i]) + 0.0F;
    }
  }
}

PALPATE_FOR_PROCESSOR
void to_floats(const std::int16_t* stored, int count, float* values) {
  PALPATE_INDEPENDENT
  for (int n = 0; n < count; ++n) values[n] = static_cast<float>(stored[n]);
}

PALPATE_FOR_PROCESSOR
void to_floats(const std::uint16_t* stored, int count, float* values) {
  PALPATE_INDEPENDENT
  for (int n = 0; n < count; ++n) values[n] = static_cast<float>(stored[n]);
}

}  // namespace palpate::io::internal
