// What noise and the scan's end make of a boundary's uncertainty, for analytic values on any grid.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "io/fields/boundary_uncertainty.h"
#include "io/testing/formula_boundary.h"

namespace palpate::io {
namespace {

using testing::any_unit;
using testing::blurred_step;
using testing::FormulaSource;
using testing::gaussian_at;
using testing::hashed;
using testing::tilted_boundary;
using testing::TiltedBoundary;

/// Noise of a known deviation, on a plane that is much steeper along the boundary than the noise: a wrong normal.
TEST(BoundaryNoiseLaws, NoiseIsItsStandardDeviationWhateverTheTilt) {
  double squares = 0, slopes = 0;
  constexpr int places = 600;
  const double sigma = 12, slope = 500;
  for (unsigned seed = 0; seed < places; ++seed) {
    const TiltedBoundary b = tilted_boundary(seed);
    std::mt19937 random(seed + 1000);
    const Vec3 tilt = 40.0 * (b.tangent * any_unit(random));
    FormulaSource source;
    source.gradient = b.normal;
    source.value = [&](const Vec3& at) {
      return slope * blurred_step(glm::dot(b.normal, at - b.place), 2) + glm::dot(tilt, at) + sigma * gaussian_at(at);
    };
    const BoundaryUncertainty known = uncertainty_at(source, b.geometry, ValueMethod::cubic, b.place);
    squares += known.noise * known.noise / places;
    slopes += known.slope / places;
    EXPECT_DOUBLE_EQ(known.noise_mm, known.noise / known.slope);
    // Nothing makes it less than noise and phase alone.
    EXPECT_GT(known.two_sigma_mm,
              1.64 * std::max(known.noise_mm, known.sampling_mm) + std::abs(known.curvature_mm + known.level_mm));
  }
  // Those beyond three deviations, as the pairs themselves tell them, are left out: that takes a little.
  EXPECT_NEAR(std::sqrt(squares), 0.975 * sigma, 0.012 * sigma);
  EXPECT_NEAR(slopes, slope, 0.05 * slope);
}

/// A structure beside the boundary, in few of the pairs, is none of the noise.
TEST(BoundaryNoiseLaws, WhatIsFarOutsideOfTheNoiseIsLeftOut) {
  constexpr int places = 200;
  double squares = 0;
  for (unsigned seed = 0; seed < places; ++seed) {
    const TiltedBoundary b = tilted_boundary(seed);
    FormulaSource source;
    source.gradient = b.normal;
    const auto value = [&](const Vec3& at) { return 200 * glm::dot(b.normal, at - b.place) + 5 * gaussian_at(at); };
    // A place of the nearest pair, which lies on the plane.
    Vec3 nearest(1e9);
    source.value = [&](const Vec3& at) {
      const bool on_plane = std::abs(glm::dot(b.normal, at - b.place)) < 1e-9;
      const double away = glm::distance(at, b.place);
      if (on_plane && away > 1e-9 && away < glm::distance(nearest, b.place)) nearest = at;
      return value(at);
    };
    uncertainty_at(source, b.geometry, ValueMethod::cubic, b.place);
    source.value = [&](const Vec3& at) { return value(at) + (glm::distance(at, nearest) < 1e-9 ? 400 : 0); };
    const double noise = uncertainty_at(source, b.geometry, ValueMethod::cubic, b.place).noise;
    squares += noise * noise / places;
  }
  EXPECT_LT(std::sqrt(squares), 9);  // it pulls at the tilt; counted itself, it would make 50
}

/// What lies outside the scan has a value of zero, which must not count: neither alone nor of a pair.
TEST(BoundaryNoiseLaws, WhatLiesOutsideDoesNotCount) {
  int known_at = 0, unknown_at = 0;
  for (unsigned seed = 0; seed < 120; ++seed) {
    const TiltedBoundary b = tilted_boundary(seed);
    const double part = 0.1 * (seed % 8);  // outside
    FormulaSource source;
    source.gradient = b.normal;
    source.value = [&](const Vec3& at) { return 1000 + 30 * blurred_step(glm::dot(b.normal, at - b.place), 3); };
    source.inside = [&](const Vec3& at) { return at == b.place || hashed(at) >= part; };
    const BoundaryUncertainty known = uncertainty_at(source, b.geometry, ValueMethod::cubic, b.place);
    if (std::isfinite(known.two_sigma_mm)) {
      ++known_at;
      EXPECT_NEAR(known.slope, 30, 0.6);
      EXPECT_NEAR(known.noise, 0, 1e-6);
      EXPECT_NEAR(known.curvature_mm, 0, 1e-6);
      EXPECT_NEAR(known.level_mm, 0, 0.01);
    } else {
      ++unknown_at;
    }
    // Half of the 32 pairs have to be there.
    if (part == 0) {
      EXPECT_TRUE(std::isfinite(known.two_sigma_mm));
    }
    if (part > 0.65) {
      EXPECT_FALSE(std::isfinite(known.two_sigma_mm));
    }
  }
  EXPECT_GT(known_at, 30);
  EXPECT_GT(unknown_at, 15);
}

/// What rises on and on has no sides, and what noise alone makes is no boundary.
TEST(BoundaryNoiseLaws, ARampAndNoiseAreNoBoundaries) {
  int stated = 0, places = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const TiltedBoundary b = tilted_boundary(seed);
    FormulaSource source;
    source.gradient = 3.0 * b.normal;
    source.value = [&](const Vec3& at) { return 3 * glm::dot(b.normal, at - b.place); };
    EXPECT_FALSE(std::isfinite(uncertainty_at(source, b.geometry, ValueMethod::cubic, b.place).two_sigma_mm)) << seed;
    source.value = [&](const Vec3& at) { return 12 * gaussian_at(at); };
    stated += std::isfinite(uncertainty_at(source, b.geometry, ValueMethod::cubic, b.place).two_sigma_mm);
    ++places;
  }
  EXPECT_LT(stated, places / 10);
}

}  // namespace
}  // namespace palpate::io
