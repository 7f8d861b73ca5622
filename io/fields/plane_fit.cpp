#include "io/fields/plane_fit.h"

#include "io/fields/straight_filters.h"

namespace palpate::io::internal {
namespace {

/// Two voxels side by side: as many as a register of any x86-64 processor holds, and wider ones divide no faster.
using Two [[gnu::vector_size(16)]] = double;

Two quotient_or_0(Two a, Two b) {
  return b > 0 ? a / b : Two{0, 0};
}

/// The inverse of a covariance by L D L^T: columns n, rows m at [3 n + m].
struct Inverse {
  Two of[9];
};

/// c: 00, 01, 11, 02, 12, 22. A pivot below `least` takes its row and column out of the inverse.
Inverse inverse_of_covariance(const Two (&c)[6], double least) {
  const Two zero{0, 0}, one{1, 1};
  const auto pivot = [&](Two d) { return d > least ? d : zero; };
  const Two d0 = pivot(c[0]);
  const Two l01 = quotient_or_0(c[1], d0), l02 = quotient_or_0(c[3], d0);
  const Two d1 = pivot(c[2] - l01 * l01 * d0);
  const Two l12 = quotient_or_0(c[4] - l02 * l01 * d0, d1);
  const Two d2 = pivot(c[5] - l02 * l02 * d0 - l12 * l12 * d1);

  const Two y01 = zero - l01, y02 = zero - l02 - l12 * y01;
  const Two x02 = quotient_or_0(y02, d2);
  const Two x01 = d1 > 0 ? y01 / d1 - l12 * x02 : zero;
  const Two x00 = one / d0 - l01 * x01 - l02 * x02;
  const Two x12 = quotient_or_0(zero - l12, d2);
  const Two x11 = one / d1 - l12 * x12;
  const Two x10 = zero - l01 * x11 - l02 * x12;
  const Two x22 = one / d2;
  const Two x21 = d1 > 0 ? zero - l12 * x22 : zero;
  const Two x20 = d0 > 0 ? zero - l01 * x21 - l02 * x22 : zero;
  return {{d0 > 0 ? x00 : zero, d0 > 0 ? x01 : zero, d0 > 0 ? x02 : zero, d1 > 0 ? (d0 > 0 ? x10 : zero) : zero,
           d1 > 0 ? x11 : zero, d1 > 0 ? x12 : zero, d2 > 0 ? x20 : zero, d2 > 0 ? x21 : zero, d2 > 0 ? x22 : zero}};
}

/// Calls use(n, numbers) with the fits' rows, as in straight_filters.h. sum(n): the n-th sum of the two.
template <typename Sum, typename Use>
[[gnu::always_inline]] inline void fit_two(const Sum& sum, double scale_mm, const glm::dmat3& to_patient,
                                           const Use& use) {
  // Spread that rounding in single precision alone may leave where there is none is 1e-6 of scale^2; slices 5 mm apart
  // at a scale of 1.5 mm still have 0.08.
  constexpr double least_spread = 1e-4;
  const Two total = sum(0);
  const Two mean[3] = {sum(1) / total, sum(2) / total, sum(3) / total};
  const Two covariance[6] = {sum(4) / total - mean[0] * mean[0], sum(5) / total - mean[1] * mean[0],
                             sum(6) / total - mean[1] * mean[1], sum(7) / total - mean[2] * mean[0],
                             sum(8) / total - mean[2] * mean[1], sum(9) / total - mean[2] * mean[2]};
  const Inverse inverse = inverse_of_covariance(covariance, least_spread * scale_mm * scale_mm);
  for (int axis = 0; axis < 3; ++axis) {
    Two slope[3];
    for (int n = 0; n < 3; ++n) {
      const Two* const column = inverse.of + 3 * n;
      slope[n] = quotient_or_0(
          to_patient[0][axis] * column[0] + to_patient[1][axis] * column[1] + to_patient[2][axis] * column[2], total);
      use(3 * n + axis, slope[n]);
    }
    const Two constant = -(slope[0] * mean[0] + slope[1] * mean[1] + slope[2] * mean[2]);
    use(9 + axis, total > 0 ? constant : Two{0, 0});
  }
}

}  // namespace

PlaneFit fit_plane(const float* sums, std::size_t stride, double scale_mm, const glm::dmat3& to_patient) noexcept {
  float f[fit_rows];
  const auto sum = [&](std::size_t n) {
    const auto one = static_cast<double>(sums[n * stride]);
    return Two{one, one};
  };
  fit_two(sum, scale_mm, to_patient, [&](int n, const Two& both) { f[n] = static_cast<float>(both[0]); });
  return {glm::mat3(f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8]), glm::vec3(f[9], f[10], f[11])};
}

void fit_planes(const float* sums, int begin, int end, double scale_mm, const glm::dmat3& to_patient,
                float* fits) noexcept {
  for (int i = begin; i < end; i += 2) {
    const auto sum = [&](int n) {
      const float* const both = sums + n * tile_width + i;
      return Two{static_cast<double>(both[0]), static_cast<double>(both[1])};
    };
    fit_two(sum, scale_mm, to_patient, [&](int n, const Two& both) {
      float* const to = fits + n * tile_width + i;
      to[0] = static_cast<float>(both[0]);
      to[1] = static_cast<float>(both[1]);
    });
  }
}

}  // namespace palpate::io::internal
