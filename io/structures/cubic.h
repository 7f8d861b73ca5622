#pragma once

/// Catmull-Rom weights: through the nodes, once differentiable. Source: Keys, "Cubic convolution interpolation for
/// digital image processing", IEEE ASSP 29 (1981), a = -1/2.

#include <array>
#include <cstddef>

namespace palpate::io {

struct CubicWeights {
  std::array<double, 4> value;  ///< of the nodes at -1, 0, 1 and 2
  std::array<double, 4> slope;  ///< their derivatives, per step

  /// `t` in [0, 1]: from node 0 to node 1.
  explicit CubicWeights(double t) noexcept
      : value{0.5 * t * (-1.0 + t * (2.0 - t)), 0.5 * (2.0 + t * t * (-5.0 + 3.0 * t)),
              0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)},
        slope{0.5 * (-1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * (-10.0 + 9.0 * t), 0.5 * (1.0 + t * (8.0 - 9.0 * t)),
              0.5 * t * (3.0 * t - 2.0)} {}
};

/// Value and slopes (per step along each axis) from 4 x 4 x 4 numbers whose rows are `row` and planes `plane` apart;
/// `first` is the one at -1, -1, -1.
struct CubicSample {
  double value = 0;
  double slope[3] = {0, 0, 0};
};
inline CubicSample cubic_sample(const float* first, std::ptrdiff_t row, std::ptrdiff_t plane, const CubicWeights& x,
                                const CubicWeights& y, const CubicWeights& z) noexcept {
  CubicSample sample;
  for (std::ptrdiff_t k = 0; k < 4; ++k) {
    double along_x = 0, along_y = 0, value = 0;
    for (std::ptrdiff_t j = 0; j < 4; ++j) {
      const float* r = first + (k * plane + j * row);
      const double v = x.value[0] * r[0] + x.value[1] * r[1] + x.value[2] * r[2] + x.value[3] * r[3];
      const double s = x.slope[0] * r[0] + x.slope[1] * r[1] + x.slope[2] * r[2] + x.slope[3] * r[3];
      value += y.value[static_cast<std::size_t>(j)] * v;
      along_x += y.value[static_cast<std::size_t>(j)] * s;
      along_y += y.slope[static_cast<std::size_t>(j)] * v;
    }
    sample.value += z.value[static_cast<std::size_t>(k)] * value;
    sample.slope[0] += z.value[static_cast<std::size_t>(k)] * along_x;
    sample.slope[1] += z.value[static_cast<std::size_t>(k)] * along_y;
    sample.slope[2] += z.slope[static_cast<std::size_t>(k)] * value;
  }
  return sample;
}

}  // namespace palpate::io
