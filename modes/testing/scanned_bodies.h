#pragma once

/// Four bodies with known boundaries, and four grids of voxels to scan them with.

#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "modes/scene/workspace.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::modes::testing {

/// A point of a boundary, and the boundary's outward direction.
struct Spot {
  Vec3 at{0};
  Vec3 outward{0};
  double low = testdata::air_hu, high = testdata::soft_tissue_hu;
  double radius = 0;  ///< of a curved boundary, mm
  int bends = 0;      ///< the number of directions along which it is curved: 0 flat, 1 a tube, 2 a sphere
};

/// The direction in which the value rises: every body is denser than its outside.
inline Vec3 uphill(const Spot& spot) {
  return -spot.outward;
}

struct Body {
  std::string name;
  testdata::Phantom phantom;
  std::vector<Spot> spots;
};

inline Vec3 across(const Vec3& direction) {
  return glm::normalize(glm::cross(direction, std::abs(direction.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

inline constexpr int spots_of_each = repeats(60, 21);

inline Body slab() {
  const Vec3 inward = glm::normalize(Vec3(0.3, 1, 0.4));
  Body body{"slab", testdata::make_slab(inward, std::vector<testdata::Layer>{{0, testdata::soft_tissue_hu}}), {}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-12, 12);
  const Vec3 t = across(inward);
  for (int i = 0; i < spots_of_each; ++i) {
    const double a = any(random), b = any(random);  // in this order with every compiler
    body.spots.push_back({a * t + b * glm::cross(inward, t), -inward});
  }
  return body;
}

inline Body sphere() {
  constexpr double radius = 20;
  Body body{"sphere", testdata::make_sphere(radius), {}};
  std::mt19937 random(2);
  std::normal_distribution<double> any;
  for (int i = 0; i < spots_of_each; ++i) {
    const double x = any(random), y = any(random), z = any(random);
    const Vec3 outward = glm::normalize(Vec3(x, y, z));
    body.spots.push_back({.at = radius * outward, .outward = outward, .radius = radius, .bends = 2});
  }
  return body;
}

inline Body tube() {
  constexpr double radius = 8, lumen = 300;
  const Vec3 axis = glm::normalize(Vec3(0.3, 0.5, 1));
  Body body{"tube", testdata::make_tube(radius, axis, lumen), {}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(0, 6.2831853), along(-10, 10);
  const Vec3 t = across(axis), b = glm::cross(axis, t);
  for (int i = 0; i < spots_of_each; ++i) {
    const double a = angle(random);
    const double z = along(random);
    const Vec3 outward = std::cos(a) * t + std::sin(a) * b;
    body.spots.push_back({radius * outward + z * axis, outward, testdata::soft_tissue_hu, lumen, radius, 1});
  }
  return body;
}

/// Its three faces, at points farther than three times the gradient's scale from the edge where they meet.
inline Body wedge() {
  Body body{"wedge", testdata::make_wedge(90), {}};
  const Vec3 interface =
      testdata::value_at(body.phantom, {1, 0, -1}) == testdata::soft_tissue_hu ? Vec3(1, 0, 0) : Vec3(-1, 0, 0);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-8, 8);
  for (int i = 0; i < spots_of_each / 3; ++i) {
    double at[5];
    for (double& number : at) number = any(random);
    body.spots.push_back({16.0 * interface + Vec3(0.3 * at[0], at[1], 0), {0, 0, 1}});
    body.spots.push_back(
        {-16.0 * interface + Vec3(0.3 * at[2], at[3], 0), {0, 0, 1}, testdata::air_hu, testdata::bone_hu});
    body.spots.push_back({Vec3(0, at[4], -16 + 0.3 * at[0]), interface, testdata::soft_tissue_hu, testdata::bone_hu});
  }
  return body;
}

struct NamedGrid {
  std::string name;
  testdata::Grid grid;
};

inline std::vector<NamedGrid> samplings() {
  const testdata::Grid straight;
  testdata::Grid thick;
  thick.spacing = {1, 1, 5};
  thick.size = {64, 64, 16};
  testdata::Grid tilted;
  tilted.tilt_degrees = 20;
  if (is_sanitized) {
    return {{"thick", thick}, {"tilted", tilted}};
  }
  return {{"straight", straight}, {"thick", thick}, {"oblique", rotated(straight, {1, 2, 3}, 40)}, {"tilted", tilted}};
}

}  // namespace palpate::modes::testing
