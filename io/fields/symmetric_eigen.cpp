#include "io/fields/symmetric_eigen.h"

#include <cmath>
#include <utility>

namespace palpate::io::internal {
namespace {

/// The rotation in the plane of axes p and q that takes the matrix's (p, q) element to zero.
void rotate(glm::dmat3& a, glm::dmat3& vectors, int p, int q) noexcept {
  if (a[p][q] == 0) {
    return;
  }
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  for (int n = 0; n < 3; ++n) {
    const double along_p = a[n][p];
    const double along_q = a[n][q];
    a[n][p] = c * along_p - s * along_q;
    a[n][q] = s * along_p + c * along_q;
  }
  for (int n = 0; n < 3; ++n) {
    const double along_p = a[p][n];
    const double along_q = a[q][n];
    a[p][n] = c * along_p - s * along_q;
    a[q][n] = s * along_p + c * along_q;
    const double vector_p = vectors[p][n];
    const double vector_q = vectors[q][n];
    vectors[p][n] = c * vector_p - s * vector_q;
    vectors[q][n] = s * vector_p + c * vector_q;
  }
  a[p][q] = a[q][p] = 0;
}

}  // namespace

SymmetricEigen eigen_of_symmetric(glm::dmat3 matrix) noexcept {
  constexpr int sweeps = 6;  // convergence is quadratic: a 3 x 3 is done after four
  SymmetricEigen eigen;
  for (int n = 0; n < sweeps; ++n) {
    rotate(matrix, eigen.vectors, 0, 1);
    rotate(matrix, eigen.vectors, 0, 2);
    rotate(matrix, eigen.vectors, 1, 2);
  }
  eigen.values = {matrix[0][0], matrix[1][1], matrix[2][2]};
  for (const auto& [a, b] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 1}}) {
    if (std::abs(eigen.values[b]) < std::abs(eigen.values[a])) {
      std::swap(eigen.values[a], eigen.values[b]);
      std::swap(eigen.vectors[a], eigen.vectors[b]);
    }
  }
  return eigen;
}

}  // namespace palpate::io::internal
