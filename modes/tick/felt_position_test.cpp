// Where boundaries are felt, and which way they push: the same bodies scanned straight, in thick slices, obliquely and
// under gantry tilt. The position is that of the held iso-value half-way between the two materials. And what is to be
// had at all of a sphere in slices of 5 mm, by the sampling theorem.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <variant>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/testing/scanned_bodies.h"
#include "modes/testing/test_rig.h"
#include "solver/text/testing/sanitized.h"

namespace palpate::modes {
namespace {

using namespace testing;

/// A voxel's size as seen along a direction, mm.
double extent_along(const io::Geometry& g, const Vec3& direction) {
  return std::abs(glm::dot(g.direction_i, direction)) * g.spacing_i +
         std::abs(glm::dot(g.direction_j, direction)) * g.spacing_j + std::abs(glm::dot(g.step, direction));
}

struct Felt {
  double worst_position = 0;  ///< of the voxel's extent along the normal
  double worst_degrees = 0;   ///< of the force from the normal
};

Felt feel(const Body& body, const testdata::Grid& grid) {
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
    source.prepare(spot.at, 2);
    // 5 mm/s: what a tick's travel adds to where it is held is less than what is asked.
    hand.stroke(spot.at + 2.0 * spot.outward, spot.at - 1.0 * spot.outward, 600);
    felt.worst_position = std::max(felt.worst_position, std::abs(glm::dot(hand.proxy_mm() - spot.at, spot.outward)) /
                                                            extent_along(g, spot.outward));
    const double cosine = glm::dot(glm::normalize(hand.force()), spot.outward);
    felt.worst_degrees = std::max(felt.worst_degrees, std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI);
  }
  return felt;
}

TEST(FeltPosition, is_within_a_tenth_of_a_voxel_and_the_force_along_the_normal_however_the_body_was_scanned) {
  for (const Body& body : {slab(), sphere(), tube(), wedge()}) {
    for (const NamedGrid& sampling : samplings()) {
      // Slices of 5 mm do not show how a round body bends between them: see below.
      const bool is_round = body.name == "sphere" || body.name == "tube";
      const bool is_undersampled = sampling.name == "thick" && is_round;
      const Felt felt = feel(body, sampling.grid);
      SCOPED_TRACE(body.name + ", " + sampling.name);
      EXPECT_LE(felt.worst_position, is_undersampled && body.name == "sphere" ? 0.15 : 0.1);
      EXPECT_LE(felt.worst_degrees, is_undersampled ? 6 : 1);
    }
  }
}

double sinc(double x) {
  return std::abs(x) < 1e-9 ? 1 : std::sin(M_PI * x) / (M_PI * x);
}

/// The value between voxels as the sampling theorem would have it: every voxel of the scan weighted by sinc along each
/// axis, on a background (air) that goes on for ever. No filter that takes the samples as they are comes closer to what
/// was sampled, as far as that was band-limited.
double ideal_value(const io::Volume& volume, const Vec3& at) {
  const glm::ivec3 size = volume.geometry.dimensions;
  const Vec3 index = volume.geometry.to_index(at);
  std::array<std::vector<double>, 3> weights;
  for (int axis = 0; axis < 3; ++axis) {
    for (int n = 0; n < size[axis]; ++n) {
      weights[static_cast<std::size_t>(axis)].push_back(sinc(index[axis] - n));
    }
  }
  const auto& voxels = std::get<std::vector<std::int16_t>>(volume.voxels);
  double sum = 0;
  const std::int16_t* voxel = voxels.data();
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      double row = 0;
      for (int i = 0; i < size.x; ++i, ++voxel) {
        row += weights[0][static_cast<std::size_t>(i)] * (*voxel + volume.intercept - testdata::air_hu);
      }
      sum += weights[2][static_cast<std::size_t>(k)] * weights[1][static_cast<std::size_t>(j)] * row;
    }
  }
  return testdata::air_hu + sum;
}

/// Where the ideal value of a ball is half-way, beside where that should be: largest, of the voxel's extent.
double worst_of_the_ideal(const Body& body, const testdata::Grid& grid) {
  const io::Volume volume = testdata::scan(body.phantom, testdata::make_geometry(grid));
  double worst = 0;
  for (const Spot& spot : body.spots) {
    const double middle = 0.5 * (spot.low + spot.high);
    double outside = 1, inside = -1;
    while (outside - inside > 1e-3) {
      const double between = 0.5 * (outside + inside);
      (ideal_value(volume, spot.at + between * spot.outward) < middle ? outside : inside) = between;
    }
    worst = std::max(worst, std::abs(outside) / extent_along(volume.geometry, spot.outward));
  }
  return worst;
}

/// Half of the spots anywhere on it, half near the equator, where the slices' edges are the surface's.
Body ball(double radius) {
  Body body{"ball", testdata::make_sphere(radius), {}};
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(-1, 1);
  constexpr int spots = 120;
  for (int n = 0; n < spots; ++n) {
    const double z = (n % 2 == 0 ? 1 : 0.1) * any(random);
    const double angle = M_PI * any(random);
    const double across = std::sqrt(1 - z * z);
    const Vec3 outward(across * std::cos(angle), across * std::sin(angle), z);
    body.spots.push_back({.at = radius * outward, .outward = outward, .radius = radius, .bends = 2});
  }
  return body;
}

struct FeltAndIdeal {
  Felt felt;
  double ideal = 0;
};

FeltAndIdeal of_a_ball_in_thick_slices(double radius, const Vec3& shift_mm) {
  testdata::Grid grid;
  grid.spacing = {1, 1, 5};
  const int across = static_cast<int>(2 * radius) + 12;
  grid.size = {across, across, across / 5 + 3};
  grid.center = shift_mm;
  const Body body = ball(radius);
  const FeltAndIdeal both{feel(body, grid), worst_of_the_ideal(body, grid)};
  std::printf(
      "sphere of %.0f mm, 1 x 1 x 5 mm, shifted by %.1f mm: felt within %.3f of a voxel, ideally %.3f; %.1f degrees\n",
      radius, shift_mm.z, both.felt.worst_position, both.ideal, both.felt.worst_degrees);
  return both;
}

// A slice of thickness T shows the mean over it: where a surface of radius R curves along the slices' normal, its
// middle lies T^2 / 24 R inside (0.052 mm of T = 5 mm, R = 20 mm), and half-way between two slices it stands T^2 / 8 R
// (0.156 mm) outside the line from edge to edge. An edge as wide as a voxel is sampled too coarsely within the slice as
// well: a flat wall along the voxels is found to 0.05 of one. Together that is more than a tenth.
TEST(FeltPosition, of_a_ball_in_thick_slices_is_nearly_what_the_sampling_theorem_gives) {
  if (is_sanitized) {
    GTEST_SKIP() << "numbers only, and slow: the other builds hold them";
  }
  const FeltAndIdeal small = of_a_ball_in_thick_slices(20, Vec3(0));
  const FeltAndIdeal shifted = of_a_ball_in_thick_slices(20, {0.3, 0.15, 2.5});
  EXPECT_GT(std::max(small.ideal, shifted.ideal), 0.1) << "a tenth can be had after all: hold what is felt to it";
  EXPECT_LE(small.felt.worst_position, small.ideal + 0.03);
  EXPECT_LE(shifted.felt.worst_position, shifted.ideal + 0.03);
  EXPECT_LE(of_a_ball_in_thick_slices(50, {0.3, 0.15, 2.5}).felt.worst_position, 0.1);
}

}  // namespace
}  // namespace palpate::modes
