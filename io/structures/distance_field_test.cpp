// Distances of bodies with a known distance.
#include "io/structures/distance_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <random>

#include "io/structures/contour_planes.h"
#include "io/structures/fraction_edges.h"
#include "io/structures/label_planes.h"
#include "solver/text/testing/sanitized.h"

namespace palpate::io {
namespace {

using Inside = std::function<bool(const Vec3&)>;

/// The labels of a body around the origin, within `extent` of it.
Mask labels_of(const Inside& inside, double extent, const Vec3& spacing, const glm::dmat3& axes = glm::dmat3(1),
               double slide_per_slice = 0) {
  Mask mask;
  Geometry& geometry = mask.geometry;
  geometry.direction_i = axes[0];
  geometry.direction_j = axes[1];
  geometry.spacing_i = spacing.x;
  geometry.spacing_j = spacing.y;
  geometry.dimensions = glm::ivec3(glm::ceil(2.0 * extent / spacing));
  geometry.step = spacing.z * axes[2] + slide_per_slice * axes[1];
  const Vec3 first = -0.5 * Vec3(geometry.dimensions - 1) * spacing;
  for (int k = 0; k < geometry.dimensions.z; ++k) {
    geometry.slice_positions.push_back(
        axes * (first + Vec3(0, (k - geometry.dimensions.z / 2) * slide_per_slice, k * spacing.z)));
  }
  mask.size = geometry.dimensions;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        mask.occupancy.push_back(inside(geometry.to_patient({i, j, k})) ? Mask::full : 0);
      }
    }
  }
  return mask;
}

Inside ball(double radius, const Vec3& center) {
  return [=](const Vec3& at) { return glm::distance(at, center) < radius; };
}

int voxels_on_the_wrong_side(const Mask& mask, const DistanceField& field) {
  int wrong = 0;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        const bool inside = field.sample(mask.geometry.to_patient({i, j, k})).mm > 0;
        wrong += inside != mask.inside(i, j, k) ? 1 : 0;
      }
    }
  }
  return wrong;
}

std::vector<Vec3> directions(int count) {
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  std::vector<Vec3> all;
  for (int n = 0; n < count; ++n) {
    const double x = any(random), y = any(random), z = any(random);
    all.push_back(glm::normalize(Vec3(x, y, z)));
  }
  return all;
}

TEST(DistanceField, IsThatOfABallFarAndNear) {
  const Vec3 center(0.3, -0.2, 0.4);
  const auto field = distance_of(labels_of(ball(20, center), 30, {1, 1, 1}));
  for (const Vec3& direction : directions(300)) {
    for (const double r : {12.0, 18.0, 20.0, 21.0, 23.0, 26.0, 40.0}) {
      const Distance distance = field->sample(center + r * direction);
      EXPECT_NEAR(distance.mm, 20 - r, r > 22 || r < 18 ? 0.7 : 0.4) << r;
      EXPECT_NEAR(glm::length(distance.gradient), 1, 0.35) << r;
      if (std::abs(r - 20) < 2) {
        EXPECT_GT(glm::dot(glm::normalize(distance.gradient), -direction), std::cos(0.1));
      }
    }
  }
}

struct BallGoal {
  double radius = 20, slices = 1;
  double mm = 0.12, degrees = 1.6;
};

TEST(DistanceField, IsAsTrueToABallAsItsGoals) {
  for (const BallGoal& goal : {BallGoal{20, 1, 0.12, 1.6}, {20, 3, 0.40, 3}, {20, 5, 0.95, 6}, {3, 1, 0.35, 13}}) {
    const Vec3 center(0.31, -0.17, 0.23 * goal.slices);
    if (is_sanitized && goal.slices != 5) continue;
    const auto field =
        distance_of(labels_of(ball(goal.radius, center), goal.radius + 3 + 3 * goal.slices, {1, 1, goal.slices}));
    for (const Vec3& direction : directions(2000)) {
      double in = 0, out = goal.radius + 6;
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = 0.5 * (in + out);
        (field->sample(center + middle * direction).mm > 0 ? in : out) = middle;
      }
      ASSERT_NEAR(in, goal.radius, goal.mm) << goal.slices;
      const Vec3 inward = glm::normalize(field->sample(center + in * direction).gradient);
      ASSERT_GT(glm::dot(inward, -direction), std::cos(glm::radians(goal.degrees))) << goal.slices;
    }
  }
}

/// How much of each voxel a ball fills, by 12^3 points in it.
Mask shares_of(double radius, const Vec3& center, double extent, const Vec3& spacing) {
  Mask mask = labels_of(ball(radius, center), extent, spacing);
  mask.fractions = Mask::Fractions::occupancy;
  constexpr int parts = 12;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        const Vec3 middle = mask.geometry.to_patient({i, j, k});
        if (std::abs(glm::distance(middle, center) - radius) > glm::length(spacing)) continue;
        int inside = 0;
        for (int n = 0; n < parts * parts * parts; ++n) {
          const Vec3 part(n % parts, n / parts % parts, n / (parts * parts));
          inside += glm::distance(middle + ((part + 0.5) / double{parts} - 0.5) * spacing, center) < radius ? 1 : 0;
        }
        mask.occupancy[mask.offset(i, j, k)] =
            static_cast<std::uint8_t>(std::lround(double{Mask::full} * inside / (parts * parts * parts)));
      }
    }
  }
  return mask;
}

/// Rising through half at the edge, over 3 mm.
Mask likelihoods_of(double radius, const Vec3& center, double extent, const Vec3& spacing) {
  Mask mask = labels_of(ball(radius, center), extent, spacing);
  mask.fractions = Mask::Fractions::probability;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        const double depth = radius - glm::distance(mask.geometry.to_patient({i, j, k}), center);
        mask.occupancy[mask.offset(i, j, k)] =
            static_cast<std::uint8_t>(std::lround(Mask::full * std::clamp(0.5 + depth / 3, 0.0, 1.0)));
      }
    }
  }
  return mask;
}

Mask binarised(Mask mask) {
  mask.fractions = Mask::Fractions::none;
  for (std::uint8_t& share : mask.occupancy) share = share >= Mask::half ? Mask::full : 0;
  return mask;
}

/// Of a ball's surface: the largest error and the root of the mean of the squares, mm.
std::pair<double, double> errors_of(const Mask& mask, double radius, const Vec3& center) {
  const auto field = distance_of(mask);
  double largest = 0, squares = 0;
  constexpr int rays = 2000;
  for (const Vec3& direction : directions(rays)) {
    double in = 0, out = radius + 6;
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (in + out);
      (field->sample(center + middle * direction).mm > 0 ? in : out) = middle;
    }
    largest = std::max(largest, std::abs(in - radius));
    squares += (in - radius) * (in - radius) / rays;
  }
  return {largest, std::sqrt(squares)};
}

TEST(DistanceField, OfFractionsIsTruerThanThatOfTheVoxelsInside) {
  for (const double radius : {3.0, 12.0}) {
    for (const double slices : {1.0, 2.0}) {
      if (is_sanitized && (radius > 5 || slices == 1)) continue;
      const Vec3 center(0.31, -0.17, 0.23 * slices), spacing(1, 1, slices);
      const double extent = radius + 3 + 3 * slices;
      for (const Mask& mask :
           {shares_of(radius, center, extent, spacing), likelihoods_of(radius, center, extent, spacing)}) {
        const auto [largest, rms] = errors_of(mask, radius, center);
        const auto [largest_without, rms_without] = errors_of(binarised(mask), radius, center);
        SCOPED_TRACE(::testing::Message() << "R " << radius << ", slices " << slices << ": largest " << largest
                                          << " for " << largest_without << ", rms " << rms << " for " << rms_without);
        // A large ball is nearly found again by its smoothness alone; a small one is not.
        const double part = radius > 5 ? 1.2 : 0.5;
        EXPECT_LT(largest, part * largest_without);
        EXPECT_LT(rms, part * rms_without);
        EXPECT_LT(largest, radius > 5 ? 0.06 : 0.15);
      }
    }
  }
}

TEST(FractionEdges, ArePlanesThroughABox) {
  // Against points that are counted.
  constexpr int parts = 60;
  const Vec3 size(1, 0.7, 2);
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(1, 1, 1), Vec3(0.3, -0.9, 0.1), Vec3(-2, 0.1, 0.7)}) {
    for (const double share : {0.1, 0.3, 0.5, 0.8}) {
      const double far = plane_distance(size, normal, share);
      int inside = 0;
      for (int n = 0; n < parts * parts * parts; ++n) {
        const Vec3 part(n % parts, n / parts % parts, n / (parts * parts));
        const Vec3 at = ((part + 0.5) / double{parts} - 0.5) * size;
        inside += glm::dot(at, glm::normalize(normal)) + far > 0 ? 1 : 0;
      }
      EXPECT_NEAR(inside, share * parts * parts * parts, 0.02 * parts * parts * parts) << share;
    }
  }
}

TEST(DistanceField, KeepsAPlateOfOneVoxelAboutThatThick) {
  const Inside plate = [](const Vec3& at) { return std::abs(at.x) < 0.6 && std::abs(at.y) < 8 && std::abs(at.z) < 8; };
  const auto field = distance_of(labels_of(plate, 14.5, {1, 1, 1}));
  for (double y = -5; y <= 5; y += 0.7) {
    EXPECT_NEAR(field->sample({0, y, 1.3}).mm, 0.5, 0.3);
    EXPECT_LT(field->sample({0.9, y, 1.3}).mm, 0);
  }
}

TEST(DistanceField, KeepsEveryVoxelOnItsSide) {
  const Inside plate = [](const Vec3& at) { return std::abs(at.x) < 0.6 && std::abs(at.y) < 8 && std::abs(at.z) < 8; };
  const Inside tube = [](const Vec3& at) { return std::hypot(at.x, at.y) < 2.1 && std::abs(at.z) < 10; };
  const Inside block = [](const Vec3& at) { return std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) < 7.2; };
  const Inside shell = [](const Vec3& at) { return std::abs(glm::length(at) - 8) < 1.2; };
  const auto expect_it = [](const Inside& body, const Vec3& spacing) {
    const Mask mask = labels_of(body, 12, spacing);
    EXPECT_EQ(voxels_on_the_wrong_side(mask, *distance_of(mask)), 0) << spacing.z;
  };
  for (const Inside& body : {plate, tube, block, shell, ball(3, {0.2, 0.4, 0.1})}) expect_it(body, {1, 1, 3});
  for (const Inside& body : {plate, shell}) {
    expect_it(body, {1, 1, 1});
    expect_it(body, {0.7, 0.9, 1.3});
  }
}

TEST(DistanceField, KeepsEveryVoxelOnItsSideOnObliqueLattices) {
  const glm::dmat3 turned = glm::dmat3(glm::rotate(glm::dmat4(1), 0.6, glm::normalize(Vec3(1, 2, 3))));
  const Mask mask = labels_of(ball(9, {0.3, 0.1, 0.2}), 16, {0.8, 1, 2}, turned);
  EXPECT_EQ(voxels_on_the_wrong_side(mask, *distance_of(mask)), 0);
}

TEST(DistanceField, IsTheSameWhereItIsTilted) {
  const double spacing = 2;
  const Mask mask = labels_of(ball(12, Vec3(0)), 20, {1, 1, spacing}, glm::dmat3(1), 0.6);
  const auto field = distance_of(mask);
  for (const Vec3& direction : directions(200)) {
    EXPECT_NEAR(field->sample(12.0 * direction).mm, 0, 0.5 * glm::length(Vec3(1, 1, spacing)));
  }
}

TEST(DistanceField, IsTrueInANarrowHollow) {
  // Two balls 4 mm apart: half-way between them it is 2 mm to either.
  const Inside two = [](const Vec3& at) {
    return glm::distance(at, Vec3(-10, 0, 0)) < 8 || glm::distance(at, Vec3(10, 0, 0)) < 8;
  };
  const auto field = distance_of(labels_of(two, 24, {1, 1, 1}));
  // As far as the labels say: half a voxel's diagonal.
  const double half_diagonal = 0.5 * std::sqrt(3.0);
  EXPECT_NEAR(field->sample(Vec3(0)).mm, -2, half_diagonal);
  // Beside their tips the walls are no farther apart than they are; and nowhere is the distance more than it is.
  for (double y = -6; y <= 6; y += 0.5) {
    const Vec3 at(0, y, 0.3);
    const double away = glm::distance(at, Vec3(10, 0, 0)) - 8;
    EXPECT_NEAR(field->sample(at).mm, -away, half_diagonal) << y;
  }
}

TEST(DistanceField, HasTheGradientOfItsValue) {
  const auto field = distance_of(labels_of(ball(9, {0.1, 0.3, 0.2}), 16, {1, 1, 2}));
  constexpr double h = 1e-5;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-14, 14);
  for (int n = 0; n < 500; ++n) {
    const double x = any(random), y = any(random), z = any(random);
    const Vec3 at(x, y, z);
    const Vec3 gradient = field->sample(at).gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 step(0);
      step[axis] = h;
      const double slope = (field->sample(at + step).mm - field->sample(at - step).mm) / (2 * h);
      EXPECT_NEAR(gradient[axis], slope, 2e-3) << n;
    }
  }
}

TEST(DistanceField, GoesOnWhereTheLabelsEnd) {
  // A rod through all slices: nobody has seen its ends, so there is no wall.
  const auto field = distance_of(labels_of([](const Vec3& at) { return std::hypot(at.x, at.y) < 6; }, 12, {1, 1, 2}));
  const Distance last = field->sample({3, 0, 11});
  EXPECT_NEAR(last.mm, 3, 0.4);
  EXPECT_NEAR(last.gradient.z, 0, 0.1);
}

TEST(DistanceField, RefusesAnEmptyMask) {
  EXPECT_THROW(distance_of(labels_of([](const Vec3&) { return false; }, 4, {1, 1, 1})), std::invalid_argument);
}

Contour circle(double radius, double z, bool backward = false) {
  Contour contour;
  constexpr int points = 90;
  for (int n = 0; n < points; ++n) {
    const double angle = (backward ? -n : n) * 2 * 3.14159265358979323846 / points;
    contour.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return contour;
}

std::shared_ptr<const DistanceField> field_of(const std::vector<Contour>& contours) {
  const ContourStack stack = stack_of(contours);
  return std::make_shared<const DistanceField>(planes_of(stack, {}), DistanceOptions{});
}

TEST(ContourField, IsThatOfATubeWithAHole) {
  std::vector<Contour> contours;
  for (int k = -8; k <= 8; ++k) {
    contours.push_back(circle(12, 2.0 * k));
    contours.push_back(circle(5, 2.0 * k));
  }
  const auto field = field_of(contours);
  for (const double r : {3.0, 5.0, 7.0, 10.0, 12.0, 14.0}) {
    for (double angle = 0; angle < 6; angle += 0.7) {
      const Vec3 at(r * std::cos(angle), r * std::sin(angle), 0.9);
      EXPECT_NEAR(field->sample(at).mm, std::min(r - 5, 12 - r), 0.2) << r;
    }
  }
}

TEST(ContourField, FollowsAKeyholeRoundItsHole) {
  // Outline, in to the hole, round it, and out the same way.
  std::vector<Contour> contours;
  for (int k = -6; k <= 6; ++k) {
    Contour keyhole = circle(12, 2.0 * k);
    keyhole.push_back(keyhole.front());
    Contour hole = circle(5, 2.0 * k, true);
    keyhole.insert(keyhole.end(), hole.begin(), hole.end());
    keyhole.push_back(hole.front());
    contours.push_back(std::move(keyhole));
  }
  const auto field = field_of(contours);
  EXPECT_NEAR(field->sample({10, 0, 1}).mm, 2, 0.15);  // on the way to the hole: no edge there
  EXPECT_NEAR(field->sample({6.5, 0, 1}).mm, 1.5, 0.15);
  EXPECT_NEAR(field->sample({3, 0, 1}).mm, -2, 0.25);
}

TEST(ContourField, GoesThroughAMissingSlice) {
  std::vector<Contour> contours;
  for (int k = -6; k <= 6; ++k) {
    if (k != 0) contours.push_back(circle(9, 3.0 * k));
  }
  const auto field = field_of(contours);
  EXPECT_NEAR(field->sample({7, 0, 0}).mm, 2, 0.25);
  EXPECT_GT(field->sample({0, 0, 0}).mm, 7);
}

TEST(ContourField, MeasuresWithoutHoles) {
  std::vector<Contour> contours;
  for (int k = 0; k < 10; ++k) {
    contours.push_back(circle(10, 2.0 * k));
    contours.push_back(circle(4, 2.0 * k));
  }
  const StructureMeasures measures = measures_of(contours);
  const double area = 0.5 * 90 * std::sin(2 * 3.14159265358979323846 / 90) * (100 - 16);
  EXPECT_NEAR(measures.volume_mm3, area * 20, 1e-6 * area);
  EXPECT_EQ(measures.contours, 20U);
  EXPECT_NEAR(measures.centroid_mm.z, 9, 1e-9);
}

}  // namespace
}  // namespace palpate::io
