#include "io/fields/straight_filters.h"

#include "io/for_processor.h"

namespace palpate::io::internal {
namespace {

// Several pairs in one pass, so that the sums stay in registers meanwhile; the first pass starts them.

template <int Count, bool First>
[[gnu::always_inline]] inline void add_row_pairs(const float* __restrict in, float middle, const TapPair* pairs,
                                                 int width, float* __restrict one, float* __restrict p) {
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    float even = First ? middle * in[i] : one[i];
    float odd = First ? 0 : p[i];
    for (int n = 0; n < Count; ++n) {
      const float right = in[i + pairs[n].offset];
      const float left = in[i - pairs[n].offset];
      even += pairs[n].even * (right + left);
      odd += pairs[n].odd * (right - left);
    }
    one[i] = even;
    p[i] = odd;
  }
}

template <int Count, bool First>
[[gnu::always_inline]] inline void add_column_pairs(const float* __restrict rows, std::ptrdiff_t stride, float middle,
                                                    const TapPair* pairs, int width, float* __restrict one,
                                                    float* __restrict p, float* __restrict q) {
  PALPATE_INDEPENDENT
  for (int i = 0; i < width; ++i) {
    float s0 = First ? middle * rows[i] : one[i];
    float s1 = First ? middle * rows[i + width] : p[i];
    float s2 = First ? 0 : q[i];
    for (int n = 0; n < Count; ++n) {
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

/// Calls pass<Count, First>(pairs) with as many pairs at once as there are registers for.
template <typename Pass>
[[gnu::always_inline]] inline void in_passes(const TapPair* pairs, int count, const Pass& pass) {
  const auto at_most = [&]<bool First>(const TapPair* from, int rest) __attribute__((always_inline)) {
    switch (rest) {
      case 0:
        return pass.template operator()<0, First>(from);
      case 1:
        return pass.template operator()<1, First>(from);
      case 2:
        return pass.template operator()<2, First>(from);
      default:
        return pass.template operator()<3, First>(from);
    }
  };
  at_most.template operator()<true>(pairs, count);
  for (int n = 3; n < count; n += 3) at_most.template operator()<false>(pairs + n, count - n);
}

struct Sums {
  float* s0;  ///< null: not wanted
  float* p;
  float* q;
  float* w;
};

template <int Count, bool Total>
[[gnu::always_inline]] inline void add_slice_pairs(const SlicePair* pairs, std::size_t plane, const Sums& sums,
                                                   std::size_t count) {
  float* __restrict const s0 = sums.s0;
  float* __restrict const p = sums.p;
  float* __restrict const q = sums.q;
  float* __restrict const w = sums.w;
  PALPATE_INDEPENDENT
  for (std::size_t n = 0; n < count; ++n) {
    float sum0 = Total ? s0[n] : 0;
    float sum1 = p[n];
    float sum2 = q[n];
    float sum3 = w[n];
    for (int c = 0; c < Count; ++c) {
      const float* const a = pairs[c].above;
      const float* const b = pairs[c].below;
      if constexpr (Total) sum0 += pairs[c].weight * (a[n] + b[n]);
      sum1 += pairs[c].weight * (a[n + plane] + b[n + plane]);
      sum2 += pairs[c].weight * (a[n + 2 * plane] + b[n + 2 * plane]);
      sum3 += pairs[c].weight_w * (a[n] - b[n]);
    }
    if constexpr (Total) s0[n] = sum0;
    p[n] = sum1;
    q[n] = sum2;
    w[n] = sum3;
  }
}

template <bool Total, bool First>
[[gnu::always_inline]] inline void add_slice(const SlicePair& slice, std::size_t plane, const Sums& sums,
                                             std::size_t count) {
  float* __restrict const s0 = sums.s0;
  float* __restrict const p = sums.p;
  float* __restrict const q = sums.q;
  float* __restrict const w = sums.w;
  const float* __restrict const b = slice.below;
  const float weight = slice.weight;
  const float weight_w = slice.weight_w;
  PALPATE_INDEPENDENT
  for (std::size_t n = 0; n < count; ++n) {
    if constexpr (Total) s0[n] = (First ? 0 : s0[n]) + weight * b[n];
    p[n] = (First ? 0 : p[n]) + weight * b[n + plane];
    q[n] = (First ? 0 : q[n]) + weight * b[n + 2 * plane];
    w[n] = (First ? 0 : w[n]) + weight_w * b[n];
  }
}

template <bool Total>
[[gnu::always_inline]] inline void add_all_slices(const SlicePair* pairs, int pair_count, std::size_t plane,
                                                  const Sums& sums, std::size_t count) {
  // From itself outwards: the first is always one slice.
  add_slice<Total, true>(pairs[0], plane, sums, count);
  for (int c = 1; c < pair_count;) {
    if (pairs[c].above == nullptr) {
      add_slice<Total, false>(pairs[c], plane, sums, count);
      ++c;
    } else if (c + 1 < pair_count && pairs[c + 1].above != nullptr) {
      add_slice_pairs<2, Total>(pairs + c, plane, sums, count);
      c += 2;
    } else {
      add_slice_pairs<1, Total>(pairs + c, plane, sums, count);
      ++c;
    }
  }
}

}  // namespace

PALPATE_FOR_PROCESSOR
void filter_row(const float* in, float middle, const TapPair* pairs, int count, int width, float* one, float* p) {
  in_passes(
      pairs, count, [=]<int Count, bool First>(const TapPair* from) __attribute__((always_inline)) {
        add_row_pairs<Count, First>(in, middle, from, width, one, p);
      });
}

PALPATE_FOR_PROCESSOR
void filter_column(const float* rows, std::ptrdiff_t stride, float middle, const TapPair* pairs, int count, int width,
                   float* one, float* p, float* q) {
  in_passes(
      pairs, count, [=]<int Count, bool First>(const TapPair* from) __attribute__((always_inline)) {
        add_column_pairs<Count, First>(rows, stride, middle, from, width, one, p, q);
      });
}

PALPATE_FOR_PROCESSOR
void sum_slices(const SlicePair* pairs, int pair_count, std::size_t plane, float* s0, float* p, float* q, float* w,
                std::size_t count) {
  const Sums sums{s0, p, q, w};
  if (s0 == nullptr) {
    add_all_slices<false>(pairs, pair_count, plane, sums, count);
  } else {
    add_all_slices<true>(pairs, pair_count, plane, sums, count);
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
