// Elongated outlines, outlines of a single plane, and those that are too large; and distances kept all around a long
// body.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/structures/contour_planes.h"
#include "io/structures/distance_field.h"

namespace palpate::io {
namespace {

Contour upright_box(double wide, double tall, double height) {
  return {{0, 0, height}, {wide, 0, height}, {wide, tall, height}, {0, tall, height}};
}

/// Signed, within the plane: positive inside.
double depth_in_box(const glm::dvec2& at, double wide, double tall) {
  const double within = std::min({at.x, wide - at.x, at.y, tall - at.y});
  if (within >= 0) return within;
  return -std::hypot(std::max({-at.x, at.x - wide, 0.0}), std::max({-at.y, at.y - tall, 0.0}));
}

TEST(OutlineShapes, MayBeLongEitherWay) {
  for (const auto& [wide, tall] : {std::pair{70.0, 9.0}, {9.0, 70.0}, {33.0, 34.0}}) {
    const ContourStack stack = stack_of({upright_box(wide, tall, 0), upright_box(wide, tall, 2)});
    const OutlinePlanes planes = planes_of(stack, {});
    const NodeLattice& lattice = planes.lattice;
    const glm::ivec2 size(lattice.bricks * NodeBricks::edge);
    int inside = 0;
    for (std::size_t plane = 0; plane < planes.node.size(); ++plane) {
      const double height = lattice.position({0, 0, planes.node[plane]}).z;
      if (height < -0.1 || height > 2.1) continue;
      PlaneDistances distances;
      planes.compute(plane, distances);
      ASSERT_EQ(distances.to_inside.size(), static_cast<std::size_t>(size.x * size.y));
      for (int n = 0; n < size.x * size.y; ++n) {
        const Vec3 at = lattice.position({n % size.x, n / size.x, planes.node[plane]});
        const double depth = depth_in_box(glm::dvec2(at), wide, tall);
        if (std::abs(depth) < 1e-9) continue;  // on the line: of either side
        const auto index = static_cast<std::size_t>(n);
        const double own = depth > 0 ? distances.to_outside[index] : distances.to_inside[index];
        ASSERT_EQ(depth > 0 ? distances.to_inside[index] : distances.to_outside[index], 0) << wide;
        if (std::abs(depth) < planes.band_mm) {
          ASSERT_NEAR(own, depth * depth, 1e-4 * (1 + own)) << wide;
        }
        inside += depth > 0 ? 1 : 0;
      }
    }
    EXPECT_GT(inside, 500) << wide;
  }
}

// A plane alone says nothing of how thick it is: it counts as a millimeter.
TEST(OutlineShapes, OfOnePlaneAreAMillimeterThick) {
  const std::vector<Contour> alone{upright_box(20, 30, 5)};
  EXPECT_EQ(stack_of(alone).step_mm, 1);
  EXPECT_NEAR(measures_of(alone).volume_mm3, 600, 1e-6);
  // Two boxes in one plane are one plane still.
  Contour beside = upright_box(4, 5, 5);
  for (Vec3& point : beside) point.x += 100;
  EXPECT_EQ(stack_of({alone[0], beside}).step_mm, 1);
  EXPECT_NEAR(measures_of({alone[0], beside}).volume_mm3, 620, 1e-6);
}

// The typical step is the middle one: a missing plane, or one twice as near, does not change it.
TEST(OutlineShapes, AreAsFarApartAsMostPlanesAre) {
  std::vector<Contour> contours;
  for (const double height : {0.0, 3.0, 6.0, 7.0, 10.0, 13.0, 22.0, 25.0})
    contours.push_back(upright_box(9, 9, height));
  EXPECT_DOUBLE_EQ(stack_of(contours).step_mm, 3);
}

TEST(OutlineShapes, OfMoreThanFourThousandPlanesAreRefused) {
  std::vector<Contour> contours;
  for (int k = 0; k < 4096; ++k) contours.push_back(upright_box(9, 9, 0.5 * k));
  EXPECT_EQ(stack_of(contours).planes.size(), 4096U);
  contours.push_back(upright_box(9, 9, -1));
  EXPECT_THROW(stack_of(contours), DicomError);
}

TEST(OutlineShapes, ThatNoLatticeHoldsAreRefused) {
  const auto refusal = [](const Vec3& apart) -> std::string {
    std::vector<Contour> far_apart{upright_box(10, 10, 0), upright_box(10, 10, 2)};
    for (Vec3& point : far_apart[1]) point += apart;
    const ContourStack stack = stack_of(far_apart);
    try {
      planes_of(stack, {});
    } catch (const DicomError& error) {
      return error.what();
    }
    return "not refused";
  };
  // From one corner to the opposite one: 50 m, and two times 10 mm on both axes; and as far along the normal.
  EXPECT_NE(refusal({40000, 30000, 0}).find(" 50014 "), std::string::npos) << refusal({40000, 30000, 0});
  EXPECT_NE(refusal({0, 0, 50000}).find(" 50002 "), std::string::npos) << refusal({0, 0, 50000});
}

double distance_to_segment(const Vec3& at, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  return glm::distance(at, a + std::clamp(glm::dot(at - a, along) / glm::dot(along, along), 0.0, 1.0) * along);
}

/// A rod of 150 mm that is round at its ends, on an oblique lattice with voxels that are no cubes.
struct Rod {
  Mask mask;
  Vec3 begin{0}, end{0};
  static constexpr double radius = 7;

  Rod() {
    const glm::dmat3 turned = glm::dmat3(glm::rotate(glm::dmat4(1), 0.7, glm::normalize(Vec3(1, -2, 0.5))));
    Geometry& g = mask.geometry;
    g.dimensions = mask.size = {13, 12, 66};
    g.direction_i = turned[0];
    g.direction_j = turned[1];
    g.spacing_i = 2;
    g.spacing_j = 2.2;
    g.step = 2.5 * turned[2];
    for (int k = 0; k < g.dimensions.z; ++k) {
      g.slice_positions.push_back(Vec3(-30, 40, 20) + static_cast<double>(k) * g.step);
    }
    begin = g.to_patient({6, 5.5, 5});
    end = g.to_patient({6, 5.5, 60});
    for (int k = 0; k < 66; ++k) {
      for (int j = 0; j < 12; ++j) {
        for (int i = 0; i < 13; ++i) mask.occupancy.push_back(depth(g.to_patient({i, j, k})) > 0 ? Mask::full : 0);
      }
    }
  }
  double depth(const Vec3& at) const { return radius - distance_to_segment(at, begin, end); }
};

// Wherever one is within 35 mm of it; and as far as the scan reaches where there is one.
TEST(DistanceAllAround, IsKeptAlongALongBody) {
  const Rod rod;
  Geometry scan;
  scan.dimensions = {2, 2, 2};
  scan.spacing_i = scan.spacing_j = 300;
  scan.step = {0, 0, 300};
  scan.slice_positions = {Vec3(-150, -110, -110), Vec3(-150, -110, 190)};
  for (const bool has_scan : {false, true}) {
    DistanceOptions options;
    if (has_scan) options.scan = &scan;
    const auto field = distance_of(rod.mask, options);
    std::mt19937 random(1);
    const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    int far = 0;
    for (int n = 0; n < 4000; ++n) {
      const double x = any(-150, 150), y = any(-110, 190), z = any(-110, 190);
      const Vec3 at(x, y, z);
      const double depth = rod.depth(at);
      if (!has_scan && depth < -35) continue;
      const Distance found = field->sample(at);
      ASSERT_NEAR(found.mm, depth, 1.7) << has_scan << ' ' << depth;
      far += depth < -10 ? 1 : 0;
    }
    EXPECT_GT(far, 100);
    EXPECT_EQ(field->reach_mm(), 3);
    EXPECT_GT(field->memory_bytes(), field->bricks() * 11 * 11 * 11 * sizeof(float)) << "of its bricks, and more";
  }
}

// Near the surface, where it changes over to the coarse lattice, and there: on a lattice that is oblique and no cube's.
TEST(DistanceAllAround, HasTheGradientOfItsValue) {
  const Rod rod;
  const auto field = distance_of(rod.mask);
  std::mt19937 random(3);
  std::normal_distribution<double> aside(0, 6);
  constexpr double h = 1e-5;
  for (int n = 0; n < 600; ++n) {
    const double x = aside(random), y = aside(random), z = aside(random);
    const Vec3 at = rod.begin + (n / 600.0) * (rod.end - rod.begin) + Vec3(x, y, z);
    const Vec3 gradient = field->sample(at).gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 step(0);
      step[axis] = h;
      ASSERT_NEAR(gradient[axis], (field->sample(at + step).mm - field->sample(at - step).mm) / (2 * h), 3e-3) << n;
    }
  }
}

}  // namespace
}  // namespace palpate::io
