#include "solver/primitive.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace palpate::solver {
namespace {

TEST(Primitive, DirectedForceActsEverywhere) {  // equation (2)
  const Primitive force = make_directed_force(2, {0, 1, 0});
  EXPECT_EQ(force_on(force, {5, -7, 1e6}), Vec3(0, 2, 0));
  EXPECT_EQ(force_on(force, Vec3{0}), Vec3(0, 2, 0));
}

TEST(Primitive, PointAttractsWithAllItsStrength) {  // equation (3)
  const Primitive point = make_point(5, {1, 0, 0});
  const Vec3 force = force_on(point, {4, 4, 0});
  EXPECT_NEAR(force.x, -3, 1e-15);
  EXPECT_NEAR(force.y, -4, 1e-15);
  EXPECT_EQ(force.z, 0);
  EXPECT_EQ(force_on(point, {1, 0, 0}), Vec3{0});
  EXPECT_NEAR(glm::length(force_on(point, {1 + 1e-12, 0, 0})), 5, 1e-15);
}

TEST(Primitive, LineAttractsAcrossItsDirection) {  // equations (4) and (5)
  const Primitive line = make_line(5, {0, 0, 100}, {0, 0, 1});
  const Vec3 force = force_on(line, {3, -4, 7});
  EXPECT_NEAR(force.x, -3, 1e-15);
  EXPECT_NEAR(force.y, 4, 1e-15);
  EXPECT_NEAR(force.z, 0, 1e-15);
  EXPECT_EQ(force_on(line, {0, 0, -12}), Vec3{0});
}

TEST(Primitive, PlanePushesWhatIsBehindIt) {  // equation (6)
  const Primitive plane = make_plane(3, {0, 0, 1}, {0, 0, 1});
  EXPECT_EQ(force_on(plane, {9, 9, 0.5}), Vec3(0, 0, 3));
  EXPECT_EQ(force_on(plane, {9, 9, 1}), Vec3{0});
  EXPECT_EQ(force_on(plane, {9, 9, 1.5}), Vec3{0});
}

TEST(Primitive, TypesHaveTheNamesOfSceneFiles) {
  EXPECT_STREQ(name_of(PrimitiveType::directed_force), "force");
  EXPECT_STREQ(name_of(PrimitiveType::plane), "plane");
  EXPECT_STREQ(name_of(PrimitiveType::line), "line");
  EXPECT_STREQ(name_of(PrimitiveType::point), "point");
}

}  // namespace
}  // namespace palpate::solver
