#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palpate::io::internal {

/// Eigenvalues and unit eigenvectors (columns) of a symmetric matrix, by ascending magnitude of the eigenvalue.
struct SymmetricEigen {
  glm::dvec3 values{0};
  glm::dmat3 vectors{1};
};

/// With Eigen's symmetric QR iteration: Golub and Van Loan, "Matrix Computations", section 8.3. For the tick: no
/// allocation, and a bounded number of steps.
SymmetricEigen eigen_of_symmetric(const glm::dmat3& matrix) noexcept;

}  // namespace palpate::io::internal
