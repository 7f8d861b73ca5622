#include "io/fields/symmetric_eigen.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

namespace palpate::io::internal {

SymmetricEigen eigen_of_symmetric(const glm::dmat3& matrix) noexcept {
  // Not computeDirect(): it is faster, and gives vectors to 1e-9 only where two eigenvalues are nearly the same, as
  // they are across a vessel.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(
      Eigen::Map<const Eigen::Matrix3d>(glm::value_ptr(matrix)));
  std::array order{0, 1, 2};
  const auto sort = [&](std::size_t a, std::size_t b) {
    if (std::abs(solved.eigenvalues()[order[b]]) < std::abs(solved.eigenvalues()[order[a]])) {
      std::swap(order[a], order[b]);
    }
  };
  sort(0, 1);
  sort(1, 2);
  sort(0, 1);
  SymmetricEigen eigen;
  for (int n = 0; n < 3; ++n) {
    const int of = order[static_cast<std::size_t>(n)];
    eigen.values[n] = solved.eigenvalues()[of];
    for (int axis = 0; axis < 3; ++axis) eigen.vectors[n][axis] = solved.eigenvectors()(axis, of);
  }
  return eigen;
}

}  // namespace palpate::io::internal
