/// Each part of a boundary's uncertainty, for analytic values on grids that are oblique, tilted and not square.
/// boundary_uncertainty_test.cpp checks that all parts together cover the truth.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "io/fields/boundary_uncertainty.h"
#include "io/testing/formula_boundary.h"

namespace palpate::io {
namespace {

using testing::any_unit;
using testing::blurred_step;
using testing::FormulaSource;
using testing::tilted_boundary;
using testing::TiltedBoundary;

double trace(const glm::dmat3& m) {
  return m[0][0] + m[1][1] + m[2][2];
}

/// The mean over the directions a of a plane of (a.A a) (a.B a), of matrices that lie in it.
double mean_of_product(const glm::dmat3& a, const glm::dmat3& b) {
  return (trace(a) * trace(b) + 2 * trace(a * b)) / 8;
}

/// A voxel's extent along a unit direction is the root of this form.
glm::dmat3 extent_form(const Geometry& g, double across_slices) {
  const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
  return g.spacing_i * g.spacing_i * glm::outerProduct(g.direction_i, g.direction_i) +
         g.spacing_j * g.spacing_j * glm::outerProduct(g.direction_j, g.direction_j) +
         across_slices * across_slices * glm::outerProduct(normal, normal);
}

constexpr double box = 1.0 / 12, hat = 1.0 / 6, spline = 0.58 * 0.58;  // variances of blur, voxels squared

TEST(BoundaryUncertaintyLaws, CurvatureShiftsByTheVarianceOfTheBlurAlongEachTangent) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const TiltedBoundary b = tilted_boundary(seed);
    std::mt19937 random(seed + 1000);
    const Vec3 one = any_unit(random), other = any_unit(random);
    const double slope = 70;
    // Bent in two directions by different radii, and not at all across the boundary.
    const glm::dmat3 bend =
        b.tangent * (0.03 * glm::outerProduct(one, one) - 0.013 * glm::outerProduct(other, other)) * b.tangent;
    FormulaSource source;
    source.gradient = 0.2 * b.normal;
    double blur_mm = 1;
    source.value = [&](const Vec3& at) {
      const Vec3 away = at - b.place;
      return 40 + slope * blurred_step(glm::dot(b.normal, away) + 0.5 * glm::dot(away, bend * away) / slope, blur_mm);
    };
    const Geometry& g = b.geometry;
    const glm::dmat3 voxel = b.tangent * extent_form(g, g.slice_spacing()) * b.tangent;
    const glm::dmat3 in_slice = b.tangent * extent_form(g, 0) * b.tangent;
    const Filter gaussian{.type = find_filter_type("gaussian"), .sigma_mm = 1.7};
    const Filter median{.type = find_filter_type("median"), .sigma_mm = 1.7, .width = 5};
    const Filter bilateral{.type = find_filter_type("bilateral"), .sigma_mm = 1.7, .width = 5};
    const double along_normal = glm::dot(b.normal, extent_form(g, g.slice_spacing()) * b.normal);
    const auto expect = [&](ValueMethod method, const Filter& filter, double mean) {
      // As wide as voxel, interpolation and filter make it: nothing is left for the scanner.
      const double of_filter = filter.type->blur == nullptr ? 0 : filter.type->blur(g, filter, b.normal);
      blur_mm = std::sqrt((method == ValueMethod::cubic ? box + spline : box + hat) * along_normal + of_filter);
      const BoundaryUncertainty known = uncertainty_at(source, g, method, b.place, filter);
      EXPECT_NEAR(known.slope, slope, 0.05 * slope) << seed;
      EXPECT_NEAR(known.curvature_mm, -mean / slope, 0.08 * std::abs(mean / slope) + 1e-5) << seed;
      EXPECT_NEAR(known.noise_mm, 0, 1e-4) << seed;
      EXPECT_NEAR(known.level_mm, 0, 0.02 * blur_mm) << seed;
      EXPECT_NEAR(known.two_sigma_mm, 1.96 * known.sampling_mm,
                  0.07 * known.sampling_mm + 2 * std::abs(mean) / slope + 0.02 * blur_mm)
          << seed;
    };
    const double hats = (box + hat) * mean_of_product(voxel, bend);
    expect(ValueMethod::cubic, bilateral, (box + spline) * mean_of_product(voxel, bend));
    expect(ValueMethod::trilinear, bilateral, hats);
    expect(ValueMethod::trilinear, gaussian, hats + 1.7 * 1.7 * trace(bend) / 2);
    expect(ValueMethod::trilinear, median, hats + 25.0 / 12 * mean_of_product(in_slice, bend));
  }
}

/// A plate that is thinner than the blur does not reach its value, and what lies behind it may be anything.
TEST(BoundaryUncertaintyLaws, AThinPlatesEdgeIsWithinWhatIsStated) {
  int stated = 0, within = 0, thick_stated = 0, thick = 0;
  double widest = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const TiltedBoundary b = tilted_boundary(seed);
    std::mt19937 random(seed + 1000);
    std::uniform_real_distribution<double> even(0, 1);
    const double first = 40, plate = 700, behind = first + even(random) * 0.4 * (plate - first);
    const Geometry& g = b.geometry;
    const double blur_mm = std::sqrt((box + spline) * glm::dot(b.normal, extent_form(g, g.slice_spacing()) * b.normal));
    const double thickness = (1.7 + 5 * even(random)) * blur_mm, away = (even(random) - 0.5) * blur_mm;
    const auto part = [&](double mm) { return 0.5 * (1 + std::erf(mm / (std::numbers::sqrt2 * blur_mm))); };
    FormulaSource source;
    source.gradient = b.normal;
    source.value = [&](const Vec3& at) {
      const double mm = glm::dot(b.normal, at - b.place) - away;  // from the plate's first face
      return first + (plate - first) * part(mm) + (behind - plate) * part(mm - thickness);
    };
    const BoundaryUncertainty known = uncertainty_at(source, g, ValueMethod::cubic, b.place);
    thick += thickness > 5 * blur_mm;
    if (!std::isfinite(known.two_sigma_mm)) continue;
    thick_stated += thickness > 5 * blur_mm;
    ++stated;
    within += std::abs(away) <= known.two_sigma_mm;
    widest = std::max(widest, known.two_sigma_mm / blur_mm);
  }
  EXPECT_GT(within, 0.97 * stated) << "of " << stated;
  EXPECT_GT(stated, 380);
  EXPECT_EQ(thick_stated, thick);
  EXPECT_LT(widest, 1.5);
}

/// Phases of the axes, as measured, in voxels; they add as noise does.
TEST(BoundaryUncertaintyLaws, ThePhaseIsThatOfTheAxesThatTheBoundaryLiesAcross) {
  constexpr double fine = 0.02, coarse = 0.05, linear = 0.04;
  for (int longest = 0; longest < 3; ++longest) {
    for (const double length : {1.5, 1.6, 4.0}) {
      Vec3 spacing(1, 1.25, 1.125);
      spacing[longest] = length;
      spacing[(longest + 1) % 3] = 1;
      Geometry g;
      g.dimensions = {60, 60, 60};
      g.direction_i = {0, 1, 0};
      g.direction_j = {0, 0, 1};  // so that the slices ascend along x
      g.spacing_i = spacing.x;
      g.spacing_j = spacing.y;
      g.step = {spacing.z, 0, 0};
      for (int k = 0; k < 60; ++k) g.slice_positions.push_back(static_cast<double>(k) * g.step);
      const std::array axes{g.direction_i, g.direction_j, Vec3(1, 0, 0)};
      for (const Vec3& weights : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.48, 0.64, 0.6)}) {
        FormulaSource source;
        source.gradient = weights.x * axes[0] + weights.y * axes[1] + weights.z * axes[2];
        source.value = [&](const Vec3& at) { return glm::dot(source.gradient, at); };
        Vec3 cubic, trilinear;
        for (int axis = 0; axis < 3; ++axis) {
          const double part = weights[axis] * spacing[axis];
          cubic[axis] = part * (axis == longest && length > 1.5 ? coarse : fine);
          trilinear[axis] = part * linear;
        }
        const auto phase = [&](ValueMethod method) {
          return uncertainty_at(source, g, method, g.to_patient({30, 30, 30})).sampling_mm;
        };
        EXPECT_NEAR(phase(ValueMethod::cubic), glm::length(cubic), 1e-12) << longest << ' ' << length;
        EXPECT_NEAR(phase(ValueMethod::trilinear), glm::length(trilinear), 1e-12) << longest << ' ' << length;
      }
    }
  }
}

/// Blur leaves the middle of two sides where it is; a boundary that is felt at another value lies beside it.
TEST(BoundaryUncertaintyLaws, AnotherValueThanTheMiddleIsSaidByItsDistance) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const TiltedBoundary b = tilted_boundary(seed);
    const double blur_mm =
        std::sqrt(0.4 * glm::dot(b.normal, extent_form(b.geometry, b.geometry.slice_spacing()) * b.normal));
    for (const double offset : {-1.2, -0.5, 0.0, 0.3, 1.0}) {
      FormulaSource source;
      source.gradient = 20.0 * b.normal;
      source.value = [&](const Vec3& at) {
        return 100 * blurred_step(glm::dot(b.normal, at - b.place) + offset * blur_mm, blur_mm);
      };
      const BoundaryUncertainty known = uncertainty_at(source, b.geometry, ValueMethod::cubic, b.place);
      EXPECT_NEAR(known.level_mm, offset * blur_mm, 0.05 * blur_mm) << seed << ' ' << offset;
      EXPECT_GT(known.two_sigma_mm, 0.97 * std::abs(known.level_mm)) << seed << ' ' << offset;
    }
  }
}

/// Nothing beyond 8 mm is stated, whatever was found there.
TEST(BoundaryUncertaintyLaws, MoreThanTheMostThatIsStatedIsUnknown) {
  constexpr double most_mm = 8, blur_mm = 8;
  Geometry g;
  g.dimensions = {60, 60, 60};
  g.spacing_i = g.spacing_j = 3;
  g.step = {0, 0, 3};
  for (int k = 0; k < 60; ++k) g.slice_positions.push_back(static_cast<double>(k) * g.step);
  const Vec3 place = g.to_patient({30.2, 30.1, 30.3}), normal = glm::normalize(Vec3(0.4, -0.7, 0.5));
  for (const double offset_mm : {-11.0, -9.0, -7.0, -3.0, 0.0, 3.0, 7.0, 9.0, 11.0}) {
    FormulaSource source;
    source.gradient = normal;
    source.value = [&](const Vec3& at) {
      return 100 * blurred_step(glm::dot(normal, at - place) + offset_mm, blur_mm);
    };
    const BoundaryUncertainty known = uncertainty_at(source, g, ValueMethod::cubic, place);
    EXPECT_NEAR(known.level_mm, offset_mm, 0.05 * blur_mm) << "the edge itself is found";
    if (std::abs(offset_mm) > most_mm) {
      EXPECT_EQ(known.two_sigma_mm, std::numeric_limits<double>::infinity()) << offset_mm;
    } else {
      EXPECT_GT(known.two_sigma_mm, 0.97 * std::abs(known.level_mm));
      EXPECT_LE(known.two_sigma_mm, most_mm) << offset_mm;
    }
  }
}

/// A smooth gradient is met before the boundary that it is of: there the value does not rise yet.
TEST(BoundaryUncertaintyLaws, WhereOnlyTheGradientIsSteepTheBoundaryIsAsFarAsTheValueRises) {
  for (const double ahead_mm : {-4.0, -2.5, 2.5, 4.0}) {
    Geometry g;
    g.dimensions = {60, 60, 60};
    for (int k = 0; k < 60; ++k) g.slice_positions.emplace_back(0, 0, k);
    FormulaSource source;
    const Vec3 place(30, 30, 30);
    source.gradient = {20, 0, 0};
    source.value = [&](const Vec3& at) { return 100 * blurred_step(at.x - place.x - ahead_mm, 0.65) + 1e-3 * at.x; };
    const BoundaryUncertainty known = uncertainty_at(source, g, ValueMethod::cubic, place);
    EXPECT_NEAR(known.level_mm, -ahead_mm, 0.3);
    EXPECT_GT(known.two_sigma_mm, std::abs(ahead_mm) - 0.3);
  }
}

/// A plate that is thinner than the blur does not reach its value, and the middle of what it reaches lies outside.
TEST(BoundaryUncertaintyLaws, ThePlateThatIsThinForItsBlurHasItsEdgeWhereItIs) {
  Geometry g;
  g.dimensions = {60, 60, 60};
  for (int k = 0; k < 60; ++k) g.slice_positions.emplace_back(0, 0, k);
  const Vec3 place(30.2, 30.1, 30.3), normal = glm::normalize(Vec3(0.4, -0.7, 0.5));
  for (const bool is_dark : {false, true}) {
    for (const double blur_mm : {0.65, 1.2}) {
      for (const double thick : {2.0, 2.5, 3.0, 5.0}) {  // standard deviations
        // The plate begins at the place; the dark one lies before it.
        const double from = is_dark ? -thick * blur_mm : 0, to = from + thick * blur_mm;
        FormulaSource source;
        source.gradient = 10.0 * normal;
        source.value = [&](const Vec3& at) {
          const double way = glm::dot(normal, at - place);
          const double plate = blurred_step(way - from, blur_mm) - blurred_step(way - to, blur_mm);
          return (is_dark ? -100 : 100) * plate;
        };
        const BoundaryUncertainty known = uncertainty_at(source, g, ValueMethod::cubic, place);
        EXPECT_NEAR(known.level_mm, 0, (thick < 3 ? 0.25 : 0.12) * blur_mm)
            << is_dark << ' ' << blur_mm << ' ' << thick;
      }
    }
  }
}

/// Of a scanner whose blur nobody told: the edge itself shows it.
TEST(BoundaryUncertaintyLaws, TheShiftByCurvatureGrowsWithTheScannersOwnBlur) {
  Geometry g;
  g.dimensions = {60, 60, 60};
  for (int k = 0; k < 60; ++k) g.slice_positions.emplace_back(0, 0, k);
  const Vec3 place(30, 30, 30), normal = glm::normalize(Vec3(0.4, -0.7, 0.5));
  for (const double blur_mm : {1.0, 1.5, 2.0}) {
    constexpr double radius_mm = 300;
    FormulaSource source;
    source.gradient = 10.0 * normal;
    source.value = [&](const Vec3& at) {
      return 100 * blurred_step(radius_mm - glm::distance(at, place + radius_mm * normal), blur_mm);
    };
    const double shift = uncertainty_at(source, g, ValueMethod::cubic, place).curvature_mm;
    EXPECT_NEAR(shift, blur_mm * blur_mm / radius_mm, 0.12 * blur_mm * blur_mm / radius_mm) << blur_mm;
  }
}

TEST(BoundaryUncertaintyLaws, ABoundaryThatFallsAlongItsGradientIsUnknown) {
  const TiltedBoundary b = tilted_boundary(1);
  FormulaSource source;
  source.gradient = b.normal;
  for (const double slope : {-3.0, 0.0}) {
    source.value = [&](const Vec3& at) { return slope * glm::dot(b.normal, at); };
    const BoundaryUncertainty known = uncertainty_at(source, b.geometry, ValueMethod::cubic, b.place);
    EXPECT_EQ(known.two_sigma_mm, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(known.slope, slope, 1e-9);
  }
}

}  // namespace
}  // namespace palpate::io
