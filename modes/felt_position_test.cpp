// Where boundaries are felt, and which way they push: the same bodies scanned straight, in thick slices, obliquely and
// under gantry tilt. The position is that of the held iso-value half-way between the two materials.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "palpate/io/volume_fields.h"
#include "palpate/modes/internal/scanned_bodies.h"
#include "palpate/modes/internal/test_rig.h"

namespace palpate::modes {
namespace {

using namespace testing;

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
    for (const NamedGrid& sampling : samplings()) {
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
