// Distances outside the stored region.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "io/structures/distance_field.h"

namespace palpate::io {
namespace {

// They go on as they are at the edge of the lattice, plus the way there; and the gradient is that of the value.
TEST(DistanceBeyondTheLattice, GoesOnWithItsOwnGradient) {
  Mask ball;
  ball.geometry.dimensions = ball.size = glm::ivec3(14);
  for (int k = 0; k < 14; ++k) ball.geometry.slice_positions.emplace_back(-6.5, -6.5, k - 6.5);
  for (int n = 0; n < 14 * 14 * 14; ++n) {
    const Vec3 at = ball.geometry.to_patient({n % 14, n / 14 % 14, n / 196});
    ball.occupancy.push_back(glm::length(at) < 4 ? Mask::full : 0);
  }
  const auto field = distance_of(ball);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Vec3 along(0);
      along[axis] = sign;
      EXPECT_NEAR(field->sample(300.0 * along).mm, 4 - 300, 2) << axis;
      EXPECT_LT(glm::distance(field->sample(300.0 * along).gradient, -along), 0.1) << axis;
    }
  }
  constexpr double h = 1e-4;
  for (const Vec3& at : {Vec3(200, 3, -7), Vec3(-150, 250, 5), Vec3(180, -190, -220), Vec3(-7, 4, 130)}) {
    const Vec3 gradient = field->sample(at).gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 step(0);
      step[axis] = h;
      EXPECT_NEAR(gradient[axis], (field->sample(at + step).mm - field->sample(at - step).mm) / (2 * h), 2e-3) << axis;
    }
  }
}

}  // namespace
}  // namespace palpate::io
