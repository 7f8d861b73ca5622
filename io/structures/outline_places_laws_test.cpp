// Places on the surfaces of bodies whose surfaces are known.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "io/structures/outline_places.h"
#include "io/testing/made_labels.h"

namespace palpate::io {
namespace {

/// Voxels of all shapes, turned any way.
LabelLattice any_lattice(std::mt19937_64& random) {
  std::uniform_real_distribution<double> mm(0.8, 1.6), part(-1, 1);
  LabelLattice lattice;
  for (int axis = 0; axis < 3; ++axis) lattice.spacing[axis] = mm(random);
  const double x = part(random), y = part(random), z = part(random), angle = 3 * part(random);
  lattice.axes = glm::dmat3(glm::rotate(glm::dmat4(1), angle, glm::normalize(Vec3(x, y, z))));
  return lattice;
}

TEST(OutlinePlaces, LieOnTheSurfaceEvenlyAndStandForAllOfIt) {
  std::mt19937_64 random(41);
  for (int n = 0; n < 3; ++n) {
    const double radius = 5 + n, spacing_mm = 1.5 + 0.5 * (n % 2);
    const Vec3 center(0.3, -0.2, 0.1 * n);
    const auto ball = [&](const Vec3& at) { return glm::distance(at, center) < radius; };
    const auto field = distance_of(made_labels(ball, radius + 3, any_lattice(random)));
    const std::vector<OutlinePlace> places = outline_places(*field, spacing_mm);
    const double surface = 4 * std::numbers::pi * radius * radius;
    double area = 0;
    for (const OutlinePlace& place : places) {
      area += place.area_mm2;
      EXPECT_LT(place.area_mm2, 3 * spacing_mm * spacing_mm) << n;
      EXPECT_LT(std::abs(field->sample(place.place_mm).mm), 0.01) << n;
      EXPECT_NEAR(glm::distance(place.place_mm, center), radius, 0.8) << n;
      EXPECT_NEAR(glm::length(place.inward), 1, 1e-9);
      EXPECT_GT(glm::dot(place.inward, glm::normalize(center - place.place_mm)), 0.9) << n;
    }
    EXPECT_NEAR(area, surface, 0.06 * surface) << n;
    EXPECT_GT(static_cast<double>(places.size()), 0.8 * surface / (spacing_mm * spacing_mm)) << n;
  }
}

/// Each edge of the lattice that crosses the surface counts once: alone in its cell or with others.
TEST(OutlinePlaces, StandForTheSameAreaHoweverFarApart) {
  std::mt19937_64 random(43);
  for (int n = 0; n < 4; ++n) {
    const Vec3 radii(4 + n, 6, 7 - n);
    const auto egg = [&](const Vec3& at) { return glm::length(at / radii) < 1; };
    const auto field = distance_of(made_labels(egg, 10, any_lattice(random)));
    const auto area_of_all = [&](double spacing_mm) {
      double area = 0;
      for (const OutlinePlace& place : outline_places(*field, spacing_mm)) area += place.area_mm2;
      return area;
    };
    const double area = area_of_all(20);
    EXPECT_GT(area, 200) << n;
    for (const double spacing_mm : {0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 9.0}) {
      EXPECT_NEAR(area_of_all(spacing_mm), area, 1e-6 * area) << n << ' ' << spacing_mm;
    }
  }
}

/// Both walls of a plate that is thinner than places are apart.
TEST(OutlinePlaces, AreOnEachOfTwoWallsHoweverNear) {
  const auto plate = [](const Vec3& at) { return std::abs(at.z) < 0.7 && glm::length(glm::dvec2(at)) < 10; };
  const auto field = distance_of(made_labels(plate, 12, {.spacing = {1, 1, 0.5}}));
  for (const double spacing_mm : {2.0, 3.0, 4.0, 5.0}) {
    double up_mm2 = 0, down_mm2 = 0;
    for (const OutlinePlace& place : outline_places(*field, spacing_mm)) {
      if (std::abs(place.inward.z) < 0.9) continue;
      (place.inward.z < 0 ? up_mm2 : down_mm2) += place.area_mm2;
      EXPECT_LT(place.inward.z * place.place_mm.z, 0) << "into the plate";
      EXPECT_LT(place.area_mm2, 1.6 * spacing_mm * spacing_mm) << "of one wall";
    }
    const double wall_mm2 = std::numbers::pi * 10 * 10;
    EXPECT_NEAR(up_mm2, wall_mm2, 0.25 * wall_mm2) << spacing_mm;
    EXPECT_NEAR(down_mm2, wall_mm2, 0.25 * wall_mm2) << spacing_mm;
  }
}

}  // namespace
}  // namespace palpate::io
