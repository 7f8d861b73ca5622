// Laws of keep_out and keep_in that hold for any strength, margin, gate and stiffness of the coupling: where the force
// begins, how it is shared, and that it never rises faster than the coupling bears.
#include "modes/types/keep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "modes/testing/test_rig.h"

namespace palpate::modes {
namespace {

/// A structure on the side of x < 0, whose surface is the plane x = 0. The scan's value is y.
class HalfSpaceStructure final : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override {
    return io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::distance;
  }
  io::Sample sample(const Vec3& position_mm, io::FieldSet) const noexcept override {
    io::Sample sample;
    sample.inside = true;
    sample.value = position_mm.y;
    sample.gradient = {0, 1, 0};
    sample.distance[0] = {.mm = -position_mm.x, .gradient = {-1, 0, 0}};
    return sample;
  }
};

struct Keep {
  std::string type = "keep_out";
  double strength_n = 2;
  double margin_mm = 3;
  double stiffness_n_per_m = 400;
  std::vector<Gate> gates = {};

  /// Where it is `way_mm` before the surface, on the side that it keeps the hand on.
  Vec3 before_the_surface(double way_mm, double y = 0) const { return {type == "keep_out" ? way_mm : -way_mm, y, 0}; }

  Scene scene() const {
    Scene scene = testing::scene_of({{.type = type,
                                      .strength_n = TransferFunction(strength_n),
                                      .gates = gates,
                                      .structure = "liver",
                                      .margin_mm = margin_mm}});
    scene.structures = {{.name = "liver", .file = "seg.dcm", .segment = "Liver"}};
    scene.stiffness_n_per_m = stiffness_n_per_m;
    return scene;
  }
};

/// What is placed for a proxy that is `way_mm` before the surface, N.
struct PushAndPlane {
  double push_n = 0, plane_n = 0;
};

PushAndPlane placed_at(const Keep& keep, double way_mm) {
  const HalfSpaceStructure source;
  Scene scene = keep.scene();
  scene.subdivision.most_halts = 0;  // so that the proxy is still there
  testing::Hand hand(scene, source);
  PushAndPlane placed;
  for (const solver::Primitive& primitive : hand.move_to(keep.before_the_surface(way_mm)).primitives) {
    (primitive.type == solver::PrimitiveType::plane ? placed.plane_n : placed.push_n) += primitive.strength;
  }
  return placed;
}

/// Any keep_out or keep_in that a scene may have.
Keep any_keep(std::mt19937& random) {
  const auto between = [&random](double low, double high) {
    return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(random));
  };
  Keep keep;
  keep.type = random() % 2 == 0 ? "keep_out" : "keep_in";
  keep.strength_n = between(0.05, 3);
  keep.margin_mm = between(0.5, 15);
  keep.stiffness_n_per_m = between(100, 2000);
  return keep;
}

TEST(Keep, BeginsAtItsMarginAndIsWholeAtTheSurface) {
  const HalfSpaceStructure source;
  std::mt19937 random(1);
  for (int n = 0; n < 50; ++n) {
    const Keep keep = any_keep(random);
    SCOPED_TRACE(::testing::Message() << keep.type << ", " << keep.strength_n << " N, " << keep.margin_mm << " mm");
    testing::Hand hand(keep.scene(), source);
    double first_mm = 0;
    for (int i = 1500; i > 0 && first_mm == 0; --i) {
      const double way = 0.001 * i * keep.margin_mm;
      hand.move_to(keep.before_the_surface(way));
      if (glm::length(hand.force()) > 1e-9) first_mm = way;
    }
    EXPECT_LE(first_mm, keep.margin_mm);
    EXPECT_GE(first_mm, 0.99 * keep.margin_mm);
    for (const double way : {0.0, -0.7, -30.0}) {
      const PushAndPlane placed = placed_at(keep, way);
      EXPECT_NEAR(placed.push_n + placed.plane_n, keep.strength_n, 1e-12) << way;
    }
  }
}

/// It pushes a hand that rests, and resists one that moves on: however weak it is, however wide its margin.
TEST(Keep, PushesAndResistsEverywhereWithinItsMargin) {
  std::mt19937 random(2);
  for (int n = 0; n < 200; ++n) {
    const Keep keep = any_keep(random);
    for (const double part : {0.9, 0.5, 0.1, 0.0, -1.0}) {
      const PushAndPlane placed = placed_at(keep, part * keep.margin_mm);
      EXPECT_GT(placed.push_n, 0) << keep.strength_n << " N, " << keep.margin_mm << " mm, " << part;
      EXPECT_GE(placed.plane_n, placed.push_n * (1 - 1e-12))
          << keep.strength_n << " N, " << keep.margin_mm << " mm, " << part;
    }
  }
}

/// A push that is read at the old proxy rings where it rises as fast as the coupling is stiff. It rises half as fast at
/// most, whatever the stiffness.
TEST(Keep, PushRisesHalfAsFastAsTheCouplingAtMost) {
  std::mt19937 random(3);
  double steepest = 0;
  for (int n = 0; n < 100; ++n) {
    const Keep keep = any_keep(random);
    const double step_mm = 0.01 * keep.margin_mm;
    for (int i = 100; i > -10; --i) {
      const double rise_n = placed_at(keep, (i - 1) * step_mm).push_n - placed_at(keep, i * step_mm).push_n;
      const double part = rise_n / (1e-3 * step_mm) / keep.stiffness_n_per_m;
      ASSERT_LE(part, 0.5 + 1e-9) << keep.strength_n << " N, " << keep.margin_mm << " mm, " << keep.stiffness_n_per_m;
      steepest = std::max(steepest, part);
    }
  }
  EXPECT_GT(steepest, 0.49) << "else it pushes less than it could";
}

/// Where a gate is 1 the mode is as it is without one, and where it is f, as if it were f times as strong: whatever the
/// gate is elsewhere.
TEST(Keep, GateThatIsZeroElsewhereChangesNothingHere) {
  const HalfSpaceStructure source;
  std::mt19937 random(4);
  for (int n = 0; n < 50; ++n) {
    Keep plain = any_keep(random), gated = plain;
    const double factor = std::uniform_real_distribution<double>(0.5, 2)(random);
    plain.strength_n *= factor;
    gated.gates = {{Datum::value, TransferFunction({{-1, 0}, {1, factor}})}};
    testing::Hand one(plain.scene(), source), other(gated.scene(), source);
    for (int i = 0; i < 300; ++i) {
      const Vec3 probe = plain.before_the_surface(plain.margin_mm * (1.2 - 0.01 * std::min(i, 150)), 5);
      one.move_to(probe);
      other.move_to(probe);
      ASSERT_NEAR(glm::distance(one.force(), other.force()), 0, 1e-9) << plain.strength_n << " N, " << i;
    }
    EXPECT_GT(glm::length(one.force()), 0) << "it pushes the hand that rests";
    testing::Hand elsewhere(gated.scene(), source);
    elsewhere.stroke(gated.before_the_surface(2 * gated.margin_mm, -5), gated.before_the_surface(-1, -5), 300);
    EXPECT_EQ(glm::length(elsewhere.force()), 0);
  }
}

}  // namespace
}  // namespace palpate::modes
