#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palpate::io::internal {

/// Eigenvalues and unit eigenvectors (columns) of a symmetric matrix, by ascending magnitude of the eigenvalue.
struct SymmetricEigen {
  glm::dvec3 values{0};
  glm::dmat3 vectors{1};
};

/// Cyclic Jacobi: Golub and Van Loan, "Matrix Computations", section 8.5. In the tick: a fixed number of sweeps.
SymmetricEigen eigen_of_symmetric(glm::dmat3 matrix) noexcept;

}  // namespace palpate::io::internal
