#include "testdata/phantom.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace palpate::testdata {
namespace {

TEST(Phantom, LaterBodiesArePaintedOverEarlierOnes) {
  const Phantom shell = make_shell(5, 8, 40, -500, -1000);
  EXPECT_EQ(value_at(shell, {0, 0, 4.9}), -500);
  EXPECT_EQ(value_at(shell, {0, 5.1, 0}), 40);
  EXPECT_EQ(value_at(shell, {8.1, 0, 0}), -1000);
  const Layer layers[] = {{-2, 40}, {3, 1000}};
  const Phantom slab = make_slab({0, 1, 0}, layers);
  EXPECT_EQ(value_at(slab, {9, -2.1, 9}), -1000);
  EXPECT_EQ(value_at(slab, {9, 2.9, 9}), 40);
  EXPECT_EQ(value_at(slab, {9, 3.1, 9}), 1000);
}

TEST(Phantom, WedgeHasTwoMaterialsUnderOneSurface) {
  const Phantom wedge = make_wedge(45, 1, 2, 0);
  EXPECT_EQ(value_at(wedge, {-5, 0, 0.1}), 0);
  EXPECT_EQ(value_at(wedge, {5, 0, 0.1}), 0);
  EXPECT_EQ(value_at(wedge, {5, 0, -4.9}), 1);  // x + z > 0
  EXPECT_EQ(value_at(wedge, {5, 0, -5.1}), 2);
  EXPECT_EQ(value_at(wedge, {-1, 0, -0.1}), 2);
}

double integral(const Phantom& phantom, double half_width, const Vec3& spacing) {
  const Vec3 edges[3] = {{spacing.x, 0, 0}, {0, spacing.y, 0}, {0, 0, spacing.z}};
  double sum = 0;
  for (double x = -half_width + spacing.x / 2; x < half_width; x += spacing.x) {
    for (double y = -half_width + spacing.y / 2; y < half_width; y += spacing.y) {
      for (double z = -half_width + spacing.z / 2; z < half_width; z += spacing.z) {
        sum += mean_value(phantom, {x, y, z}, edges);
      }
    }
  }
  return sum * spacing.x * spacing.y * spacing.z;
}

TEST(MeanValue, AddsUpToTheVolumeOfTheBody) {
  constexpr double radius = 4.3;
  const double ball = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  EXPECT_NEAR(integral(make_sphere(radius, 1, 0), 6, {1, 1, 1}) / ball, 1, 2e-4);
  EXPECT_NEAR(integral(make_sphere(radius, 1, 0), 6, {1, 0.8, 3}) / ball, 1, 2e-4);
  const double cylinder = std::numbers::pi * radius * radius * 12;
  EXPECT_NEAR(integral(make_tube(radius, {0, 0, 1}, 1, 0), 6, {1, 1, 1}) / cylinder, 1, 2e-4);
}

TEST(MeanValue, OfEachVoxelOfASphereIsThatOfManySamples) {
  const Phantom sphere = make_sphere(5, 1000, 0);
  const Vec3 edges[3] = {{1, 0, 0}, {0, 0.9, 0.3}, {0, -0.6, 1.8}};
  for (const Vec3& center : {Vec3(4.4, 1.2, 2.1), Vec3(0.3, -4.8, 0.6), Vec3(3, 3, 3), Vec3(0, 0, 5)}) {
    double sum = 0;
    constexpr int n = 120;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < n; ++k) {
          const Vec3 u = (Vec3(i, j, k) + 0.5) / static_cast<double>(n) - 0.5;
          sum += value_at(sphere, center + u.x * edges[0] + u.y * edges[1] + u.z * edges[2]);
        }
      }
    }
    EXPECT_NEAR(mean_value(sphere, center, edges), sum / (n * n * n), 0.5);  // 1e-4 stated, 4e-4 of the counting
  }
}

TEST(MeanValue, OfAFlatEdgeIsExact) {
  const Layer layers[] = {{0.3, 100}};
  const Vec3 edges[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 2}};
  EXPECT_NEAR(mean_value(make_slab({0, 0, 1}, layers, 0), {0, 0, 0}, edges), 100 * (1 - 0.3) / 2, 1e-12);
  EXPECT_EQ(mean_value(make_slab({0, 0, 1}, layers, 0), {0, 0, 1.3}, edges), 100);
  EXPECT_EQ(mean_value(make_slab({0, 0, 1}, layers, 0), {0, 0, -0.7}, edges), 0);
}

TEST(MeanValue, WhereSurfacesMeetIsAsGoodAsStated) {
  // In a voxel about the wedge's edge: half air, and below it the interface parts the rest in halves (upright
  // interface).
  const Vec3 edges[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_NEAR(mean_value(make_wedge(90, 100, 300, 0), {0, 0, 0}, edges), 0.5 * 200, 300.0 / 16);
}

}  // namespace
}  // namespace palpate::testdata
