#include "io/structures/cubic.h"

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace palpate::io {
namespace {

// A row's four numbers side by side, two in a register. They are weighted along the row last. Each plane is summed
// separately, so that it is weighted once and not row by row.
using Two [[gnu::vector_size(16)]] = double;
struct Row {
  Two half[2] = {};
  void add(double weight, const Row& other) noexcept {
    for (int n = 0; n < 2; ++n) half[n] += weight * other.half[n];
  }
  double sum(const double (&weight)[4]) const noexcept {
    return (weight[0] * half[0][0] + weight[1] * half[0][1]) + (weight[2] * half[1][0] + weight[3] * half[1][1]);
  }
};

}  // namespace

CubicSample plain_cubic_sample(const float* first, std::ptrdiff_t row, std::ptrdiff_t plane, double x, double y,
                               double z) noexcept {
  const CubicWeights of_x(x);
  const CubicWeights of_y(y);
  const CubicWeights of_z(z);
  Row plain, along_y, along_z;
  for (std::size_t k = 0; k < 4; ++k) {
    Row in_plane, in_plane_y;
    for (std::size_t j = 0; j < 4; ++j) {
      const float* r = first + (static_cast<std::ptrdiff_t>(k) * plane + static_cast<std::ptrdiff_t>(j) * row);
      const Row numbers{{{r[0], r[1]}, {r[2], r[3]}}};
      in_plane.add(of_y.value[j], numbers);
      in_plane_y.add(of_y.slope[j], numbers);
    }
    plain.add(of_z.value[k], in_plane);
    along_y.add(of_z.value[k], in_plane_y);
    along_z.add(of_z.slope[k], in_plane);
  }
  return {plain.sum(of_x.value), {plain.sum(of_x.slope), along_y.sum(of_x.value), along_z.sum(of_x.value)}};
}

#ifdef __x86_64__

namespace {

using Four [[gnu::vector_size(32)]] = double;

}  // namespace

// plain_cubic_sample() with a row in one register and the weights of all axes side by side: each number is computed as
// there. Not by PALPATE_FOR_PROCESSOR, for without such registers a vector of four is slower than two of two.
__attribute__((target("avx2"))) CubicSample wide_cubic_sample(const float* first, std::ptrdiff_t row,
                                                              std::ptrdiff_t plane, double x, double y,
                                                              double z) noexcept {
  const CubicWeightsOf<Four> weights(Four{x, y, z, 0});
  Four plain{};
  Four along_y{};
  Four along_z{};
#pragma GCC unroll 4
  for (std::ptrdiff_t k = 0; k < 4; ++k) {
    Four in_plane{};
    Four in_plane_y{};
#pragma GCC unroll 4
    for (std::ptrdiff_t j = 0; j < 4; ++j) {
      const Four numbers = _mm256_cvtps_pd(_mm_loadu_ps(first + (k * plane + j * row)));
      in_plane += weights.value[j][1] * numbers;
      in_plane_y += weights.slope[j][1] * numbers;
    }
    plain += weights.value[k][2] * in_plane;
    along_y += weights.value[k][2] * in_plane_y;
    along_z += weights.slope[k][2] * in_plane;
  }
  Four parts[4];
#pragma GCC unroll 4
  for (int n = 0; n < 4; ++n) {
    const double value = weights.value[n][0];
    parts[n] = Four{value, weights.slope[n][0], value, value} * Four{plain[n], plain[n], along_y[n], along_z[n]};
  }
  const Four sums = (parts[0] + parts[1]) + (parts[2] + parts[3]);
  return {sums[0], {sums[1], sums[2], sums[3]}};
}

#endif

}  // namespace palpate::io
