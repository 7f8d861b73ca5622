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
  // A row's four numbers side by side, two in a register: they are weighed along the row last of all. Each plane is
  // summed for itself, so that it is weighed once and not row by row.
  using Two [[gnu::vector_size(16)]] = double;
  struct Row {
    Two half[2] = {};
    void add(double weight, const Row& other) noexcept {
      for (int n = 0; n < 2; ++n) half[n] += weight * other.half[n];
    }
    double sum(const std::array<double, 4>& weight) const noexcept {
      return (weight[0] * half[0][0] + weight[1] * half[0][1]) + (weight[2] * half[1][0] + weight[3] * half[1][1]);
    }
  };
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

}  // namespace palpate::io
