// The laws of tubes that are joined to an outline or cut from it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <vector>

#include "io/structures/edit_changes.h"
#include "io/structures/edits.h"
#include "io/structures/outline_places.h"
#include "io/testing/made_labels.h"

namespace palpate::io {
namespace {

using FieldPointer = std::shared_ptr<const DistanceField>;

// What is joined or cut moves the edge as far as its surface lies from the old one: known of two balls.
TEST(EditTubes, TheLargestMoveOfABallIsItsBulge) {
  const FieldPointer ball =
      distance_of(made_labels([](const Vec3& at) { return glm::length(at) < 18; }, 36, {}), {.reach_mm = 20});
  for (const double radius : {3.0, 5.0, 8.0}) {
    for (const double outside : {-7.0, -4.0, -1.0, 0.0, 2.0}) {
      const Vec3 center = (18 + outside) * glm::normalize(Vec3(2, -1, 3));
      EditOutcome added, removed;
      apply_edit(ball, AddEdit{{.path_mm = {center}, .radius_mm = radius}}, {}, &added);
      apply_edit(ball, RemoveEdit{{.path_mm = {center}, .radius_mm = radius}}, {}, &removed);
      EXPECT_NEAR(added.largest_mm, std::max(0.0, radius + outside), 0.15) << radius << ' ' << outside;
      EXPECT_NEAR(removed.largest_mm, std::max(0.0, radius - outside), 0.15) << radius << ' ' << outside;
      EXPECT_EQ(added.points, 1U);
    }
  }
  // Of a hollow in the middle, its wall.
  EditOutcome hollow;
  apply_edit(ball, RemoveEdit{{.path_mm = {Vec3(0)}, .radius_mm = 5}}, {}, &hollow);
  EXPECT_NEAR(hollow.largest_mm, 18 - 5, 0.5);
  // Of a path, the place that lies farthest out.
  EditOutcome along;
  apply_edit(ball, AddEdit{{.path_mm = {Vec3(10, -12, 0), Vec3(10, 12, 0)}, .radius_mm = 4}}, {}, &along);
  EXPECT_NEAR(along.largest_mm, 4 + std::hypot(10, 12) - 18, 0.15);
  apply_edit(ball, AddEdit{{.path_mm = {Vec3(-17, -30, 0), Vec3(-17, 30, 0)}, .radius_mm = 4}}, {}, &along);
  EXPECT_NEAR(along.largest_mm, 4 + std::hypot(17, 30) - 18, 0.3);
}

double distance_to_path(const std::vector<Vec3>& path, const Vec3& at) {
  double least = glm::distance(path.front(), at);
  for (std::size_t n = 1; n < path.size(); ++n) {
    least = std::min(least, internal::distance_to({path[n - 1], path[n]}, at));
  }
  return least;
}

// A path has as many points as it is drawn with: those that hardly matter are left out.
TEST(EditTubes, ThinnedPathsKeepTheirEndsAndStayNear) {
  std::mt19937 random(9);
  std::normal_distribution<double> shake(0, 0.03);
  for (const double radius : {0.5, 3.0, 10.0}) {
    const double near = radius / 20;
    std::vector<Vec3> path;
    double length = 0;
    for (int n = 0; n < 3000; ++n) {
      const double t = n / 300.0, x = shake(random), y = shake(random);
      path.emplace_back(9 * std::cos(t) + x, 9 * std::sin(t) + y, t);
      if (n > 0) length += glm::distance(path[static_cast<std::size_t>(n - 1)], path.back());
    }
    const std::vector<Vec3> kept = internal::thinned_path(path, near);
    EXPECT_EQ(kept.front(), path.front());
    EXPECT_EQ(kept.back(), path.back());
    EXPECT_LE(static_cast<double>(kept.size()), length / near + 2);
    for (const Vec3& place : path) EXPECT_LE(distance_to_path(kept, place), near + 1e-9);
    for (const Vec3& place : kept) EXPECT_EQ(distance_to_path(path, place), 0);
  }
  EXPECT_TRUE(internal::thinned_path({}, 1).empty());
  EXPECT_EQ(internal::thinned_path({Vec3(1)}, 1), std::vector<Vec3>{Vec3(1)});
  EXPECT_EQ(internal::thinned_path({Vec3(1), Vec3(1)}, 1), std::vector<Vec3>{Vec3(1)});
}

// The field of a dense path is that of the tube around all of it, to a twentieth of the radius, and takes no longer
// than one of as many points as can be told apart.
TEST(EditTubes, DensePathsAreTubes) {
  const FieldPointer ball =
      distance_of(made_labels([](const Vec3& at) { return glm::length(at) < 12; }, 30, {}), {.reach_mm = 5});
  FieldPointer made;
  const auto seconds_of = [&](int points) {
    std::vector<Vec3> path;
    for (int n = 0; n <= points; ++n) {
      const double angle = 5.0 * n / points;
      path.emplace_back(0, 20 * std::sin(angle), 20 * std::cos(angle));
    }
    const std::clock_t begin = std::clock();
    EditOutcome outcome;
    made = apply_edit(ball, AddEdit{{.path_mm = path, .radius_mm = 3}}, {}, &outcome);
    EXPECT_EQ(outcome.points, path.size());
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  };
  constexpr int told_apart = 600;  // a twentieth of the radius from each other
  const double sparse_s = seconds_of(told_apart), dense_s = seconds_of(20'000);
  EXPECT_LT(dense_s, 4 * sparse_s) << sparse_s;
  for (int n = 0; n < 60; ++n) {
    const double angle = 0.2 + n * 0.075;
    for (const double from : {1.5, 3.0, 4.5}) {
      const Vec3 at = (20 + from) * Vec3(0, std::sin(angle), std::cos(angle));
      EXPECT_NEAR(made->sample(at).mm, 3 - from, 0.05 * 3 + 0.1) << angle << ' ' << from;
    }
  }
}

// Far from the surface, too, the distance is that of the new one: up to each end of the scan, and beyond it.
TEST(EditTubes, APartBesideAnEndOfTheScanIsMeasuredThereAndBeyond) {
  const Mask labels = made_labels([](const Vec3& at) { return glm::length(at) < 10; }, 40, {});
  const FieldPointer ball = distance_of(labels, {.scan = &labels.geometry});
  constexpr double radius = 5, end_mm = 39.5;
  for (const Vec3& end : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1),
                          Vec3(1, 1, 1), Vec3(-1, -1, -1)}) {
    const Vec3 center = 28.0 * end;
    const FieldPointer two = apply_edit(ball, AddEdit{{.path_mm = {center}, .radius_mm = radius}});
    for (const double beyond_mm : {0.0, 5.0, 30.0}) {
      if (glm::length(end) > 1 && beyond_mm > 5) continue;  // farther from the part than distances are made anew
      const Vec3 at = (end_mm + beyond_mm) * end;
      EXPECT_NEAR(two->sample(at).mm, radius - glm::distance(at, center), 2)
          << at.x << ' ' << at.y << ' ' << at.z << ", " << beyond_mm;
    }
  }
}

}  // namespace
}  // namespace palpate::io
