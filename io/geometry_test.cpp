#include "io/geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <random>

namespace palpate::io {
namespace {

// Oblique, with different pixel spacings, steps that lean against the normal and are of uneven length.
Geometry uneven_tilted() {
  Geometry geometry;
  geometry.dimensions = {40, 30, 6};
  geometry.direction_i = glm::normalize(Vec3(1, 0.2, -0.1));
  geometry.direction_j = glm::normalize(glm::cross(Vec3(0.1, -0.3, 1), geometry.direction_i));
  geometry.spacing_i = 0.7;
  geometry.spacing_j = 0.45;
  Vec3 position(-120.5, 33.25, 700);
  const Vec3 normal = glm::cross(geometry.direction_i, geometry.direction_j);
  for (const double step : {1.0, 1.0, 2.5, 1.0, 0.6, 0.0}) {
    geometry.slice_positions.push_back(position);
    position += step * (normal + 0.25 * geometry.direction_j);
  }
  geometry.step = (geometry.slice_positions.back() - geometry.slice_positions.front()) / 5.0;
  geometry.uniform = false;
  return geometry;
}

TEST(Geometry, VoxelCentersComeBackAsIntegers) {
  const Geometry geometry = uneven_tilted();
  for (int k = 0; k < 6; ++k) {
    for (int j = 0; j < 30; j += 7) {
      for (int i = 0; i < 40; i += 3) {
        const Vec3 center = geometry.slice_positions[static_cast<std::size_t>(k)] + i * 0.7 * geometry.direction_i +
                            j * 0.45 * geometry.direction_j;
        EXPECT_EQ(geometry.to_index(center), Vec3(i, j, k));
      }
    }
  }
}

TEST(Geometry, ToIndexUndoesToPatientInsideAndOutside) {
  const Geometry geometry = uneven_tilted();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-8, 45);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 index(anywhere(random), anywhere(random), anywhere(random));
    EXPECT_LT(glm::length(geometry.to_index(geometry.to_patient(index)) - index), 1e-8);
  }
}

TEST(Geometry, IsContinuousAcrossASlice) {
  const Geometry geometry = uneven_tilted();
  for (int k = 0; k < 6; ++k) {
    const Vec3 below = geometry.to_patient({3.3, 4.4, k - 1e-7});
    const Vec3 above = geometry.to_patient({3.3, 4.4, k + 1e-7});
    EXPECT_LT(glm::length(above - below), 1e-6);
  }
}

TEST(Geometry, ContainsTheHullOfTheVoxelCenters) {
  const Geometry geometry = uneven_tilted();
  EXPECT_TRUE(geometry.contains({0, 0, 0}));
  EXPECT_TRUE(geometry.contains({39, 29, 5}));
  EXPECT_FALSE(geometry.contains({39.01, 29, 5}));
  EXPECT_FALSE(geometry.contains({0, -0.01, 0}));
  EXPECT_FALSE(geometry.contains({0, 0, 5.01}));
  EXPECT_FALSE(geometry.contains({std::nan(""), 0, 0}));
}

// f(p) = g.p has the index gradient J^T g, whatever the shear.
TEST(Geometry, GradientsOfALinearFieldComeBackInPatientSpace) {
  const Geometry geometry = uneven_tilted();
  const Vec3 gradient(3, -5, 7);
  for (const double k : {0.0, 1.5, 2.2, 4.9, 5.0}) {
    const Vec3 at(11, 12, std::min(k, 4.5));
    Vec3 index_gradient(0);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 step(0);
      step[axis] = 0.05;
      index_gradient[axis] = glm::dot(gradient, geometry.to_patient(at + step) - geometry.to_patient(at)) / 0.05;
    }
    EXPECT_LT(glm::length(geometry.index_gradient_to_patient(at.z) * index_gradient - gradient), 1e-9) << k;
  }
}

TEST(Geometry, OneSliceHasItsOwnStep) {
  Geometry geometry;
  geometry.dimensions = {4, 4, 1};
  geometry.slice_positions = {{1, 2, 3}};
  geometry.step = {0, 0, 5};
  EXPECT_EQ(geometry.to_index({2, 3, 8}), Vec3(1, 1, 1));
  EXPECT_TRUE(geometry.contains(geometry.to_index({2, 3, 3})));
  EXPECT_FALSE(geometry.contains(geometry.to_index({2, 3, 3.5})));
}

}  // namespace
}  // namespace palpate::io
