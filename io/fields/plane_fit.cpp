#include "io/fields/plane_fit.h"

#include <cstddef>
#include <glm/matrix.hpp>

namespace palpate::io::internal {
namespace {

/// Inverse of a covariance by L D L^T; a pivot below `least` takes its row and column out of the inverse.
glm::dmat3 inverse_of_covariance(const glm::dmat3& c, double least) noexcept {
  glm::dmat3 inverse(0);
  glm::dmat3 l(1);
  double d[3];
  for (int j = 0; j < 3; ++j) {
    d[j] = c[j][j];
    for (int n = 0; n < j; ++n) {
      d[j] -= l[n][j] * l[n][j] * d[n];
    }
    if (!(d[j] > least)) {
      d[j] = 0;
    }
    for (int i = j + 1; i < 3; ++i) {
      double sum = c[j][i];
      for (int n = 0; n < j; ++n) {
        sum -= l[n][i] * l[n][j] * d[n];
      }
      l[j][i] = d[j] > 0 ? sum / d[j] : 0;
    }
  }
  for (int column = 0; column < 3; ++column) {
    if (d[column] == 0) {
      continue;
    }
    double y[3] = {0, 0, 0};
    for (int i = column; i < 3; ++i) {
      y[i] = i == column ? 1 : 0;
      for (int n = column; n < i; ++n) {
        y[i] -= l[n][i] * y[n];
      }
    }
    for (int i = 2; i >= 0; --i) {
      double x = d[i] > 0 ? y[i] / d[i] : 0;
      for (int n = i + 1; n < 3 && d[i] > 0; ++n) {
        x -= l[i][n] * inverse[column][n];
      }
      inverse[column][i] = x;
    }
  }
  return inverse;
}

}  // namespace

PlaneFit fit_plane(const float* sums, std::size_t stride, double scale_mm, const glm::dmat3& to_patient) noexcept {
  const auto sum = [&](std::size_t n) { return static_cast<double>(sums[n * stride]); };
  const double total = sum(0);
  if (!(total > 0)) {
    return {};
  }
  const glm::dvec3 mean = glm::dvec3(sum(1), sum(2), sum(3)) / total;
  const glm::dmat3 second(sum(4), sum(5), sum(7), sum(5), sum(6), sum(8), sum(7), sum(8), sum(9));
  const glm::dmat3 covariance = second / total - glm::outerProduct(mean, mean);
  // Spread that rounding in single precision alone may leave where there is none is 1e-6 of scale^2; slices 5 mm apart
  // at a scale of 1.5 mm still have 0.08.
  constexpr double least_spread = 1e-4;
  const glm::dmat3 inverse = inverse_of_covariance(covariance, least_spread * scale_mm * scale_mm);
  const glm::dmat3 slope = to_patient * inverse / total;
  return {glm::mat3(slope), glm::vec3(-(slope * mean))};
}

}  // namespace palpate::io::internal
