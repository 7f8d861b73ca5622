// Where boundaries are felt, and which way they push: the same bodies scanned straight, in thick slices, obliquely and
// under gantry tilt. The position is that of the held iso-value half-way between the two materials.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "palpate/io/volume_fields.h"
#include "palpate/modes/internal/test_rig.h"
#include "palpate/testdata/scan.h"

namespace palpate::modes {
namespace {

using testdata::air_hu;
using testdata::bone_hu;
using testdata::Grid;
using testdata::soft_tissue_hu;

/// A point of a boundary, and the direction it pushes to.
struct Spot {
  Vec3 at{0};
  Vec3 outward{0};
  double low = air_hu, high = soft_tissue_hu;
};

struct Body {
  std::string name;
  testdata::Phantom phantom;
  std::vector<Spot> spots;
};

Vec3 across(const Vec3& direction) {
  return glm::normalize(glm::cross(direction, std::abs(direction.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

constexpr int spots_of_each = 60;

Body slab() {
  const Vec3 inward = glm::normalize(Vec3(0.3, 1, 0.4));
  Body body{"slab", testdata::make_slab(inward, std::vector<testdata::Layer>{{0, soft_tissue_hu}}), {}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-12, 12);
  const Vec3 t = across(inward);
  for (int i = 0; i < spots_of_each; ++i) {
    body.spots.push_back({any(random) * t + any(random) * glm::cross(inward, t), -inward});
  }
  return body;
}

Body sphere() {
  constexpr double radius = 20;
  Body body{"sphere", testdata::make_sphere(radius), {}};
  std::mt19937 random(2);
  std::normal_distribution<double> any;
  for (int i = 0; i < spots_of_each; ++i) {
    const double x = any(random), y = any(random), z = any(random);  // in this order with every compiler
    const Vec3 outward = glm::normalize(Vec3(x, y, z));
    body.spots.push_back({radius * outward, outward});
  }
  return body;
}

Body tube() {
  constexpr double radius = 8, lumen = 300;
  const Vec3 axis = glm::normalize(Vec3(0.3, 0.5, 1));
  Body body{"tube", testdata::make_tube(radius, axis, lumen), {}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(0, 6.2831853), along(-10, 10);
  const Vec3 t = across(axis), b = glm::cross(axis, t);
  for (int i = 0; i < spots_of_each; ++i) {
    const double a = angle(random);
    const Vec3 outward = std::cos(a) * t + std::sin(a) * b;
    body.spots.push_back({radius * outward + along(random) * axis, outward, soft_tissue_hu, lumen});
  }
  return body;
}

/// Its three faces, farther than three times the gradient's scale from the edge where they meet.
Body wedge() {
  Body body{"wedge", testdata::make_wedge(90), {}};
  const Vec3 interface =
      testdata::value_at(body.phantom, {1, 0, -1}) == soft_tissue_hu ? Vec3(1, 0, 0) : Vec3(-1, 0, 0);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-8, 8);
  for (int i = 0; i < spots_of_each / 3; ++i) {
    body.spots.push_back({16.0 * interface + Vec3(0.3 * any(random), any(random), 0), {0, 0, 1}});
    body.spots.push_back({-16.0 * interface + Vec3(0.3 * any(random), any(random), 0), {0, 0, 1}, air_hu, bone_hu});
    body.spots.push_back({Vec3(0, any(random), -16 + 0.3 * any(random)), interface, soft_tissue_hu, bone_hu});
  }
  return body;
}

struct Sampling {
  std::string name;
  Grid grid;
};

std::vector<Sampling> samplings() {
  const Grid straight;
  Grid thick;
  thick.spacing = {1, 1, 5};
  thick.size = {64, 64, 16};
  Grid tilted;
  tilted.tilt_degrees = 20;
  return {{"straight", straight}, {"thick", thick}, {"oblique", rotated(straight, {1, 2, 3}, 40)}, {"tilted", tilted}};
}

struct Felt {
  double worst_position = 0;  ///< of the voxel's extent along the normal
  double worst_degrees = 0;   ///< of the force from the normal
};

Felt feel(const Body& body, const Grid& grid) {
  const auto volume = std::make_shared<const io::Volume>(testdata::scan(body.phantom, testdata::make_geometry(grid)));
  const io::Geometry& g = volume->geometry;
  const io::VolumeFields source(volume, io::FieldSet::value | io::FieldSet::gradient, io::default_gradient_scale_mm(g));
  Felt felt;
  for (const Spot& spot : body.spots) {
    const double middle = 0.5 * (spot.low + spot.high), step = spot.high - spot.low;
    // The strength switches on within a hundredth of the step: what is held is the middle.
    testing::Hand hand(
        testing::scene_of({testing::surface(TransferFunction({{middle - 0.005 * step, 0}, {middle + 0.005 * step, 2}}),
                                            Datum::value)},
                          8),
        source);
    // 5 mm/s: what a frame's travel adds to where it is held is less than what is asked.
    hand.stroke(spot.at + 6.0 * spot.outward, spot.at - 1.0 * spot.outward, 1400);
    const double extent = std::abs(glm::dot(g.direction_i, spot.outward)) * g.spacing_i +
                          std::abs(glm::dot(g.direction_j, spot.outward)) * g.spacing_j +
                          std::abs(glm::dot(g.step, spot.outward));
    felt.worst_position =
        std::max(felt.worst_position, std::abs(glm::dot(hand.proxy_mm() - spot.at, spot.outward)) / extent);
    const double cosine = glm::dot(glm::normalize(hand.force()), spot.outward);
    felt.worst_degrees = std::max(felt.worst_degrees, std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI);
  }
  return felt;
}

TEST(FeltPosition, is_within_a_tenth_of_a_voxel_and_the_force_along_the_normal_however_the_body_was_scanned) {
  for (const Body& body : {slab(), sphere(), tube(), wedge()}) {
    for (const Sampling& sampling : samplings()) {
      // Slices of 5 mm do not show how a round body bends between them: from one to the next a sphere's edge moves
      // farther than it is wide.
      const bool is_round = body.name == "sphere" || body.name == "tube";
      const bool is_undersampled = sampling.name == "thick" && is_round;
      const Felt felt = feel(body, sampling.grid);
      SCOPED_TRACE(body.name + ", " + sampling.name);
      EXPECT_LE(felt.worst_position, is_undersampled && body.name == "sphere" ? 0.15 : 0.1);
      EXPECT_LE(felt.worst_degrees, is_undersampled ? 6 : 1);
    }
  }
}

}  // namespace
}  // namespace palpate::modes
