#include "solver/exact/local.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "solver/testing/problems.h"

namespace palpate::solver::internal {
namespace {

/// How fast one comes out of a plane: minus the way's part along its direction, also of a way that nearly lies in it,
/// and whatever the length that the direction was given with.
TEST(Local, TheRateOfAPlaneIsThatAlongItsDirection) {
  Random random(6);
  for (const double length : {0.5, 1.0, 3.0}) {
    for (const double part : {1.0, 1e-3, 1e-5, 1e-7, 1e-9, -1e-9, -1e-7, -1e-5, -1e-3, -1.0}) {
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 q{0}, way{0};
        q[axis] = 1;
        way[axis] = part;
        way[(axis + 1) % 3] = random.uniform(0.5, 1);
        Placed plane;
        place(make_plane(1, Vec3{0}, q * length), Vec3{0}, plane);
        EXPECT_NEAR(rate_of(plane, fine(way)), -part, 1e-15 * std::abs(part));
      }
    }
  }
}

}  // namespace
}  // namespace palpate::solver::internal
