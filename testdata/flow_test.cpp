#include "testdata/flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace palpate::testdata {
namespace {

using io::Vec3;
constexpr io::FieldSet all = io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::vector;
const FlowPastSphere tunnel{{1, 2, 3}, 20, {0.6, 0, 0.8}, 1.2, 1000};
const Vec3 places[] = {{30, 5, 8}, {-12, 20, 9}, {0, -40, 70}, {18, 18, -9}};

TEST(Flow, IsFreeOfSourcesAndOfRotation) {
  const FlowSource flow(tunnel);
  constexpr double h = 1e-3;
  for (const Vec3& p : places) {
    Vec3 derivative[3];
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 e(0);
      e[axis] = h;
      derivative[axis] = (flow.sample(p + e, all).vector - flow.sample(p - e, all).vector) / (2 * h);
    }
    EXPECT_NEAR(derivative[0].x + derivative[1].y + derivative[2].z, 0, 1e-9);
    EXPECT_NEAR(derivative[0].y, derivative[1].x, 1e-9);
    EXPECT_NEAR(derivative[0].z, derivative[2].x, 1e-9);
    EXPECT_NEAR(derivative[1].z, derivative[2].y, 1e-9);
  }
}

TEST(Flow, DoesNotPassThroughTheSphere) {
  const FlowSource flow(tunnel);
  for (const Vec3& p : places) {
    const Vec3 normal = glm::normalize(p);
    const io::Sample s = flow.sample(tunnel.center + (20 + 1e-9) * normal, all);
    ASSERT_TRUE(s.inside);
    EXPECT_NEAR(glm::dot(s.vector, normal), 0, 1e-9);
  }
  // Fastest at the equator: 3/2 of the free stream; the pressure there is -5/4 of the dynamic pressure.
  const io::Sample equator = flow.sample(tunnel.center + Vec3(0, 20 + 1e-9, 0), all);
  EXPECT_NEAR(glm::length(equator.vector), 1.5, 1e-9);
  EXPECT_NEAR(equator.value, -1.25 * 0.5 * 1.2, 1e-9);
  EXPECT_FALSE(flow.sample(tunnel.center + Vec3(0, 19.9, 0), all).inside);
}

TEST(Flow, PressureGradientIsTheDerivativeOfThePressure) {
  const FlowSource flow(tunnel);
  constexpr double h = 1e-3;
  for (const Vec3& p : places) {
    const io::Sample s = flow.sample(p, all);
    EXPECT_GT(glm::length(s.gradient), 1e-4);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 e(0);
      e[axis] = h;
      EXPECT_NEAR(s.gradient[axis], (flow.sample(p + e, all).value - flow.sample(p - e, all).value) / (2 * h), 1e-9);
    }
  }
}

TEST(Flow, IsTheFreeStreamFarAway) {
  const FlowSource flow(tunnel);
  EXPECT_LT(glm::length(flow.sample({990, 0, 0}, all).vector - tunnel.free_stream), 2e-5);
  EXPECT_FALSE(flow.sample({1100, 0, 0}, all).inside);
  EXPECT_THROW(FlowSource({{0, 0, 0}, 0, {1, 0, 0}, 1, 100}), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::testdata
