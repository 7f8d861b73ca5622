#include "io/fields/plane_fit.h"

#include <cstring>

#include "io/fields/straight_sums.h"
#include "io/for_processor.h"

namespace palpate::io::internal {
namespace {

/// Four voxels side by side.
using Four [[gnu::vector_size(32)]] = double;
using FourFloats [[gnu::vector_size(16)]] = float;

constexpr Four zero{}, one{1, 1, 1, 1};

/// 1 / d where d > 0, else 0. A division takes as long as all that is done with it: so there is one for each divisor.
[[gnu::always_inline]] inline void reciprocal_or_0(const Four& d, Four& to) {
  to = d > zero ? one / d : zero;
}

/// Calls use(n, numbers) with the fits' rows, as in straight_sums.h. sum(n): the n-th sum of the four.
template <typename Sum, typename Use>
[[gnu::always_inline]] inline void fit_four(const Sum& sum, double scale_mm, const glm::dmat3& to_patient,
                                            const Use& use) {
  // Single-precision rounding alone leaves a spread of up to 1e-6 of scale^2 where there is none; slices 5 mm apart at
  // a scale of 1.5 mm still have 0.08.
  constexpr double least_spread = 1e-4;
  const double least = least_spread * scale_mm * scale_mm;
  Four total, per_total, p, q, w, pp, pq, qq, pw, qw, ww;
  sum(0, total);
  reciprocal_or_0(total, per_total);
  const auto mean = [&](int n, Four& to) __attribute__((always_inline)) {
    sum(n, to);
    to *= per_total;
  };
  mean(1, p), mean(2, q), mean(3, w);
  mean(4, pp), mean(5, pq), mean(6, qq), mean(7, pw), mean(8, qw), mean(9, ww);
  Four r0, r1, r2;
  // The covariance's inverse by L D L^T. A pivot below the least takes its row and column out of the inverse.
  const Four c00 = pp - p * p;
  const Four d0 = c00 > least ? c00 : zero;
  reciprocal_or_0(d0, r0);
  const Four l01 = (pq - q * p) * r0, l02 = (pw - w * p) * r0;
  const Four c11 = qq - q * q - l01 * l01 * d0;
  const Four d1 = c11 > least ? c11 : zero;
  reciprocal_or_0(d1, r1);
  const Four l12 = (qw - w * q - l02 * l01 * d0) * r1;
  const Four c22 = ww - w * w - l02 * l02 * d0 - l12 * l12 * d1;
  const Four d2 = c22 > least ? c22 : zero;
  reciprocal_or_0(d2, r2);
  // Its rows, each element 0 where its pivot is.
  const Four m22 = r2, m12 = d1 > zero ? -l12 * r2 : zero;
  const Four m02 = d0 > zero ? (l12 * l01 - l02) * r2 : zero;
  const Four m11 = d1 > zero ? r1 - l12 * m12 : zero;
  const Four m01 = d0 > zero ? -l01 * m11 - l02 * m12 : zero;
  const Four m00 = d0 > zero ? r0 - l01 * m01 - l02 * m02 : zero;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = to_patient[0][axis], b = to_patient[1][axis], c = to_patient[2][axis];
    const Four along_p = (a * m00 + b * m01 + c * m02) * per_total;
    const Four along_q = (a * m01 + b * m11 + c * m12) * per_total;
    const Four along_w = (a * m02 + b * m12 + c * m22) * per_total;
    use(axis, along_p);
    use(3 + axis, along_q);
    use(6 + axis, along_w);
    use(9 + axis, zero - (along_p * p + along_q * q + along_w * w));
  }
}

}  // namespace

PlaneFit fit_plane(const float* sums, std::size_t stride, double scale_mm, const glm::dmat3& to_patient) noexcept {
  float f[fit_rows];
  const auto sum = [&](std::size_t n, Four & to) __attribute__((always_inline)) {
    const auto here = static_cast<double>(sums[n * stride]);
    to = Four{here, here, here, here};
  };
  fit_four(
      sum, scale_mm,
      to_patient, [&](int n, const Four& all) __attribute__((always_inline)) { f[n] = static_cast<float>(all[0]); });
  return {glm::mat3(f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8]), glm::vec3(f[9], f[10], f[11])};
}

PALPATE_FOR_PROCESSOR
void fit_planes(const float* sums, int begin, int end, double scale_mm, const glm::dmat3& to_patient,
                float* fits) noexcept {
  for (int i = begin; i < end; i += 4) {
    const auto sum = [&](int n, Four& to) __attribute__((always_inline)) {
      FourFloats four;
      std::memcpy(&four, sums + n * tile_width + i, sizeof four);
      to = __builtin_convertvector(four, Four);
    };
    fit_four(
        sum, scale_mm, to_patient, [&](int n, const Four& all) __attribute__((always_inline)) {
          const auto four = __builtin_convertvector(all, FourFloats);
          std::memcpy(fits + n * tile_width + i, &four, sizeof four);
        });
  }
}

}  // namespace palpate::io::internal
