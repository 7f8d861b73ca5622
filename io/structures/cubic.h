#pragma once

/// Catmull-Rom weights: through the nodes, once differentiable. Source: Keys, "Cubic convolution interpolation for
/// digital image processing", IEEE ASSP 29 (1981), a = -1/2.

#include <cstddef>
#include <glm/vec3.hpp>

namespace palpate::io {

/// Weights along one axis if Number is a double; along several axes side by side if it is a vector.
template <typename Number>
struct CubicWeightsOf {
  Number value[4];  ///< of the nodes at -1, 0, 1 and 2
  Number slope[4];  ///< their derivatives, per step

  /// `t` in [0, 1]: from node 0 to node 1.
  [[gnu::always_inline]] explicit CubicWeightsOf(const Number& t) noexcept
      : value{0.5 * t * (-1.0 + t * (2.0 - t)), 0.5 * (2.0 + t * t * (-5.0 + 3.0 * t)),
              0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)},
        slope{0.5 * (-1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * (-10.0 + 9.0 * t), 0.5 * (1.0 + t * (8.0 - 9.0 * t)),
              0.5 * t * (3.0 * t - 2.0)} {}
};
using CubicWeights = CubicWeightsOf<double>;

/// Value and slopes (per step along each axis).
struct CubicSample {
  double value = 0;
  double slope[3] = {0, 0, 0};
};

/// From 4 x 4 x 4 numbers; rows are `row` and planes `plane` apart, and `first` is the number at -1, -1, -1. x, y, z:
/// the fraction of a step along each axis.
CubicSample plain_cubic_sample(const float* first, std::ptrdiff_t row, std::ptrdiff_t plane, double x, double y,
                               double z) noexcept;

/// The same to the last bit, for processors with AVX2. Not defined for others.
#ifdef __x86_64__
CubicSample wide_cubic_sample(const float* first, std::ptrdiff_t row, std::ptrdiff_t plane, double x, double y,
                              double z) noexcept;
#endif

/// The faster one on this processor.
inline CubicSample cubic_sample(const float* first, std::ptrdiff_t row, std::ptrdiff_t plane,
                                const glm::dvec3& t) noexcept {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) {
    return wide_cubic_sample(first, row, plane, t.x, t.y, t.z);
  }
#endif
  return plain_cubic_sample(first, row, plane, t.x, t.y, t.z);
}

}  // namespace palpate::io
