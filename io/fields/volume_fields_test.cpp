#include "io/fields/volume_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "testdata/scan.h"

namespace palpate::io {
namespace {

using testdata::Grid;
constexpr FieldSet wanted = FieldSet::value | FieldSet::gradient;

std::shared_ptr<Volume> share(Volume volume) {
  return std::make_shared<Volume>(std::move(volume));
}

/// value = 7 + 3 x - 2 y + 5 z at every voxel's center.
std::shared_ptr<Volume> linear_volume(const Grid& grid) {
  Volume v;
  v.geometry = testdata::make_geometry(grid);
  std::vector<float> voxels;
  for (int k = 0; k < v.geometry.dimensions.z; ++k) {
    for (int j = 0; j < v.geometry.dimensions.y; ++j) {
      for (int i = 0; i < v.geometry.dimensions.x; ++i) {
        voxels.push_back(static_cast<float>(7 + glm::dot(Vec3(3, -2, 5), v.geometry.to_patient({i, j, k}))));
      }
    }
  }
  v.voxels = voxels;
  return share(std::move(v));
}

Grid small() {
  Grid grid;
  grid.size = {17, 15, 13};
  return grid;
}

TEST(VolumeFields, TrilinearValueIsExactAtEveryVoxelOfATiltedObliqueUnevenScan) {
  Grid grid = small();
  grid.spacing = {0.7, 0.9, 2.3};
  grid.tilt_degrees = 17;
  grid.uneven_mm = 0.5;
  grid.missing = {5};
  const auto volume = share(
      testdata::scan(testdata::make_sphere(5), testdata::make_geometry(rotated(grid, {3, 1, 2}, 40)), {.noise = 50}));
  const VolumeFields fields(volume, FieldSet::value, 0, {.value = ValueMethod::trilinear});
  const glm::ivec3 size = volume->geometry.dimensions;
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        const Sample s = fields.sample(volume->geometry.to_patient({i, j, k}), FieldSet::value);
        ASSERT_TRUE(s.inside);
        ASSERT_EQ(s.value, volume->value_at(i, j, k));
      }
    }
  }
}

TEST(VolumeFields, LinearFieldIsExactUpToTheEdgeWhateverTheGrid) {
  Grid plain = small();
  Grid tilted = rotated(small(), {1, 2, 3}, 50);
  tilted.tilt_degrees = 20;
  Grid uneven = tilted;
  uneven.uneven_mm = 0.4;
  uneven.missing = {4, 5};
  Grid thick = small();
  thick.spacing = {0.6, 0.8, 5};
  for (const Grid& grid : {plain, tilted, uneven, thick}) {
    const auto volume = linear_volume(grid);
    const VolumeFields fields(volume, wanted, default_gradient_scale_mm(volume->geometry));
    const Vec3 last(volume->geometry.dimensions - 1);
    for (const Vec3& at : {Vec3(0), Vec3(1), Vec3(0.5, 0.5, 0.5), Vec3(1, 0, 0.3), Vec3(0.25, 1, 0)}) {
      const Vec3 position = volume->geometry.to_patient(at * last);
      const Sample s = fields.sample(position, wanted);
      ASSERT_TRUE(s.inside);
      EXPECT_NEAR(s.value, 7 + glm::dot(Vec3(3, -2, 5), position), 1e-4);
      EXPECT_LT(glm::length(s.gradient - Vec3(3, -2, 5)), 2e-4);
    }
  }
}

TEST(VolumeFields, HomogeneousTissueHasNoGradientNotEvenARoundingError) {
  const auto volume = share(testdata::scan(testdata::Phantom{1234, {}}, testdata::make_geometry(small())));
  const VolumeFields fields(volume, wanted, 1.5);
  const Sample s = fields.sample({0.3, -0.2, 0.1}, wanted);
  EXPECT_EQ(s.value, 1234);
  EXPECT_EQ(s.gradient, Vec3(0));
  // Where the neighborhood ends at the edge, one of single precision remains: 1e-7 of the value.
  EXPECT_LT(glm::length(fields.sample({7, 6, 5.5}, wanted).gradient), 2e-4);
}

TEST(VolumeFields, NeitherTheEdgeNorPaddingNorAGapIsABoundary) {
  Grid grid = small();
  grid.size = {31, 31, 21};
  grid.missing = {10, 11, 12};
  const auto volume =
      share(testdata::scan(testdata::Phantom{1234, {}}, testdata::make_geometry(grid), {.circle_radius = 14}));
  const VolumeFields fields(volume, wanted, 2);
  int inside = 0;
  int outside = 0;
  for (int i = 0; i < 37; ++i) {
    for (int j = 0; j < 29; ++j) {
      for (int k = 0; k < 24; ++k) {
        const double x = -16 + 0.87 * i;
        const double y = -16 + 1.13 * j;
        const double z = -11 + 0.93 * k;
        const Sample s = fields.sample({x, y, z}, wanted);
        if (s.inside) {
          ++inside;
          ASSERT_NEAR(s.value, 1234, 1e-9);
          ASSERT_LT(glm::length(s.gradient), 0.01) << x << ' ' << y << ' ' << z;
          ASSERT_LE(std::hypot(x, y), 14 + 1e-9);
        } else {
          ++outside;
          ASSERT_EQ(s.value, 0);
          ASSERT_EQ(s.gradient, Vec3(0));
          // Cells that hold no voxel of padding are inside, unless slices are missing there.
          ASSERT_TRUE(std::hypot(x, y) > 14 - 1.5 || (z > -1 && z < 3) || std::abs(z) > 10)
              << x << ' ' << y << ' ' << z;
        }
      }
    }
  }
  EXPECT_GT(inside, 3000);
  EXPECT_GT(outside, 3000);
}

TEST(VolumeFields, NotANumberIsPadding) {
  auto volume = linear_volume(small());
  std::get<std::vector<float>>(volume->voxels)[volume->offset(8, 7, 6)] = std::numeric_limits<float>::quiet_NaN();
  const VolumeFields fields(volume, wanted, 1.5);
  EXPECT_FALSE(fields.sample(volume->geometry.to_patient({7.5, 7, 6}), wanted).inside);
  const Sample beside = fields.sample(volume->geometry.to_patient({7, 7, 6}), wanted);
  ASSERT_TRUE(beside.inside);
  EXPECT_LT(glm::length(beside.gradient - Vec3(3, -2, 5)), 1e-3);
}

TEST(VolumeFields, ASingleSliceHasAGradientInItsPlane) {
  Grid grid = small();
  grid.size.z = 1;
  const auto volume = linear_volume(grid);
  const VolumeFields fields(volume, wanted, 1.5);
  const Sample s = fields.sample(volume->geometry.to_patient({8.3, 7.1, 0}), wanted);
  ASSERT_TRUE(s.inside);
  EXPECT_LT(glm::length(s.gradient - Vec3(3, -2, 0)), 1e-3);
}

TEST(VolumeFields, TubeRunsAlongTheVesselOnEveryGrid) {
  const Vec3 axis = glm::normalize(Vec3(1, -2, 2));
  Grid straight;
  straight.size = {44, 44, 44};
  Grid tilted = rotated(straight, {1, 2, 3}, 50);
  tilted.tilt_degrees = 20;
  Grid thick = straight;
  thick.spacing.z = 2;
  thick.size.z = 22;
  for (const double lumen : {300.0, -200.0}) {  // brighter and darker than the tissue around
    for (const Grid& grid : {straight, tilted, thick}) {
      const auto volume =
          share(testdata::scan(testdata::make_tube(3, axis, lumen), testdata::make_geometry(grid), {.noise = 10}));
      const VolumeFields fields(volume, FieldSet::tube, 2);
      for (const double along : {-7.3, 0.0, 5.1}) {
        for (const Vec3& off : {Vec3(0), 0.8 * glm::normalize(glm::cross(axis, Vec3(1, 0, 0)))}) {
          const Sample s = fields.sample(along * axis + off, FieldSet::tube);
          ASSERT_TRUE(s.inside);
          EXPECT_NEAR(glm::length(s.tube), 1, 1e-12);
          EXPECT_GT(std::abs(glm::dot(s.tube, axis)), std::cos(0.06));  // 3.4 degrees
        }
      }
    }
  }
}

TEST(VolumeFields, TubeIsZeroWhereNothingCurvesOrTheNeighborhoodEnds) {
  const auto volume = share(testdata::scan(testdata::Phantom{40, {}}, testdata::make_geometry(small())));
  const VolumeFields fields(volume, FieldSet::tube, 1);
  EXPECT_EQ(fields.sample({0, 0, 0}, FieldSet::tube).tube, Vec3(0));
  const auto vessel = share(testdata::scan(testdata::make_tube(3, {0, 0, 1}), testdata::make_geometry(small())));
  EXPECT_NE(VolumeFields(vessel, FieldSet::tube, 1).sample({0, 0, 0}, FieldSet::tube).tube, Vec3(0));
  EXPECT_EQ(VolumeFields(vessel, FieldSet::tube, 1).sample({7.5, 0, 0}, FieldSet::tube).tube, Vec3(0));
}

TEST(VolumeFields, CubicSplineIsExactOnLinearFieldsUpToTheEdgeAndBesidePadding) {
  Grid plain = small();
  Grid tilted = rotated(small(), {1, 2, 3}, 50);
  tilted.tilt_degrees = 20;
  Grid thick = small();
  thick.spacing = {0.6, 0.8, 5};
  for (const Grid& grid : {plain, tilted, thick}) {
    const auto volume = linear_volume(grid);
    std::get<std::vector<float>>(volume->voxels)[volume->offset(8, 7, 6)] = std::numeric_limits<float>::quiet_NaN();
    const VolumeFields fields(volume, wanted, 0, {.gradient = GradientMethod::cubic});
    const Vec3 last(volume->geometry.dimensions - 1);
    for (const Vec3& at : {Vec3(0), last, Vec3(0.5), last - 0.25, Vec3(6.5, 7, 6), Vec3(9, 7, 6), Vec3(9.4, 6.3, 5.2),
                           Vec3(8, 8.5, 6)}) {
      const Vec3 position = volume->geometry.to_patient(at);
      const Sample s = fields.sample(position, wanted);
      ASSERT_TRUE(s.inside);
      EXPECT_NEAR(s.value, 7 + glm::dot(Vec3(3, -2, 5), position), 1e-4);
      EXPECT_LT(glm::length(s.gradient - Vec3(3, -2, 5)), 2e-4);
    }
    EXPECT_EQ(fields.memory_bytes(), 0U);
  }
}

TEST(VolumeFields, CubicSplineGivesTheGradientOfItsOwnValue) {
  Grid tilted = rotated(small(), {1, 2, 3}, 50);
  tilted.tilt_degrees = 20;
  const auto volume = share(testdata::scan(testdata::make_sphere(5), testdata::make_geometry(tilted), {.noise = 100}));
  const VolumeFields fields(volume, wanted, 0, {.gradient = GradientMethod::cubic});
  for (int n = 0; n < 50; ++n) {
    const Vec3 at(0.07 * n - 2, 0.05 * n - 1.5, 0.03 * n - 1);
    constexpr double h = 1e-4;
    Vec3 expected;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 step(0);
      step[axis] = h;
      expected[axis] = (fields.sample(at + step, wanted).value - fields.sample(at - step, wanted).value) / (2 * h);
    }
    EXPECT_LT(glm::length(fields.sample(at, wanted).gradient - expected), 1e-3 + 1e-4 * glm::length(expected));
  }
}

TEST(VolumeFields, CubicSplineDoesNotReachAcrossMissingSlices) {
  Grid grid = small();
  grid.missing = {6, 7};
  auto volume = linear_volume(grid);
  auto& voxels = std::get<std::vector<float>>(volume->voxels);
  for (std::size_t n = volume->offset(0, 0, 6); n < voxels.size(); ++n) voxels[n] += 1000;  // beyond the gap
  const VolumeFields fields(volume, wanted, 0, {.gradient = GradientMethod::cubic});
  for (const double k : {4.6, 5.0, 6.0, 6.3}) {
    const Vec3 at = volume->geometry.to_patient({8, 7, k});
    const Sample s = fields.sample(at, wanted);
    ASSERT_TRUE(s.inside);
    EXPECT_NEAR(s.value, 7 + glm::dot(Vec3(3, -2, 5), at) + (k < 5.5 ? 0 : 1000), 1e-3) << k;
    EXPECT_NEAR(s.gradient.x, 3, 1e-3) << k;
    EXPECT_NEAR(s.gradient.y, -2, 1e-3) << k;
  }
}

TEST(VolumeFields, CentralDifferencesServeEveryFieldThatNeedsGradients) {
  const auto volume = share(testdata::scan(testdata::make_tube(3, {0, 0, 1}), testdata::make_geometry(small())));
  constexpr FieldSet all = wanted | FieldSet::low_high | FieldSet::tube;
  const FieldOptions central{.gradient = GradientMethod::central_differences, .background = false};
  const VolumeFields fields(volume, all, 1, central);
  const Vec3 at(2.9, 0.3, 0.2);
  const Sample missing = fields.sample(at, all);
  fields.prepare(at, 1);
  const Sample s = fields.sample(at, all);
  EXPECT_TRUE(s.from_brick);
  EXPECT_EQ(s.gradient, missing.gradient);
  EXPECT_EQ(s.tube, missing.tube);
  EXPECT_NEAR(std::abs(s.tube.z), 1, 1e-3);
  EXPECT_LT(s.gradient.x, -50);
  EXPECT_NEAR(s.low, 40, 5);
  EXPECT_NEAR(s.high, 300, 5);
}

// A linear field of vectors is exact, with whatever method values and gradients are taken.
TEST(VolumeFields, VectorsAreThereWithEveryMethod) {
  const auto volume = linear_volume(small());
  auto vectors = std::make_shared<VectorComponents>();
  vectors->to_patient = glm::dmat3(0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1);
  for (std::size_t n = 0; n < 3; ++n) {
    Volume component = *volume;
    component.slope = 0.01 * (static_cast<double>(n) + 1);
    component.intercept = static_cast<double>(n) - 1;
    vectors->along[n] = share(std::move(component));
  }
  volume->vectors = vectors;
  constexpr FieldSet all = wanted | FieldSet::vector;
  for (const GradientMethod gradient :
       {GradientMethod::gaussian, GradientMethod::central_differences, GradientMethod::cubic}) {
    for (const ValueMethod value : {ValueMethod::cubic, ValueMethod::trilinear}) {
      const VolumeFields fields(volume, all, 1.5, {.gradient = gradient, .value = value});
      for (const Vec3& at : {Vec3(0.2, -0.3, 0.4), Vec3(-5, 3.1, 2.2), Vec3(6.5, -6, -4.7)}) {
        const double along = 7 + glm::dot(Vec3(3, -2, 5), at);
        const Vec3 expected = vectors->to_patient * Vec3(0.01 * along - 1, 0.02 * along, 0.03 * along + 1);
        for (const FieldSet asked : {all, FieldSet::vector}) {
          EXPECT_LT(glm::distance(fields.sample(at, asked).vector, expected), 1e-5);
        }
        EXPECT_EQ(fields.sample(at, wanted).vector, Vec3(0)) << "nobody asked";
      }
    }
  }
}

// Slices may be missing anywhere, and the first or the last may be alone behind them.
TEST(VolumeFields, EverySliceIsInsideAndNoGapIs) {
  const int slices = small().size.z;
  for (int gap = 0; gap + 1 < slices; ++gap) {
    for (const int other : {gap, 0, slices - 2}) {
      const auto volume = linear_volume(small());
      volume->geometry.gaps = {std::min(gap, other), std::max(gap, other)};
      const VolumeFields fields(volume, FieldSet::value, 0, {.value = ValueMethod::trilinear});
      for (int k = 0; k < slices; ++k) {
        const Vec3 on = volume->geometry.to_patient({8.3, 7.1, k});
        const Sample s = fields.sample(on, FieldSet::value);
        ASSERT_TRUE(s.inside) << "slice " << k << ", gap " << gap;
        EXPECT_NEAR(s.value, 7 + glm::dot(Vec3(3, -2, 5), on), 1e-4);
        if (k + 1 == slices) continue;
        for (const double part : {0.01, 0.5, 0.99}) {
          const Vec3 between = volume->geometry.to_patient({8.3, 7.1, k + part});
          EXPECT_EQ(fields.sample(between, FieldSet::value).inside, k != gap && k != other) << k << ", gap " << gap;
        }
      }
    }
  }
}

TEST(VolumeFields, GivesAndPreparesOnlyWhatIsWanted) {
  const auto volume = linear_volume(small());
  const VolumeFields value_only(volume, FieldSet::value, -1);
  EXPECT_EQ(value_only.available(), FieldSet::value);
  EXPECT_EQ(value_only.sample({0, 0, 0}, wanted).gradient, Vec3(0));
  EXPECT_EQ(value_only.memory_bytes(), 0U);
  const VolumeFields fields(volume, wanted, 1.5);
  EXPECT_EQ(fields.sample({0, 0, 0}, FieldSet::gradient).value, 0);
}

TEST(VolumeFields, RefusesWhatItCannotGive) {
  const auto volume = linear_volume(small());
  EXPECT_THROW(VolumeFields(nullptr, wanted, 2), std::logic_error);
  EXPECT_THROW(VolumeFields(volume, wanted, 0), std::invalid_argument);
  EXPECT_THROW(VolumeFields(volume, wanted, 1000), std::invalid_argument);
  EXPECT_THROW(VolumeFields(volume, FieldSet::vector, 2), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::io
