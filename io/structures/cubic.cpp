#include "io/structures/cubic.h"

#include <cstring>

namespace palpate::io {
namespace {

// A row's four numbers side by side, two in a register: they are weighed along the row last of all. Each plane is
// summed for itself, so that it is weighed once and not row by row.
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

CubicSample plain_cubic_sample(const float* first, std::ptrdiff_t row, std::ptrdiff_t plane,
                               const glm::dvec3& t) noexcept {
  const CubicWeights x(t.x);
  const CubicWeights y(t.y);
  const CubicWeights z(t.z);
  Row plain, along_y, along_z;
  for (std::size_t k = 0; k < 4; ++k) {
    Row in_plane, in_plane_y;
    for (std::size_t j = 0; j < 4; ++j) {
      const float* r = first + (static_cast<std::ptrdiff_t>(k) * plane + static_cast<std::ptrdiff_t>(j) * row);
      const Row numbers{{{r[0], r[1]}, {r[2], r[3]}}};
      in_plane.add(y.value[j], numbers);
      in_plane_y.add(y.slope[j], numbers);
    }
    plain.add(z.value[k], in_plane);
    along_y.add(z.value[k], in_plane_y);
    along_z.add(z.slope[k], in_plane);
  }
  return {plain.sum(x.value), {plain.sum(x.slope), along_y.sum(x.value), along_z.sum(x.value)}};
}

#ifdef __x86_64__

namespace {

using Four [[gnu::vector_size(32)]] = double;
using FourFloats [[gnu::vector_size(16)]] = float;

// plain_cubic_sample() with a row in one register and the weights of all axes side by side: each number is computed as
// there. Not by PALPATE_FOR_PROCESSOR, for without such registers a vector of four is slower than two of two.
__attribute__((target("avx2"))) CubicSample wide_cubic_sample(const float* first, std::ptrdiff_t row,
                                                              std::ptrdiff_t plane, const glm::dvec3& t) noexcept {
  const CubicWeightsOf<Four> weights(Four{t.x, t.y, t.z, 0});
  Four plain{};
  Four along_y{};
  Four along_z{};
#pragma GCC unroll 4
  for (std::ptrdiff_t k = 0; k < 4; ++k) {
    Four in_plane{};
    Four in_plane_y{};
#pragma GCC unroll 4
    for (std::ptrdiff_t j = 0; j < 4; ++j) {
      FourFloats floats;
      std::memcpy(&floats, first + (k * plane + j * row), sizeof floats);
      const Four numbers = __builtin_convertvector(floats, Four);
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

}  // namespace

CubicSample cubic_sample(const float* first, std::ptrdiff_t row, std::ptrdiff_t plane, const glm::dvec3& t) noexcept {
  return __builtin_cpu_supports("avx2") ? wide_cubic_sample(first, row, plane, t)
                                        : plain_cubic_sample(first, row, plane, t);
}

#else

CubicSample cubic_sample(const float* first, std::ptrdiff_t row, std::ptrdiff_t plane, const glm::dvec3& t) noexcept {
  return plain_cubic_sample(first, row, plane, t);
}

#endif

}  // namespace palpate::io
