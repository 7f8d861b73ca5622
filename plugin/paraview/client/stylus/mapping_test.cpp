#include "plugin/paraview/client/stylus/mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>

namespace palpate::plugin {
namespace {

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
  EXPECT_LT(glm::length(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
}

TEST(Mapping, FromTheFrontItIsTheDefault) {
  const glm::dmat3 rotation = rotation_of({.position = {0, -500, 0}, .focus = {0, 0, 0}, .up = {0, 0, 1}});
  const glm::dmat3 usual = modes::Workspace{}.rotation;
  for (int axis = 0; axis < 3; ++axis) expect_near(rotation[axis], usual[axis]);
}

TEST(Mapping, IsARightHandedRotationFromAnywhere) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 1000; ++n) {
    Eye eye;
    for (int axis = 0; axis < 3; ++axis) {
      eye.position[axis] = 300 * normal(random);
      eye.focus[axis] = 100 * normal(random);
      eye.up[axis] = normal(random);
    }
    const glm::dmat3 rotation = rotation_of(eye);
    EXPECT_NEAR(glm::determinant(rotation), 1, 1e-9);
    expect_near(rotation[2], glm::normalize(eye.position - eye.focus), 1e-12);
    EXPECT_GT(glm::dot(rotation[1], eye.up), 0) << "up on the screen is up in the hand";
  }
}

TEST(Mapping, TheViewsHeightIsTheDevices) {
  const Eye eye{.position = {300, -400, 10}, .focus = {5, 6, 7}, .up = {0, 0, 1}, .height_mm = 240};
  const glm::dvec3 half_extent_m{0.08, 0.06, 0.06};
  const modes::WorkspaceSettings settings = fit_view(eye, half_extent_m);
  const modes::Workspace workspace =
      modes::place_workspace(settings, {-100, -100, -100}, {100, 100, 100}, half_extent_m);
  expect_near(workspace.to_patient({0, 0, 0}), eye.focus);
  const glm::dvec3 top = workspace.to_patient({0, 0.06, 0});
  EXPECT_NEAR(glm::length(top - eye.focus), 120, 1e-9);
  EXPECT_GT(glm::dot(top - eye.focus, eye.up), 0);
}

TEST(Mapping, OneToOneKeepsTheMiddleAndTheTurn) {
  modes::Workspace now;
  now.center_mm = {1, 2, 3};
  now.mm_per_m = 2500;
  const modes::WorkspaceSettings settings = one_to_one(now);
  EXPECT_EQ(settings.scale, 1);
  EXPECT_EQ(settings.center_mm, now.center_mm);
  EXPECT_EQ(settings.rotation, now.rotation);
}

}  // namespace
}  // namespace palpate::plugin
