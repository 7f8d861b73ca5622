#include "io/fields/gradient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <random>

#include "io/errors.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

using testdata::Grid;

std::shared_ptr<const Volume> scan(const testdata::Phantom& phantom, const Grid& grid,
                                   const testdata::Acquisition& acquisition = {}) {
  return std::make_shared<const Volume>(testdata::scan(phantom, testdata::make_geometry(grid), acquisition));
}

/// The grids on which everything has to hold: straight, oblique, tilted, uneven with missing slices, thick slices.
std::vector<Grid> grids(const glm::ivec3& size) {
  Grid straight;
  straight.size = size;
  Grid oblique = rotated(straight, {1, 2, 3}, 40);
  Grid tilted = straight;
  tilted.tilt_degrees = 20;
  Grid uneven = oblique;
  uneven.tilt_degrees = -12;
  uneven.uneven_mm = 0.3;
  uneven.missing = {size.z / 2};
  Grid thick = straight;
  thick.spacing = {0.8, 1, 3};
  thick.size.z = size.z / 2;
  return {straight, oblique, tilted, uneven, thick};
}

/// The definition, in double precision and without any separation: the weighted least-squares plane around one voxel.
glm::dvec3 plane_by_definition(const Volume& volume, double scale, const glm::ivec3& at) {
  const Geometry& g = volume.geometry;
  const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
  const auto height = [&](int k) { return glm::dot(g.slice_positions[static_cast<std::size_t>(k)], normal); };
  const int slices = g.dimensions.z;
  std::vector<double> steps;
  for (int k = 1; k < slices; ++k) steps.push_back(height(k) - height(k - 1));
  std::sort(steps.begin(), steps.end());
  const double usual = steps[steps.size() / 2];
  const Vec3 center = g.to_patient(at);
  const int reach_i = static_cast<int>(std::ceil(3.2 * scale / g.spacing_i));
  const int reach_j = static_cast<int>(std::ceil(3.2 * scale / g.spacing_j));
  glm::dmat4 normal_equations(0);
  glm::dvec4 right(0);
  for (int k = 0; k < slices; ++k) {
    const double below = k > 0 ? height(k) - height(k - 1) : usual;
    const double above = k + 1 < slices ? height(k + 1) - height(k) : usual;
    const double share = g.uniform ? 1 : (std::min(below, 1.5 * usual) + std::min(above, 1.5 * usual)) / (2 * usual);
    const Vec3 from = g.to_patient({at.x, at.y, k}) - center;
    if (std::abs(glm::dot(from, normal)) > 3.2 * scale + 1e-6 && std::abs(k - at.z) > 1) continue;
    const int middle_i = static_cast<int>(std::lround(-glm::dot(from, g.direction_i) / g.spacing_i));
    const int middle_j = static_cast<int>(std::lround(-glm::dot(from, g.direction_j) / g.spacing_j));
    for (int j = at.y + middle_j - reach_j; j <= at.y + middle_j + reach_j; ++j) {
      for (int i = at.x + middle_i - reach_i; i <= at.x + middle_i + reach_i; ++i) {
        if (i < 0 || j < 0 || i >= g.dimensions.x || j >= g.dimensions.y || volume.is_padding(i, j, k)) continue;
        const Vec3 offset = g.to_patient({i, j, k}) - center;
        const glm::dvec4 row(1, offset.x, offset.y, offset.z);
        const double weight = share * std::exp(-0.5 * glm::dot(offset, offset) / (scale * scale));
        normal_equations += weight * glm::outerProduct(row, row);
        right += weight * volume.value_at(i, j, k) * row;
      }
    }
  }
  const glm::dvec4 plane = glm::inverse(normal_equations) * right;
  return {plane.y, plane.z, plane.w};
}

TEST(Gradient, IsThePlaneOfItsDefinitionOnEveryGridUpToEdgesAndPadding) {
  for (const Grid& grid : grids({24, 22, 20})) {
    const auto volume = scan(testdata::make_sphere(7), grid, {.noise = 30, .circle_radius = 10.5});
    const GradientKernel kernel(volume, 1.7);
    const auto gradients = kernel.whole();
    const glm::ivec3 last = volume->geometry.dimensions - 1;
    double largest = 0;
    for (const glm::ivec3& at : {last / 2, last / 3, glm::ivec3(12, 3, 0), glm::ivec3(12, 11, last.z),
                                 glm::ivec3(5, 6, 1), glm::ivec3(19, 14, last.z / 2)}) {
      const glm::vec3 got = gradients[volume->offset(at.x, at.y, at.z)];
      const glm::dvec3 expected = plane_by_definition(*volume, 1.7, at);
      EXPECT_LT(glm::length(Vec3(got) - expected), 1e-3 + 1e-5 * glm::length(expected))
          << at.x << ' ' << at.y << ' ' << at.z;
      largest = std::max(largest, glm::length(expected));
    }
    EXPECT_GT(largest, 30);  // the comparison is not one of zeros
  }
}

bool same_gradient_bits(const glm::vec3& a, const glm::vec3& b) {
  const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f); };
  return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

/// The whole volume on one thread and on two, random blocks and random cells.
void expect_the_same_bits_everywhere(const GradientKernel& kernel, const Volume& volume) {
  const auto whole = kernel.whole({}, 1);
  const auto with_two_threads = kernel.whole({}, 2);
  ASSERT_TRUE(std::equal(whole.begin(), whole.end(), with_two_threads.begin(), same_gradient_bits));
  std::mt19937 random(5);
  const glm::ivec3 size = volume.geometry.dimensions;
  for (int n = 0; n < 60; ++n) {
    Block block;
    const bool cell = n >= 20;
    for (int axis = 0; axis < 3; ++axis) {
      block.size[axis] = cell ? 2 : 1 + static_cast<int>(random() % std::min(20U, static_cast<unsigned>(size[axis])));
      block.first[axis] = static_cast<int>(random() % static_cast<unsigned>(size[axis] - block.size[axis] + 1));
    }
    std::vector<glm::vec3> part(static_cast<std::size_t>(block.size.x * block.size.y * block.size.z));
    cell ? kernel.at_cell(block, part) : kernel.at_block(block, part);
    auto got = part.begin();
    for (int k = 0; k < block.size.z; ++k) {
      for (int j = 0; j < block.size.y; ++j) {
        for (int i = 0; i < block.size.x; ++i) {
          const glm::ivec3 v = block.first + glm::ivec3(i, j, k);
          ASSERT_TRUE(same_gradient_bits(*got++, whole[volume.offset(v.x, v.y, v.z)]))
              << v.x << ' ' << v.y << ' ' << v.z;
        }
      }
    }
  }
}

TEST(Gradient, HasTheSameBitsInTheWholeInAnyBlockAndInACell) {
  for (const bool quantised : {true, false}) {
    for (const double circle : {0.0, 12.0}) {
      if (circle > 0 && !quantised) continue;
      for (const Grid& grid : grids({39, 26, 22})) {
        const auto volume =
            scan(testdata::make_sphere(8), grid, {.noise = 40, .quantised = quantised, .circle_radius = circle});
        expect_the_same_bits_everywhere(GradientKernel(volume, 1.4), *volume);
        expect_the_same_bits_everywhere(GradientKernel(volume, GradientKernel::CentralDifferences{}), *volume);
      }
    }
  }
}

TEST(Gradient, HasTheSameBitsWhereRowsAreLongAndManyVoxelsCount) {
  Grid grid;  // rows of three tiles; twelve voxels on each side along rows, nine along columns, three slices
  grid.size = {530, 44, 13};
  grid.spacing = {0.4, 0.5, 1.7};
  const auto volume = scan(testdata::make_sphere(8), grid, {.noise = 40});
  const GradientKernel kernel(volume, 1.4);
  ASSERT_EQ(kernel.radius(), glm::ivec3(12, 9, 2));
  expect_the_same_bits_everywhere(kernel, *volume);
}

TEST(CentralDifferences, AreExactOnLinearFieldsOnEveryGridUpToEdgesAndPadding) {
  const Vec3 slope(3, -2, 5);
  for (const Grid& grid : grids({24, 22, 20})) {
    Volume v;
    v.geometry = testdata::make_geometry(grid);
    v.slope = 2;
    v.padding = {-9e9, -8e9};
    const glm::ivec3 size = v.geometry.dimensions;
    std::vector<float> voxels;
    for (int k = 0; k < size.z; ++k) {
      for (int j = 0; j < size.y; ++j) {
        for (int i = 0; i < size.x; ++i) {
          const bool padding = (i * 7 + j * 5 + k * 3) % 11 == 0;
          voxels.push_back(padding ? -8.5e9F
                                   : static_cast<float>(0.5 * glm::dot(slope, v.geometry.to_patient({i, j, k}))));
        }
      }
    }
    v.voxels = voxels;
    const auto volume = std::make_shared<const Volume>(std::move(v));
    const auto gradients = GradientKernel(volume, GradientKernel::CentralDifferences{}).whole();
    const auto counts = [&](const glm::ivec3& at) {
      return glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, size)) &&
             !volume->is_padding(at.x, at.y, at.z);
    };
    const auto has_neighbors = [&](const glm::ivec3& at) {
      const auto& gaps = volume->geometry.gaps;
      const bool gap_below = std::find(gaps.begin(), gaps.end(), at.z - 1) != gaps.end();
      const bool gap_above = std::find(gaps.begin(), gaps.end(), at.z) != gaps.end();
      return (counts(at - glm::ivec3(1, 0, 0)) || counts(at + glm::ivec3(1, 0, 0))) &&
             (counts(at - glm::ivec3(0, 1, 0)) || counts(at + glm::ivec3(0, 1, 0))) &&
             ((counts(at - glm::ivec3(0, 0, 1)) && !gap_below) || (counts(at + glm::ivec3(0, 0, 1)) && !gap_above));
    };
    int exact = 0;
    for (int k = 0; k < size.z; ++k) {
      for (int j = 0; j < size.y; ++j) {
        for (int i = 0; i < size.x; ++i) {
          const Vec3 gradient(gradients[volume->offset(i, j, k)]);
          if (!counts({i, j, k})) {
            ASSERT_EQ(gradient, Vec3(0));
          } else if (has_neighbors({i, j, k})) {
            ASSERT_LT(glm::length(gradient - slope), 2e-4) << i << ' ' << j << ' ' << k;
            ++exact;
          }
        }
      }
    }
    EXPECT_GT(exact, size.x * size.y * size.z * 3 / 4);
  }
}

TEST(Gradient, DefaultScaleFollowsVoxelsAndSlices) {
  Grid grid;
  grid.spacing = {0.4, 0.4, 1};
  EXPECT_DOUBLE_EQ(default_gradient_scale_mm(testdata::make_geometry(grid)), 1.5);
  grid.spacing = {0.9, 0.8, 1};
  EXPECT_DOUBLE_EQ(default_gradient_scale_mm(testdata::make_geometry(grid)), 1.8);
  grid.spacing.z = 5;
  grid.missing = {20, 21};
  EXPECT_NEAR(default_gradient_scale_mm(testdata::make_geometry(grid)), 3, 1e-12);
}

TEST(Gradient, CanBeCancelled) {
  const auto volume = scan(testdata::make_sphere(8), grids({39, 26, 22})[0]);
  EXPECT_THROW(GradientKernel(volume, 1.5).whole([](double) { return false; }), Cancelled);
}

// 5 mm slices every 20 mm of a scan with pixels of 0.3 mm, and beyond: felt by a gradient that nobody chose, which the
// kernel has to be able to compute. The truth: of a linear value the gradient is known, at every scale. Where the
// next slice is so far away that it has no weight, there is none across slices.
TEST(Gradient, DefaultScaleIsOneThatCanBeComputedHoweverWideTheGaps) {
  for (const double slice_mm : {10.0, 20.0, 40.0, 100.0}) {
    for (const double tilt : {0.0, 15.0, 30.0}) {
      if (slice_mm > 40 && tilt > 0) continue;  // displaced by more voxels than a kernel reaches over
      Geometry geometry;
      geometry.dimensions = {180, 140, 5};
      geometry.spacing_i = 0.3;
      geometry.spacing_j = 0.4;
      geometry.step = {0, slice_mm * std::tan(glm::radians(tilt)), slice_mm};
      for (int k = 0; k < 5; ++k) geometry.slice_positions.push_back(static_cast<double>(k) * geometry.step);
      auto volume = std::make_shared<Volume>();
      volume->geometry = geometry;
      std::vector<float> voxels;
      const Vec3 slope{3, -2, 5};
      for (int k = 0; k < 5; ++k) {
        for (int j = 0; j < 140; ++j) {
          for (int i = 0; i < 180; ++i) {
            voxels.push_back(static_cast<float>(glm::dot(slope, geometry.to_patient({i, j, k}))));
          }
        }
      }
      volume->voxels = std::move(voxels);
      const double scale = default_gradient_scale_mm(geometry);
      EXPECT_GT(scale, 0.3);
      const GradientKernel kernel(volume, scale);
      std::array<glm::vec3, 1> found{};
      kernel.at_cell({{90, 70, 2}, {1, 1, 1}}, found);
      const bool far = slice_mm > 6 * scale;
      if (far && tilt > 0) continue;
      for (int axis = 0; axis < (far ? 2 : 3); ++axis) {
        EXPECT_NEAR(found[0][axis], slope[axis], 0.01) << slice_mm << " mm, tilt " << tilt << " axis " << axis;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
