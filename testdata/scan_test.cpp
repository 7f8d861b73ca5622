#include "testdata/scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace palpate::testdata {
namespace {

TEST(Grid, IsCenterdAndSteppedAlongTheTable) {
  Grid grid;
  grid.size = {11, 21, 5};
  grid.spacing = {0.5, 0.7, 3};
  grid.center = {10, 20, 30};
  const io::Geometry g = make_geometry(grid);
  EXPECT_EQ(g.dimensions, glm::ivec3(11, 21, 5));
  EXPECT_TRUE(g.uniform);
  EXPECT_LT(glm::length(g.to_patient({5, 10, 2}) - grid.center), 1e-12);
  EXPECT_LT(glm::length(g.step - Vec3(0, 0, 3)), 1e-12);
}

TEST(Grid, TiltLeansTheSlicesAndNotTheStep) {
  Grid grid;
  grid.tilt_degrees = 20;
  const io::Geometry g = make_geometry(grid);
  EXPECT_LT(glm::length(g.step - Vec3(0, 0, 1)), 1e-12);
  const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
  EXPECT_NEAR(glm::dot(normal, g.step), std::cos(20 * std::acos(-1.0) / 180), 1e-12);
  EXPECT_LT(glm::length(g.to_patient({31.5, 31.5, 31.5})), 1e-9);
}

TEST(Grid, MissingSlicesAreGaps) {
  Grid grid;
  grid.size = {4, 4, 10};
  grid.missing = {0, 4, 5, 9};
  const io::Geometry g = make_geometry(grid);
  EXPECT_EQ(g.dimensions.z, 6);
  EXPECT_EQ(g.gaps, std::vector<int>{2});  // slices 1 2 3 | 6 7 8
  EXPECT_FALSE(g.uniform);
}

TEST(Grid, RefusesWhatIsNoVolume) {
  Grid grid;
  grid.spacing.y = 0;
  EXPECT_THROW(make_geometry(grid), std::invalid_argument);
  grid = {};
  grid.direction_j = {0.1, 1, 0};
  EXPECT_THROW(make_geometry(grid), std::invalid_argument);
  grid = {};
  grid.uneven_mm = 0.6;
  EXPECT_THROW(make_geometry(grid), std::invalid_argument);
}

TEST(Scan, VoxelsAreWhereTheGeometrySaysOnAnObliqueTiltedGrid) {
  Grid grid;
  grid.size = {30, 28, 20};
  grid.spacing = {0.8, 1.1, 2};
  grid.tilt_degrees = 15;
  grid.uneven_mm = 0.4;
  grid = rotated(grid, {1, 2, 3}, 35);
  const Phantom sphere = make_sphere(9, 500, -500);
  const io::Volume volume = scan(sphere, make_geometry(grid));
  constexpr double reach = 1.5;  // more than half a voxel's diagonal
  int whole = 0;
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 28; ++j) {
      for (int i = 0; i < 30; ++i) {
        const Vec3 p = volume.geometry.to_patient({i, j, k});
        const double value = volume.value_at(i, j, k);
        if (std::abs(glm::length(p) - 9) > reach) {
          EXPECT_EQ(value, value_at(sphere, p));
          whole += value > 0;
        } else {
          EXPECT_GE(value, -500);
          EXPECT_LE(value, 500);
        }
      }
    }
  }
  EXPECT_GT(whole, 500);
}

TEST(Scan, NoiseIsGaussianAndSeeded) {
  Grid grid;
  grid.size = {40, 40, 40};
  const Phantom even{40, {}};
  const io::Geometry g = make_geometry(grid);
  const io::Volume a = scan(even, g, {.noise = 20, .seed = 7, .quantised = false});
  const io::Volume b = scan(even, g, {.noise = 20, .seed = 7, .quantised = false});
  const io::Volume c = scan(even, g, {.noise = 20, .seed = 8, .quantised = false});
  EXPECT_EQ(a.voxels, b.voxels);
  EXPECT_NE(a.voxels, c.voxels);
  double sum = 0;
  double squares = 0;
  double fourth = 0;
  double neighbors = 0;
  const auto& v = std::get<std::vector<float>>(a.voxels);
  for (std::size_t n = 0; n < v.size(); ++n) {
    const double d = v[n] - 40;
    sum += d;
    squares += d * d;
    fourth += d * d * d * d;
    neighbors += n > 0 ? d * (v[n - 1] - 40) : 0;
  }
  const auto count = static_cast<double>(v.size());
  EXPECT_NEAR(sum / count, 0, 4 * 20 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 20, 0.25);
  EXPECT_NEAR(fourth * count / (squares * squares), 3, 0.1);
  EXPECT_NEAR(neighbors / squares, 0, 0.02);
}

TEST(Scan, CircleIsPadding) {
  Grid grid;
  grid.size = {20, 20, 2};
  const io::Volume v = scan(make_sphere(30), make_geometry(grid), {.circle_radius = 9});
  EXPECT_TRUE(v.is_padding(0, 0, 1));
  EXPECT_FALSE(v.is_padding(10, 10, 0));
}

TEST(Scan, RefusesValuesThatDoNotFit) {
  EXPECT_THROW(scan(Phantom{60000, {}}, make_geometry({})), std::range_error);
}

}  // namespace
}  // namespace palpate::testdata
