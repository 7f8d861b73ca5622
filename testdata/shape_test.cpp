#include "testdata/shape.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace palpate::testdata {
namespace {

const Vec3 unit_edges[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

double sampled_fraction(const Vec3& normal, double offset, const Vec3 (&edges)[3]) {
  constexpr int n = 100;
  int below = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        const Vec3 u = (Vec3(i, j, k) + 0.5) / static_cast<double>(n) - 0.5;
        below += glm::dot(normal, u.x * edges[0] + u.y * edges[1] + u.z * edges[2]) <= offset;
      }
    }
  }
  return static_cast<double>(below) / (n * n * n);
}

TEST(Fraction, AgreesWithCountingPoints) {
  const Vec3 sheared[3] = {{0.7, 0, 0}, {0, 0.9, 0.1}, {0.2, -0.3, 5}};
  const Vec3 normals[] = {{1, 0, 0},         {0, -1, 0},        {0.6, 0.8, 0},
                          {0.01, 0.2, 0.98}, {-0.5, 0.6, 0.62}, {0.577, 0.577, 0.577}};
  for (const Vec3& n : normals) {
    for (const double offset : {-2.0, -0.45, -0.2, -0.01, 0.0, 0.13, 0.3, 0.6, 1.7}) {
      EXPECT_NEAR(fraction_behind_plane(glm::normalize(n), offset, unit_edges),
                  sampled_fraction(glm::normalize(n), offset, unit_edges), 6e-3);
      EXPECT_NEAR(fraction_behind_plane(glm::normalize(n), offset, sheared),
                  sampled_fraction(glm::normalize(n), offset, sheared), 6e-3);
    }
  }
}

TEST(Fraction, OfACornerIsATetrahedron) {
  // x + y + z <= -1 in the unit box cuts off a corner with legs of 1/2: volume 1/48.
  const double s = std::sqrt(3.0);
  EXPECT_NEAR(fraction_behind_plane(Vec3(1) / s, -1 / s, unit_edges), 1.0 / 48, 1e-15);
}

TEST(Fraction, IsContinuousAsAPlaneTurnsIntoAnAxis) {
  for (double lean = 1e-2; lean > 1e-12; lean /= 3) {
    EXPECT_NEAR(fraction_behind_plane(glm::normalize(Vec3(lean, lean / 2, 1)), 0.2, unit_edges), 0.7,
                2 * lean * lean + 2e-6);
    EXPECT_NEAR(fraction_behind_plane(glm::normalize(Vec3(lean, 1, 1)), 0.0, unit_edges), 0.5, 1e-9);
  }
}

TEST(Distance, IsSignedWithOutwardUnitGradient) {
  const Shape shapes[] = {HalfSpace{{0.6, 0, 0.8}, 2}, Ball{{1, 2, 3}, 4}, Cylinder{{1, 0, 0}, {0, 0.6, 0.8}, 3}};
  const Vec3 p(2.3, -1.1, 4.7);
  constexpr double h = 1e-5;
  for (const Shape& shape : shapes) {
    const Distance d = distance_to(shape, p);
    EXPECT_NEAR(glm::length(d.normal), 1, 1e-14);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 e(0);
      e[axis] = h;
      const double slope = (distance_to(shape, p + e).signed_mm - distance_to(shape, p - e).signed_mm) / (2 * h);
      EXPECT_NEAR(d.normal[axis], slope, 1e-8);
    }
    // Going back along the normal by the distance ends on the surface.
    EXPECT_NEAR(distance_to(shape, p - d.signed_mm * d.normal).signed_mm, 0, 1e-12);
  }
  EXPECT_LT(distance_to(Ball{{0, 0, 0}, 1}, {0, 0, 0}).signed_mm, 0);
}

}  // namespace
}  // namespace palpate::testdata
