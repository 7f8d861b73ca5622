// The modes that read a vector field, on scanned bodies: slab, sphere, tube and wedge with a flow through them that was
// measured with the same voxels, along the scanner's axes. The flow is linear in space, which voxels show exactly
// however they lie: direction and force are held to the rounding of what is stored.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <random>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/testing/scanned_bodies.h"
#include "modes/testing/test_rig.h"

namespace palpate::modes {
namespace {

using namespace testing;

constexpr double rounding = 1e-5;

/// cm/s: along an axis, faster to one side, and around it.
Vec3 flow_at(const Vec3& at) {
  const Vec3 axis = glm::normalize(Vec3(0.2, -0.4, 1));
  return (40 + 0.6 * at.x) * axis + 0.8 * glm::cross(axis, at);
}

std::shared_ptr<const io::Volume> scan_with_flow(const Body& body, const testdata::Grid& grid) {
  auto volume = std::make_shared<io::Volume>(testdata::scan(body.phantom, testdata::make_geometry(grid)));
  const io::Geometry& g = volume->geometry;
  auto vectors = std::make_shared<io::VectorComponents>();
  vectors->to_patient = glm::dmat3(g.direction_i, g.direction_j, glm::cross(g.direction_i, g.direction_j));
  const glm::dmat3 to_scanner = glm::transpose(vectors->to_patient);
  for (int n = 0; n < 3; ++n) {
    std::vector<float> speeds;
    speeds.reserve(volume->offset(0, 0, g.dimensions.z));
    for (int slice = 0; slice < g.dimensions.z; ++slice) {
      for (int j = 0; j < g.dimensions.y; ++j) {
        for (int i = 0; i < g.dimensions.x; ++i) {
          speeds.push_back(static_cast<float>((to_scanner * flow_at(g.to_patient({i, j, slice})))[n]));
        }
      }
    }
    auto along = std::make_shared<io::Volume>();
    along->geometry = g;
    along->voxels = std::move(speeds);
    vectors->along[static_cast<std::size_t>(n)] = std::move(along);
  }
  volume->vectors = std::move(vectors);
  return volume;
}

/// Acts in what is denser than the boundary's middle, as strongly as the flow is fast.
Mode by_speed(const char* type, const Spot& spot) {
  const double step = spot.high - spot.low;
  Mode mode;
  mode.type = type;
  mode.strength_of = Datum::vector_magnitude;
  mode.strength_n = TransferFunction({{0, 0}, {100, 1}});
  mode.gates = {{Datum::value, TransferFunction({{spot.low + 0.1 * step, 0}, {spot.low + 0.25 * step, 1}})}};
  return mode;
}

void at_each_spot(const std::function<void(const Spot& spot, const io::VolumeFields& source)>& test) {
  for (const Body& body : {slab(), sphere(), tube(), wedge()}) {
    for (const NamedGrid& sampling : samplings()) {
      SCOPED_TRACE(body.name + ", " + sampling.name);
      const io::VolumeFields source(scan_with_flow(body, sampling.grid), io::FieldSet::value | io::FieldSet::vector, 0);
      for (const Spot& spot : body.spots) {
        test(spot, source);
      }
    }
  }
}

void expect_nothing_in_the_thinner(const Mode& mode, const Spot& spot, const io::VolumeFields& source) {
  Hand hand(tick_by_tick(mode), source);
  hand.move_to(spot.at + 8.0 * spot.outward);
  hand.move_to(spot.at + 7.0 * spot.outward);
  EXPECT_EQ(hand.force(), Vec3(0));
}

TEST(ScannedFlow, follow_is_free_along_the_flow_and_resists_across_it_by_its_speed) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  int slid = 0, stuck = 0;
  at_each_spot([&](const Spot& spot, const io::VolumeFields& source) {
    const Mode mode = by_speed("follow", spot);
    Hand hand(tick_by_tick(mode), source);
    hand.move_to(spot.at);
    const double x = any(random), y = any(random), z = any(random);
    const Vec3 moved = 1.7 * Vec3(x, y, z);
    hand.move_to(spot.at + moved);
    const Vec3 flow = flow_at(spot.at), q = glm::normalize(flow);
    const Vec3 pull = -stiffness_n_per_mm * (moved - q * glm::dot(q, moved));
    const double strength = 0.01 * glm::length(flow);
    (glm::length(pull) > strength ? slid : stuck) += 1;
    EXPECT_LE(glm::length(hand.force() - pull * std::min(1.0, strength / glm::length(pull))), rounding);
    expect_nothing_in_the_thinner(mode, spot, source);
  });
  EXPECT_GT(slid, 20);  // both sides of the law were met
  EXPECT_GT(stuck, 20);
}

TEST(ScannedFlow, force_pushes_along_the_flow_by_its_speed) {
  at_each_spot([](const Spot& spot, const io::VolumeFields& source) {
    const Mode mode = by_speed("force", spot);
    Hand hand(tick_by_tick(mode), source);
    hand.move_to(spot.at);
    EXPECT_LE(glm::length(hand.force() - 0.01 * flow_at(spot.at)), rounding);
    expect_nothing_in_the_thinner(mode, spot, source);
  });
}

}  // namespace
}  // namespace palpate::modes
