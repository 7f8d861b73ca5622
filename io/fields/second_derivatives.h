#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "io/fields/fits.h"
#include "io/fields/gradient.h"

namespace palpate::io::internal {

using Hessian = GradientKernel::Hessian;

/// The relative rounding error, after a few hundred additions in single precision, of a sum that should cancel.
inline constexpr double single_rounding = 3e-6;

/// The sums of second order, as a matrix.
template <typename SumAt>
glm::dmat3 second_order(const SumAt& sum) noexcept {
  return {sum(4), sum(5), sum(7), sum(5), sum(6), sum(8), sum(7), sum(8), sum(9)};
}

inline Hessian unknown_hessian() noexcept {
  Hessian unknown;
  unknown.fill(std::numeric_limits<float>::quiet_NaN());
  return unknown;
}

/// From the second-order sums of a complete neighborhood to its Hessian: the second derivative of a Gaussian of
/// covariance C is the Gaussian times C^-1 (x x^T - C) C^-1.
class SecondDerivatives {
 public:
  SecondDerivatives(const Fits::Sums& whole, double scale_mm, const glm::dmat3& to_patient) noexcept
      : total_(static_cast<double>(whole[0])), rounding_(single_rounding * scale_mm * scale_mm) {
    const auto weight = [&](std::size_t n) { return static_cast<double>(whole[n]) / total_; };
    covariance_ = second_order(weight);
    known_ = glm::determinant(covariance_) > 0;  // a single slice has no curvature across slices
    inverse_ = known_ ? to_patient * glm::inverse(covariance_) : glm::dmat3(0);
  }

  Hessian operator()(const float* sums, std::size_t stride) const noexcept {
    if (!known_) {
      return unknown_hessian();
    }
    const auto sum = [&](std::size_t n) { return static_cast<double>(sums[n * stride]) / total_; };
    const glm::dmat3 excess = second_order(sum) - sum(0) * covariance_;
    const double largest = std::max(glm::length(excess[0]), std::max(glm::length(excess[1]), glm::length(excess[2])));
    if (largest <= rounding_ * std::abs(sum(0))) {
      return {};
    }
    const glm::dmat3 h = inverse_ * excess * glm::transpose(inverse_);
    return {static_cast<float>(h[0][0]), static_cast<float>(h[1][0]), static_cast<float>(h[1][1]),
            static_cast<float>(h[2][0]), static_cast<float>(h[2][1]), static_cast<float>(h[2][2])};
  }

 private:
  double total_;
  double rounding_;
  glm::dmat3 covariance_{0};
  glm::dmat3 inverse_{0};
  bool known_ = false;
};

}  // namespace palpate::io::internal
