/// Contours of one plane stay together at any height and obliquity, for any points, orders and windings; and the
/// messages about uneven or single planes. Truth: areas of regular polygons.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "io/structures/contour_planes.h"

namespace palpate::io {
namespace {

/// A hollow body: in each plane a regular polygon with another one as its hole, and a second body beside it.
struct HollowBody {
  explicit HollowBody(unsigned seed) : random(seed) {
    constexpr std::array<double, 5> lasts{0.005, 0.015, 0.125, 0.995,
                                          -0.445};  // heights that end in 5, and rounded ones
    const auto kind = seed % 4;
    if (kind < 3) {  // along an axis of the patient
      const auto a = static_cast<int>(kind);
      u = v = Vec3(0);
      u[(a + 1) % 3] = v[(a + 2) % 3] = 1;
    } else {
      u = glm::normalize(Vec3(any(-1, 1), any(-1, 1), any(0.2, 1)));
      v = glm::normalize(glm::cross(u, Vec3(any(-1, 1), 1, any(-1, 1))));
    }
    n = glm::cross(u, v);
    rounded_to = kind < 3 ? 1e-3 : std::array{1e-3, 1e-2, 5e-2}[seed / 4 % 3];
    step = std::array{0.5, 1.0, 2.5, 3.0}[seed / 3 % 4];
    first = std::floor(any(-900, 900)) + lasts[seed % 5];
  }

  double any(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

  Contour polygon(double radius, const glm::dvec2& middle, double height, double& area) {
    const int points = std::uniform_int_distribution<int>(5, 400)(random);
    const double turned = any(0, 6);
    Contour contour;
    for (int k = 0; k < points; ++k) {
      const double angle = turned + 2 * std::numbers::pi * k / points;
      Vec3 at = (middle.x + radius * std::cos(angle)) * u + (middle.y + radius * std::sin(angle)) * v + height * n;
      for (int axis = 0; axis < 3; ++axis) at[axis] = std::round(at[axis] / rounded_to) * rounded_to;
      contour.push_back(at);
    }
    area += points / 2.0 * radius * radius * std::sin(2 * std::numbers::pi / points);
    if (any(0, 1) < 0.5) std::ranges::reverse(contour);
    return contour;
  }

  std::mt19937 random;
  Vec3 u{1, 0, 0}, v{0, 1, 0}, n;
  double rounded_to = 1e-3, step = 1, first = 0;
};

TEST(ContourStackLaws, ContoursOfOnePlaneStayTogetherAtAnyHeightAndObliquity) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    HollowBody body(seed);
    std::vector<Contour> contours;
    double area = 0, holes = 0;
    constexpr int planes = 12;
    for (int k = 0; k < planes; ++k) {
      const double height = body.first + k * body.step;
      contours.push_back(body.polygon(20, {5, 5}, height, area));
      contours.push_back(body.polygon(12, {6, 4}, height, holes));
      contours.push_back(body.polygon(9, {-160, 90}, height, area));
    }
    std::ranges::shuffle(contours, body.random);
    const ContourStack stack = stack_of(contours);
    ASSERT_EQ(stack.planes.size(), std::size_t{planes}) << seed;
    for (const ContourStack::Plane& plane : stack.planes) EXPECT_EQ(plane.polygons.size(), 3U) << seed;
    EXPECT_NEAR(stack.step_mm, body.step, 2 * body.rounded_to) << seed;
    EXPECT_TRUE(stack.warnings.empty()) << seed << ' ' << stack.warnings.front();
    const double volume = (area - holes) * body.step;
    EXPECT_NEAR(measures_of(contours).volume_mm3, volume, 1e-3 * volume * (1 + 50 * body.rounded_to)) << seed;
  }
}

Contour upright_square(double half, double height) {
  return {{-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}};
}

// Programs round heights differently, and so contours of one plane. What lies in many planes as near as that to one
// another (a scan of teeth has slices of 0.075 mm) stays in them.
TEST(ContourStackLaws, HeightsThatWereRoundedDifferentlyAreOfOnePlane) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    HollowBody body(seed);
    const double off = std::array{0.0, 0.011, 0.03, 0.045}[seed % 4];
    std::vector<Contour> contours;
    double area = 0, holes = 0;
    constexpr int planes = 9;
    for (int k = 0; k < planes; ++k) {
      const double height = body.first + k * body.step;
      contours.push_back(body.polygon(20, {5, 5}, height, area));
      contours.push_back(body.polygon(12, {6, 4}, height + off, holes));
    }
    std::ranges::shuffle(contours, body.random);
    const ContourStack stack = stack_of(contours);
    ASSERT_EQ(stack.planes.size(), std::size_t{planes}) << seed;
    const double volume = (area - holes) * body.step;
    EXPECT_NEAR(measures_of(contours).volume_mm3, volume, 1e-3 * volume * (1 + 50 * body.rounded_to)) << seed;
  }
}

TEST(ContourStackLaws, PlanesOfFineSlicesStayApart) {
  for (const double step : {0.02, 0.04, 0.05, 0.075, 0.1, 0.2}) {
    std::vector<Contour> contours;
    for (int k = 0; k < 40; ++k) contours.push_back(upright_square(10, 3 + k * step));
    EXPECT_EQ(stack_of(contours).planes.size(), 40U) << step;
    EXPECT_NEAR(measures_of(contours).volume_mm3, 400 * 40 * step, 1e-6) << step;
  }
}

// In the wall of a hollow organ, in its lumen, and in the body beside it.
TEST(ContourStackLaws, AHollowOrganAndTheBodyBesideItAreFeltAtAnyHeight) {
  for (const unsigned seed : {0U, 3U, 11U}) {
    HollowBody body(seed);
    body.step = 2.5;
    std::vector<Contour> contours;
    double ignored = 0;
    for (int k = 0; k < 5; ++k) {
      const double height = body.first + k * body.step;
      contours.push_back(body.polygon(20, {0, 0}, height, ignored));
      contours.push_back(body.polygon(10, {0, 0}, height, ignored));
      contours.push_back(body.polygon(8, {40, 0}, height, ignored));
    }
    const ContourStack stack = stack_of(contours);
    const DistanceField field(planes_of(stack, {}), {});
    const auto depth = [&](double x, double y) {
      return field.sample(x * body.u + y * body.v + (body.first + 2 * body.step) * body.n).mm;
    };
    // A polygon of five points is up to a fifth of its radius within its circle.
    EXPECT_GT(depth(0, 13), 0.5) << seed;
    EXPECT_LT(depth(0, 0), -6) << seed;
    EXPECT_GT(depth(40, 0), 5) << seed;
    EXPECT_LT(depth(27, 0), -3) << seed;
  }
}

std::vector<std::string> said_of(const std::vector<double>& heights) {
  std::vector<Contour> contours;
  for (const double height : heights) contours.push_back(upright_square(10, height));
  const ContourStack stack = stack_of(contours);
  return {stack.warnings.begin(), stack.warnings.end()};
}

// A prism with planes missing has the volume of the whole one, as it is felt; beyond 4.5 steps it is two bodies.
TEST(ContourStackLaws, PlanesThatLieUnevenlyAreSaidAndMeasuredAsTheyAreFelt) {
  EXPECT_TRUE(said_of({0, 2.5, 5, 7.5}).empty());
  EXPECT_TRUE(said_of({0, 1.2, 2.5, 3.8, 5}).empty()) << "rounded";
  EXPECT_EQ(said_of({0, 2.5, 5, 7.5, 22.5, 25, 27.5, 47.5, 50, 75}),
            std::vector<std::string>{
                "its planes lie unevenly: mostly 2.50 mm apart, but 3 gaps are 15.00 mm to 25.00 mm; gaps of more than "
                "11.25 mm are empty, and smaller ones are filled"});
  std::mt19937 random(3);
  for (int n = 0; n < 50; ++n) {
    std::vector<Contour> contours;
    double height = 7, thick = 2, moment = 0;
    contours.push_back(upright_square(10, height));
    double begin = height - 1;
    for (int k = 0; k < 20; ++k) {
      const double gap = std::array{2.0, 2.0, 2.0, 2.0, 6.0, 8.0, 10.0, 30.0}[random() % 8];
      if (gap > 9) {
        moment += (height + 1 - begin) * (height + 1 + begin) / 2;
        begin = height + gap - 1;
      }
      height += gap;
      thick += gap > 9 ? 2 : gap;
      contours.push_back(upright_square(10, height));
    }
    moment += (height + 1 - begin) * (height + 1 + begin) / 2;
    const ContourStack stack = stack_of(contours);
    if (stack.step_mm != 2) continue;
    const StructureMeasures measures = measures_of(contours);
    EXPECT_NEAR(measures.volume_mm3, 400 * thick, 1e-6) << n;
    EXPECT_LT(glm::distance(measures.centroid_mm, Vec3(0, 0, moment / thick)), 1e-8) << n;
  }
}

TEST(ContourStackLaws, APlaneAloneIsAsThickAsIsSaidOrAMillimeterAndThatIsSaid) {
  for (const double thickness : {0.0, 0.7, 5.0}) {
    const StructureMeasures measures = measures_of({upright_square(10, 3)}, {.thickness_mm = thickness});
    EXPECT_NEAR(measures.volume_mm3, 400 * (thickness > 0 ? thickness : 1), 1e-6);
    if (thickness > 0) {
      EXPECT_TRUE(measures.warnings.empty());
    } else {
      ASSERT_EQ(measures.warnings.size(), 1U);
      EXPECT_EQ(measures.warnings[0],
                "its contours lie in one plane, and nothing says how thick it is: it counts as 1 mm");
    }
  }
  const auto two = measures_of({upright_square(10, 3), upright_square(10, 7)}, {.thickness_mm = 1});
  EXPECT_NEAR(two.volume_mm3, 400 * 8, 1e-6) << "their own distance";
  EXPECT_TRUE(two.warnings.empty());
}

}  // namespace
}  // namespace palpate::io
