#include "io/fields/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>

namespace palpate::io::internal {
namespace {

TEST(SymmetricEigen, DiagonalisesRandomMatrices) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> entry(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    const double s = std::pow(10, 6 * entry(random));
    const double a = entry(random) * s, b = entry(random) * s, c = entry(random) * s;
    const glm::dmat3 m(entry(random) * s, a, b, a, entry(random) * s, c, b, c, entry(random) * s);
    const SymmetricEigen e = eigen_of_symmetric(m);
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT(glm::length(m * e.vectors[k] - e.values[k] * e.vectors[k]), 1e-13 * s);
      EXPECT_NEAR(glm::length(e.vectors[k]), 1, 1e-14);
    }
    EXPECT_NEAR(std::abs(glm::determinant(e.vectors)), 1, 1e-13);
    EXPECT_LE(std::abs(e.values[0]), std::abs(e.values[1]));
    EXPECT_LE(std::abs(e.values[1]), std::abs(e.values[2]));
  }
}

TEST(SymmetricEigen, TakesDiagonalAndZeroMatrices) {
  const SymmetricEigen e = eigen_of_symmetric({3, 0, 0, 0, -1, 0, 0, 0, 2});
  EXPECT_EQ(e.values, glm::dvec3(-1, 2, 3));
  EXPECT_EQ(e.vectors[0], glm::dvec3(0, 1, 0));
  EXPECT_EQ(eigen_of_symmetric(glm::dmat3(0)).values, glm::dvec3(0));
}

}  // namespace
}  // namespace palpate::io::internal
