#include "io/fields/filtered.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "io/fields/testing/odd_scan.h"
#include "io/fields/volume_fields.h"
#include "io/messages.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

TEST(Filtered, APartHasTheSameBitsAsTheWhole) {
  const auto raw = odd_scan();
  const std::size_t stride = 41UL * 37;
  for (const Filter& filter : filters) {
    const auto whole = filtered(raw, filter);
    const auto& values = std::get<std::vector<float>>(whole->voxels);
    for (const auto& [first, last] : {std::pair{0, 0}, {3, 20}, {15, 18}, {37, 37}}) {
      const std::vector<float> part = filtered_slices(*raw, filter, first, last);
      ASSERT_EQ(part.size(), stride * static_cast<std::size_t>(last - first + 1));
      EXPECT_TRUE(std::equal(part.begin(), part.end(), values.begin() + static_cast<std::ptrdiff_t>(stride) * first))
          << in_words(filter) << ", slices " << first << " to " << last;
    }
  }
}

TEST(Filtered, FiltersTheRawValuesAndNeverTwice) {
  const auto raw = odd_scan();
  const auto once = filtered(raw, filters[0]);
  EXPECT_EQ(filtered(once, filters[0]), once);
  EXPECT_EQ(filtered(once, {}), raw);
  EXPECT_EQ(filtered(raw, {}), raw);
  const auto other = filtered(once, filters[1]);
  EXPECT_EQ(other->filtered_from->raw, raw);
  EXPECT_EQ(std::get<std::vector<float>>(other->voxels),
            std::get<std::vector<float>>(filtered(raw, filters[1])->voxels));
}

TEST(Filtered, IsTheSameScanBesideItsValues) {
  Volume scan = *odd_scan();
  scan.unit = "HU";
  scan.modality = "CT";
  scan.frame_of_reference_uid = "1.2.3";
  scan.warnings = {say("no-readable-images")};
  const auto smooth = filtered(std::make_shared<const Volume>(scan), filters[0]);
  EXPECT_EQ(smooth->unit, "HU");
  EXPECT_EQ(smooth->modality, "CT");
  EXPECT_EQ(smooth->frame_of_reference_uid, "1.2.3");
  EXPECT_EQ(smooth->warnings, scan.warnings);
  EXPECT_EQ(smooth->geometry.gaps, scan.geometry.gaps);
  EXPECT_EQ(smooth->geometry.slice_positions, scan.geometry.slice_positions);
  EXPECT_EQ(filter_of(*smooth), filters[0]);
}

TEST(Filtered, LeavesPaddingAndItsEdgeAlone) {
  const auto raw = odd_scan(0);
  const glm::ivec3 size = raw->geometry.dimensions;
  for (const Filter& filter : filters) {
    const auto smooth = filtered(raw, filter);
    for (int k = 0; k < size.z; ++k) {
      for (int j = 0; j < size.y; ++j) {
        for (int i = 0; i < size.x; ++i) {
          ASSERT_EQ(smooth->is_padding(i, j, k), raw->is_padding(i, j, k)) << in_words(filter);
          if (raw->is_padding(i, j, k)) ASSERT_EQ(at(*smooth, i, j, k), at(*raw, i, j, k));
          // Nothing below what was scanned: padding is far below, and does not come in from the sides.
          else
            ASSERT_GE(at(*smooth, i, j, k), -1000.01) << in_words(filter);
        }
      }
    }
  }
}

TEST(Filtered, GaussianKeepsASlopeAndTakesThePartOfTheNoiseThatItsWidthSays) {
  testdata::Grid grid;
  grid.size = {48, 40, 36};
  grid.spacing = {0.8, 1.1, 1.5};
  const Geometry geometry = testdata::make_geometry(grid);
  const Filter filter{.type = find_filter_type("gaussian"), .sigma_mm = 1.9};
  const Vec3 slope(3, -5, 7);
  const auto ramp = filtered(painted(geometry, [&](const Vec3& p) { return glm::dot(slope, p) + 40; }), filter);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, 50);
  const auto noise = filtered(painted(geometry, [&](const Vec3&) { return normal(random); }), filter);
  double sum = 0, count = 0;
  for (int k = 5; k < 31; ++k) {
    for (int j = 7; j < 33; ++j) {
      for (int i = 9; i < 39; ++i) {
        ASSERT_NEAR(at(*ramp, i, j, k), glm::dot(slope, geometry.to_patient({i, j, k})) + 40, 1e-3);
        sum += at(*noise, i, j, k) * at(*noise, i, j, k);
        ++count;
      }
    }
  }
  // White noise through a Gaussian: each axis leaves spacing / (2 sqrt(pi) sigma) of the variance.
  const double axis = 2 * std::sqrt(std::numbers::pi) * filter.sigma_mm;
  const double expected = 50 * std::sqrt(0.8 / axis * 1.1 / axis * 1.5 / axis);
  EXPECT_NEAR(std::sqrt(sum / count) / expected, 1, 0.08);
}

TEST(Filtered, GaussianSpreadsAlikeAlongAllAxes) {
  testdata::Grid grid;
  grid.size = {41, 41, 41};
  grid.spacing = {0.5, 0.8, 1.1};
  const Geometry geometry = testdata::make_geometry(grid);
  const Vec3 middle = geometry.to_patient({20, 20, 20});
  const auto spike =
      filtered(painted(geometry, [&](const Vec3& p) { return glm::distance(p, middle) < 0.1 ? 1e4 : 0; }),
               {.type = find_filter_type("gaussian"), .sigma_mm = 2});
  Vec3 variance(0);
  double sum = 0;
  for (int k = 0; k < 41; ++k) {
    for (int j = 0; j < 41; ++j) {
      for (int i = 0; i < 41; ++i) {
        const Vec3 away = geometry.to_patient({i, j, k}) - middle;
        variance += at(*spike, i, j, k) * away * away;
        sum += at(*spike, i, j, k);
      }
    }
  }
  EXPECT_NEAR(sum, 1e4, 1);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(std::sqrt(variance[axis] / sum), 2, 0.05) << axis;  // cut off at three standard deviations
  }
}

TEST(Filtered, GaussianCountsASliceForTheRoomThatItHas) {
  Geometry geometry;
  geometry.dimensions = {4, 4, 50};
  for (double z = -14; z < -0.2; z += 0.4) geometry.slice_positions.emplace_back(0, 0, z);
  const int change = static_cast<int>(geometry.slice_positions.size());
  for (double z = 0; static_cast<int>(geometry.slice_positions.size()) < geometry.dimensions.z; z += 1.6) {
    geometry.slice_positions.emplace_back(0, 0, z);
  }
  geometry.uniform = false;
  const auto ramp = filtered(painted(geometry, [](const Vec3& p) { return 100 * p.z; }),
                             {.type = find_filter_type("gaussian"), .sigma_mm = 2});
  // Where dense slices end, counting slices alone would draw the mean towards them, by about a millimeter.
  EXPECT_NEAR(at(*ramp, 2, 2, change) / 100, geometry.slice_positions[static_cast<std::size_t>(change)].z, 0.1);
}

TEST(Filtered, NothingComesAcrossMissingSlices) {
  testdata::Grid grid;
  grid.size = {8, 8, 12};
  grid.missing = {6};
  const Geometry geometry = testdata::make_geometry(grid);
  const double between = geometry.slice_positions[6].z;  // the first slice behind the gap
  const auto steps = filtered(painted(geometry, [&](const Vec3& p) { return p.z < between - 0.5 ? 0 : 100; }),
                              {.type = find_filter_type("gaussian"), .sigma_mm = 2});
  EXPECT_NEAR(at(*steps, 4, 4, 5), 0, 1e-3);
  EXPECT_NEAR(at(*steps, 4, 4, 6), 100, 1e-3);
}

TEST(Filtered, MedianIsTheMiddleOfItsSquare) {
  const auto raw = odd_scan();
  for (const int width : {3, 5}) {
    const auto smooth = filtered(raw, {.type = find_filter_type("median"), .width = width});
    const int r = width / 2;
    for (int k = 0; k < 40 - 2; k += 7) {
      for (int j = 15; j < 22; ++j) {
        for (int i = 15; i < 26; ++i) {
          std::vector<double> near;
          for (int y = -r; y <= r; ++y) {
            for (int x = -r; x <= r; ++x) near.push_back(at(*raw, i + x, j + y, k));
          }
          std::ranges::nth_element(near, near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2));
          ASSERT_EQ(at(*smooth, i, j, k), near[near.size() / 2]);
        }
      }
    }
  }
}

/// The definition: the mean of the voxels within two standard deviations, which are rounded up to whole voxels,
/// weighted by their distance in voxels of the same area and by how much they differ.
TEST(Filtered, BilateralIsTheMeanOfWhatIsNearAndAlike) {
  const auto raw = odd_scan();
  constexpr double sigma_mm = 1.3, sigma_value = 60;
  const auto smooth =
      filtered(raw, {.type = find_filter_type("bilateral"), .sigma_mm = sigma_mm, .sigma_value = sigma_value});
  const double sigma = sigma_mm / std::sqrt(raw->geometry.spacing_i * raw->geometry.spacing_j);
  const int radius = static_cast<int>(std::ceil(2 * sigma));
  for (int k = 0; k < 40 - 2; k += 7) {
    for (int j = 15; j < 22; ++j) {
      for (int i = 15; i < 26; ++i) {
        const double here = at(*raw, i, j, k);
        double sum = 0, weights = 0;
        for (int y = -radius; y <= radius; ++y) {
          for (int x = -radius; x <= radius; ++x) {
            const double squared = x * x + y * y, there = at(*raw, i + x, j + y, k);
            if (squared > radius * radius) continue;
            const double differs = (there - here) / sigma_value;
            const double weight = std::exp(-0.5 * squared / (sigma * sigma) - 0.5 * differs * differs);
            sum += weight * there;
            weights += weight;
          }
        }
        ASSERT_NEAR(at(*smooth, i, j, k), sum / weights, 0.05) << i << ' ' << j << ' ' << k;
      }
    }
  }
}

/// Of noise alone nearly the mean of the 15 x 15 voxels around is left: that has a fifteenth of the noise, and that of
/// a smaller square more.
TEST(Filtered, NonLocalMeansTakesWhatIsAlikeFromSevenVoxelsAround) {
  testdata::Grid grid;
  grid.size = {96, 96, 1};
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 20);
  const auto raw = painted(testdata::make_geometry(grid), [&](const Vec3&) { return normal(random); });
  const auto smooth = filtered(raw, {.type = find_filter_type("non_local_means"), .sigma_value = 20});
  double before = 0, after = 0;
  for (int j = 10; j < 86; ++j) {
    for (int i = 10; i < 86; ++i) {
      before += at(*raw, i, j, 0) * at(*raw, i, j, 0);
      after += at(*smooth, i, j, 0) * at(*smooth, i, j, 0);
    }
  }
  EXPECT_LT(std::sqrt(after / before), 0.1);
}

/// However far apart the values are, and however small what is taken for noise.
TEST(Filtered, NonLocalMeansKeepsValuesThatAreFarApart) {
  testdata::Grid grid;
  grid.size = {32, 32, 1};
  const Geometry geometry = testdata::make_geometry(grid);
  const double wall = geometry.to_patient({15.5, 0, 0}).x;
  for (const double high : {40.0, 5000.0, 60000.0}) {
    const auto raw = painted(geometry, [&](const Vec3& p) { return p.x < wall ? -300 : high; });
    const auto smooth = filtered(raw, {.type = find_filter_type("non_local_means"), .sigma_value = 1});
    for (int j = 0; j < 32; ++j) {
      for (int i = 0; i < 32; ++i) ASSERT_NEAR(at(*smooth, i, j, 0), at(*raw, i, j, 0), 1) << high;
    }
  }
}

/// Where a slope turns values round, it turns the padding's range round as well.
TEST(Filtered, PaddingStaysWhatItIsUnderASlopeOfEitherSign) {
  for (const double slope : {2.0, -2.0}) {
    Volume v;
    v.geometry.dimensions = {6, 5, 2};
    v.geometry.slice_positions = {{0, 0, 0}, {0, 0, 1}};
    std::vector<std::int16_t> voxels;
    for (int n = 0; n < 60; ++n) voxels.push_back(static_cast<std::int16_t>(n % 7 == 0 ? -2000 - n % 3 : n));
    v.voxels = std::move(voxels);
    v.slope = slope;
    v.intercept = 5;
    v.padding = {-2002, -2000};
    const auto raw = std::make_shared<const Volume>(v);
    for (const Filter& filter : filters) {
      const auto smooth = filtered(raw, filter);
      ASSERT_TRUE(smooth->padding);
      EXPECT_EQ(smooth->padding->first, slope * (slope > 0 ? -2002 : -2000) + 5);
      EXPECT_EQ(smooth->padding->second, slope * (slope > 0 ? -2000 : -2002) + 5);
      for (int n = 0; n < 60; ++n) {
        const int i = n % 6, j = n / 6 % 5, k = n / 30;
        EXPECT_EQ(smooth->is_padding(i, j, k), n % 7 == 0) << in_words(filter) << ' ' << n;
        if (n % 7 == 0) {
          EXPECT_EQ(at(*smooth, i, j, k), at(*raw, i, j, k));
        }
      }
    }
  }
}

/// Noise on both sides of a wall, and where the wall's middle value is met in each row.
TEST(Filtered, EdgePreservingFiltersTakeNoiseAndLeaveAWallWhereItIs) {
  testdata::Grid grid;
  grid.size = {48, 48, 3};
  const Geometry geometry = testdata::make_geometry(grid);
  const double wall = geometry.to_patient({23.5, 0, 0}).x;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 20);
  const auto raw = painted(geometry, [&](const Vec3& p) { return (p.x < wall ? 0 : 400) + normal(random); });
  for (const Filter& filter : {Filter{.type = find_filter_type("bilateral"), .sigma_mm = 2, .sigma_value = 80},
                               Filter{.type = find_filter_type("non_local_means"), .sigma_value = 20},
                               Filter{.type = find_filter_type("median"), .width = 5}}) {
    const auto smooth = filtered(raw, filter);
    double before = 0, after = 0;
    for (int j = 4; j < 44; ++j) {
      for (int i = 4; i < 18; ++i) {
        before += at(*raw, i, j, 1) * at(*raw, i, j, 1);
        after += at(*smooth, i, j, 1) * at(*smooth, i, j, 1);
      }
      EXPECT_LT(at(*smooth, 23, j, 1), 100) << in_words(filter);
      EXPECT_GT(at(*smooth, 24, j, 1), 300) << in_words(filter);
    }
    EXPECT_LT(std::sqrt(after / before), 0.5) << in_words(filter);
  }
}

TEST(Filtered, RefusesWhatCannotBeAndVelocity) {
  const auto raw = odd_scan();
  for (const Filter& filter : {Filter{.type = find_filter_type("gaussian"), .sigma_mm = 0},
                               Filter{.type = find_filter_type("gaussian"), .sigma_mm = std::nan("")},
                               Filter{.type = find_filter_type("bilateral"), .sigma_mm = 1, .sigma_value = -1},
                               Filter{.type = find_filter_type("bilateral"), .sigma_mm = 11, .sigma_value = 1},
                               Filter{.type = find_filter_type("non_local_means"), .sigma_value = 0},
                               Filter{.type = find_filter_type("median"), .width = 4}}) {
    EXPECT_THROW(filtered(raw, filter), std::invalid_argument) << in_words(filter);
  }
  Volume flow = *raw;
  flow.vectors = std::make_shared<const VectorComponents>();
  try {
    filtered(std::make_shared<const Volume>(flow), filters[0]);
    ADD_FAILURE() << "a velocity field was filtered";
  } catch (const std::invalid_argument& refused) {
    EXPECT_STREQ(refused.what(),
                 "a velocity field is not filtered: its vectors are felt as they were measured; take the filter out of "
                 "the scene");
  }
}

TEST(Filtered, FiltersAreTheSameWhereWhatTheyReadIs) {
  EXPECT_EQ((Filter{.type = find_filter_type("median"), .sigma_mm = 1}),
            (Filter{.type = find_filter_type("median"), .sigma_mm = 2}));
  EXPECT_NE((Filter{.type = find_filter_type("median"), .width = 3}),
            (Filter{.type = find_filter_type("median"), .width = 5}));
  EXPECT_NE((Filter{.type = find_filter_type("gaussian"), .sigma_mm = 1}),
            (Filter{.type = find_filter_type("gaussian"), .sigma_mm = 2}));
  EXPECT_NE((Filter{.type = find_filter_type("bilateral"), .sigma_value = 1}),
            (Filter{.type = find_filter_type("bilateral"), .sigma_value = 2}));
  EXPECT_NE((Filter{}), filters[0]);
}

}  // namespace
}  // namespace palpate::io
