// What scenes make of structures: laws on a ball whose distance is known, one for each use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>
#include <tuple>

#include "modes/scene/scene_json.h"
#include "modes/testing/test_rig.h"

namespace palpate::modes {
namespace {

using testing::Hand;
using ::testing::HasSubstr;

/// A ball of 20 mm around the origin is structure 0. The scan's value rises along x by 2.5 a mm, and is 50 in the
/// middle: 100 where x leaves the ball, and 0 on the other side.
class BallSource final : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override {
    return io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::distance;
  }
  io::Sample sample(const Vec3& position_mm, io::FieldSet) const noexcept override {
    io::Sample sample;
    sample.inside = true;
    sample.value = 50 + 2.5 * position_mm.x;
    sample.gradient = {2.5, 0, 0};
    const double r = glm::length(position_mm);
    sample.distance[0] = {.mm = 20 - r, .gradient = r > 0 ? -position_mm / r : Vec3(0)};
    return sample;
  }
};

Scene scene_with(const std::string& mode) {
  return scene_from_json(R"({"version": 1, "structures": [{"name": "liver", "file": "seg.dcm", "segment": 1},
    {"name": "spleen", "file": "seg.dcm", "segment": "Spleen"}], "modes": [)" +
                             mode + "]}",
                         "test");
}

TEST(StructureLaw, ASurfaceIsFeltAtItsEdge) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "surface", "structure": "liver", "strength_n": 1.5})"), source);
  hand.stroke({30, 0, 0}, {19, 0, 0}, 1100);
  EXPECT_NEAR(glm::length(hand.proxy_mm()), 20, 0.11);
  EXPECT_NEAR(hand.force().x, 0.4 * (20 - 19), 0.05);
  hand.stroke({19, 0, 0}, {14, 0, 0}, 500);  // through the wall: it held at most 1.5 N
  EXPECT_NEAR(glm::length(hand.force()), 0, 1e-9);
  hand.stroke({14, 0, 0}, {30, 0, 0}, 1600);  // leaving is not resisted
  EXPECT_NEAR(glm::length(hand.force()), 0, 1e-9);
}

TEST(StructureLaw, ASurfaceThatIsLeftHoldsFromInside) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "surface", "structure": "liver", "side": "leaving", "strength_n": 1.5})"), source);
  hand.stroke({0, 1, 0}, {0, 21.5, 0}, 2050);
  EXPECT_NEAR(glm::length(hand.proxy_mm()), 20, 0.11);
  EXPECT_LT(hand.force().y, -0.5);
}

TEST(StructureLaw, ASurfaceOfBothSidesHoldsOnTheWayInAndOnTheWayOut) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "surface", "structure": "liver", "side": "both", "strength_n": 1.5})"), source);
  hand.stroke({0, 30, 0}, {0, 18, 0}, 1200);
  EXPECT_NEAR(glm::length(hand.proxy_mm()), 20, 0.11);
  EXPECT_NEAR(hand.force().y, 0.4 * (20 - 18), 0.05);
  hand.stroke({0, 18, 0}, {0, 10, 0}, 800);  // through it
  EXPECT_NEAR(glm::length(hand.force()), 0, 1e-9);
  hand.stroke({0, 10, 0}, {0, 22, 0}, 1200);
  EXPECT_NEAR(glm::length(hand.proxy_mm()), 20, 0.11);
  EXPECT_NEAR(hand.force().y, -0.4 * (22 - 20), 0.05);
}

/// The most that is felt on a straight way.
double most_on_the_way(Hand& hand, const Vec3& from, const Vec3& to) {
  constexpr int steps = 1600;
  double most = 0;
  for (int n = 0; n <= steps; ++n) {
    hand.move_to(from + (to - from) * (static_cast<double>(n) / steps));
    most = std::max(most, glm::length(hand.force()));
  }
  return most;
}

TEST(StructureLaw, ASurfaceIsAsStrongAsTheScanSaysWhereItIsMet) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "surface", "structure": "liver",
    "strength_n": {"of": "value", "nodes": [[0, 0.5], [100, 1.5]]}})"),
            source);
  EXPECT_NEAR(most_on_the_way(hand, {30, 0, 0}, {14, 0, 0}), 1.5, 0.03);
  EXPECT_NEAR(most_on_the_way(hand, {0, 30, 0}, {0, 14, 0}), 1.0, 0.03);
  EXPECT_NEAR(most_on_the_way(hand, {-30, 0, 0}, {-14, 0, 0}), 0.5, 0.03);
}

TEST(StructureLaw, ABoundaryOfTheScanIsGatedByAStructure) {
  // The value rises everywhere: without the gate this surface would hold at every place.
  const BallSource source;
  Hand hand(scene_with(R"({"type": "surface", "strength_n": 0.6, "gates":
    [{"of": "distance_mm", "structure": "liver", "nodes": [[0, 0], [1, 1]]}]})"),
            source);
  hand.stroke({-5, 30, 0}, {5, 30, 0}, 1000);
  EXPECT_NEAR(glm::length(hand.force()), 0, 1e-9);
  hand.stroke({-5, 10, 0}, {5, 10, 0}, 1000);
  EXPECT_NEAR(hand.force().x, -0.6, 1e-6);
  hand.stroke({5, 19.6, 0}, {5, 18.87, 0}, 100);
  hand.stroke({-5, 18.87, 0}, {5, 18.87, 0}, 1000);  // half a millimeter inside
  const double inside = 20 - glm::length(hand.proxy_mm());
  EXPECT_GT(inside, 0.3);
  EXPECT_NEAR(glm::length(hand.force()), 0.6 * inside, 0.6 * 0.02);
}

TEST(StructureLaw, ALevelMovesTheSurface) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "surface", "structure": "liver", "level_mm": -3, "strength_n": 1.5})"), source);
  hand.stroke({30, 0, 0}, {22, 0, 0}, 800);
  EXPECT_NEAR(glm::length(hand.proxy_mm()), 23, 0.11);
}

TEST(StructureLaw, DoesNotCreepWhereAHandSlidesRoundIt) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "surface", "structure": "liver", "strength_n": 3})"), source);
  hand.stroke({30, 0, 0}, {17, 0, 0}, 1300);
  const double first = glm::length(hand.force());
  for (int n = 0; n < 60000; ++n) {
    const double angle = 0.0002 * n;  // 3.4 mm/s, twice round
    hand.move_to(17.0 * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  EXPECT_NEAR(glm::length(hand.force()), first, 0.02 * first);
}

// From inside the wall is concave: each step along its tangent plane would sink into it.
TEST(StructureLaw, DoesNotCreepThroughAWallFromInside) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "surface", "structure": "liver", "side": "leaving", "strength_n": 3})"), source);
  hand.stroke({1, 0, 0}, {22, 0, 0}, 2100);
  const double first = glm::length(hand.force());
  EXPECT_GT(first, 0.7);
  for (int n = 0; n < 6000; ++n) {
    const double angle = 0.005 * n;  // 110 mm/s, almost five times round
    hand.move_to(22.0 * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  EXPECT_NEAR(glm::length(hand.force()), first, 0.05 * first);
}

TEST(StructureLaw, FrictionStandsWithItsWallWhereTheScanHasNone) {
  // So a balance of both is the analytical solver's, though the scene has surfaces of the scan as well. Steps that are
  // this long leave the round wall, and are brought back to it.
  const BallSource source;
  Hand hand(scene_with(R"({"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1.5]]}},
    {"type": "friction", "strength_n": 0.01},
    {"type": "surface", "structure": "liver", "side": "leaving", "strength_n": 3})"),
            source);
  hand.stroke({0, 1, 0}, {0, 21, 0}, 2000);
  int held = 0;
  for (int n = 0; n < 500; ++n) {
    const double angle = 0.02 * n;
    hand.move_to(21.0 * Vec3(std::sin(angle), std::cos(angle), 0));
    EXPECT_EQ(hand.result.solver, &solver::analytical_solver) << n;
    held += hand.result.hold == HoldState::held ? 1 : 0;
    for (const solver::Primitive& primitive : hand.result.primitives) {
      EXPECT_EQ(primitive.position, hand.result.anchor_m) << "of all that is placed";
    }
  }
  EXPECT_GT(held, 50);
}

TEST(StructureLaw, AGateLetsAModeActInsideOnly) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "friction", "strength_n": 0.3, "gates":
    [{"of": "distance_mm", "structure": "liver", "nodes": [[0, 0], [1, 1]]}]})"),
            source);
  hand.stroke({30, 0, 0}, {24, 0, 0}, 600);
  EXPECT_NEAR(glm::length(hand.force()), 0, 1e-9);
  hand.stroke({24, 0, 0}, {10, 0, 0}, 1400);
  EXPECT_NEAR(glm::length(hand.force()), 0.3, 1e-6);
}

TEST(StructureLaw, KeepOutIsBoundedContinuousAndZeroOutsideItsMargin) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "keep_out", "structure": "liver", "margin_mm": 3, "strength_n": 2})"), source);
  double last = 0;
  for (int n = 0; n <= 40000; ++n) {
    const Vec3 probe(30 - 0.001 * n, 0.01, 0);  // through the whole ball but for its last 10 mm
    hand.move_to(probe);
    const double force = glm::length(hand.force());
    if (glm::length(probe) > 23) {
      EXPECT_NEAR(force, 0, 1e-9) << probe.x;
    }
    EXPECT_LE(force, 2 + 1e-9) << probe.x;
    if (probe.x > 1) {
      EXPECT_LE(std::abs(force - last), 0.02) << probe.x;
    }
    last = force;
  }
}

TEST(StructureLaw, KeepOutPushesAHandThatRests) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "keep_out", "structure": "liver", "margin_mm": 3, "strength_n": 2})"), source);
  hand.stroke({30, 0, 0}, {20.5, 0, 0}, 950);
  hand.stroke({20.5, 0, 0}, {21, 0, 0}, 50);
  for (int n = 0; n < 2000; ++n) hand.move_to({21, 0, 0});
  EXPECT_GT(hand.force().x, 0.05);
  const Vec3 settled = hand.force();
  for (int n = 0; n < 100; ++n) {  // it does not ring
    hand.move_to({21, 0, 0});
    EXPECT_NEAR(hand.force().x, settled.x, 1e-6);
  }
}

// A push that is read at the old proxy and rises faster than the coupling would swing from one tick to the next.
TEST(StructureLaw, KeepOutDoesNotRingWhateverTheWorkspaceScaleAndTheStiffness) {
  const BallSource source;
  for (const double scale : {0.2, 1.0, 3.0, 10.0}) {
    for (const double stiffness : {50.0, 400.0, 2000.0}) {
      Scene scene = scene_with(R"({"type": "keep_out", "structure": "liver", "margin_mm": 5, "strength_n": 2})");
      scene.stiffness_n_per_m = stiffness;
      scene.subdivision.most_halts = 0;  // a proxy that moves in short steps would hide it
      Workspace workspace;
      workspace.mm_per_m = 1000 * scale;
      Hand hand(scene, source, workspace);
      // It begins where the strength rises most steeply: a hand that comes from outside is held by the plane.
      for (int n = 0; n < 500; ++n) hand.move_to({22.5, 0, 0});
      const double settled = hand.force().x;
      for (int n = 0; n < 50; ++n) {
        hand.move_to({22.5, 0, 0});
        EXPECT_NEAR(hand.force().x, settled, 1e-6) << scale << ", " << stiffness << " N/m, tick " << n;
      }
    }
  }
}

TEST(StructureLaw, KeepInHoldsBeforeTheWayOut) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "keep_in", "structure": "liver", "margin_mm": 4, "strength_n": 2})"), source);
  hand.stroke({1, 0, 0}, {15, 0, 0}, 1400);
  EXPECT_NEAR(glm::length(hand.force()), 0, 1e-9);
  hand.stroke({15, 0, 0}, {22, 0, 0}, 700);
  EXPECT_LT(hand.force().x, -0.5);
  EXPECT_LE(glm::length(hand.force()), 2 + 1e-9);
}

TEST(StructureLaw, KeepInIsBoundedContinuousAndZeroFartherInThanItsMargin) {
  const BallSource source;
  Hand hand(scene_with(R"({"type": "keep_in", "structure": "liver", "margin_mm": 4, "strength_n": 2})"), source);
  double last = 0;
  for (int n = 0; n <= 40000; ++n) {
    const Vec3 probe(0.01, -10 - 0.001 * n, 0);  // out of the ball, and 30 mm beyond
    hand.move_to(probe);
    const double force = glm::length(hand.force());
    if (glm::length(probe) < 16) {
      EXPECT_NEAR(force, 0, 1e-9) << probe.y;
    }
    EXPECT_LE(force, 2 + 1e-9) << probe.y;
    EXPECT_LE(std::abs(force - last), 0.02) << probe.y;
    last = force;
  }
  EXPECT_GT(last, 1.9) << "all of it outside";
}

TEST(StructurePlan, LeavesOutWhatNoModeReads) {
  const BallSource source;
  const Plan plan =
      make_plan(scene_with(R"({"type": "surface", "structure": "liver", "strength_n": 1})"), source.available(), {});
  EXPECT_EQ(plan.structures, std::vector<std::size_t>{0});
  bool said = false;
  for (const LeftOut& left : plan.left_out) said = said || left.what == "structure \"spleen\"";
  EXPECT_TRUE(said);
  EXPECT_TRUE(plan.solvers.contains(solver::analytical_solver));
  EXPECT_FALSE(plan.solvers.contains(solver::exact_solver));
}

/// Walls of one structure push along one direction; those of two can meet at any angle.
TEST(StructurePlan, KeepsTheGeneralSolverWhereWallsOfTwoStructuresCanMeet) {
  const auto needs_exact = [](std::string modes, const std::string& more) {
    modes.append(", ").append(more);
    return make_plan(scene_with(modes), BallSource().available(), {}).solvers.contains(solver::exact_solver);
  };
  const std::string liver = R"({"type": "surface", "structure": "liver", "strength_n": 1})";
  const std::string spleen = R"({"type": "surface", "structure": "spleen", "strength_n": 1})";
  const std::string out_of_liver = R"({"type": "keep_out", "structure": "liver", "strength_n": 1})";
  const std::string in_spleen = R"({"type": "keep_in", "structure": "spleen", "strength_n": 1})";
  const std::string scan = R"({"type": "surface", "strength_n": 1})";
  const std::string friction = R"({"type": "friction", "strength_n": 1, "gates":
    [{"of": "distance_mm", "structure": "spleen", "nodes": [[0, 0], [1, 1]]}]})";
  for (const auto& [one, other, needed] : {std::tuple{liver, spleen, true},
                                           {out_of_liver, spleen, true},
                                           {out_of_liver, in_spleen, true},
                                           {liver, scan, true},
                                           {liver, out_of_liver, false},
                                           {spleen, in_spleen, false},
                                           {liver, friction, false},
                                           {scan, friction, false}}) {
    EXPECT_EQ(needs_exact(one, other), needed) << one << other;
    EXPECT_EQ(needs_exact(other, one), needed) << other << one;
  }
}

TEST(StructurePlan, DoesNotReadWhatOnlyModesThatAreLeftOutName) {
  const BallSource source;
  const Plan plan =
      make_plan(scene_with(R"({"type": "keep_out", "structure": "liver", "strength_n": 1, "enabled": false},
        {"type": "keep_in", "structure": "spleen", "strength_n": 1},
        {"type": "friction", "strength_n": 0, "gates": [{"of": "distance_mm", "structure": "liver", "nodes": [[0, 1]]}]})"),
                source.available(), {});
  EXPECT_EQ(plan.structures, std::vector<std::size_t>{1});
  ASSERT_EQ(plan.modes.size(), 1U);
  EXPECT_EQ(plan.modes[0].structure, 0) << "the first that is read";
  EXPECT_TRUE(std::ranges::any_of(plan.left_out, [](const LeftOut& left) {
    return left.what == "structure \"liver\"" && left.why == "no mode reads it";
  }));
}

TEST(StructureScene, KeepsItsText) {
  const Scene scene = scene_with(
      R"({"type": "surface", "structure": "liver", "level_mm": -2, "strength_n": {"of": "distance_mm", "nodes": [[0, 1], [2, 0]]}},
         {"type": "keep_in", "structure": "spleen", "margin_mm": 5, "strength_n": 1})");
  const std::string text = to_json(scene);
  EXPECT_EQ(to_json(scene_from_json(text, "again")), text);
  EXPECT_EQ(scene.modes[0].strength_structure, "liver");
}

std::string refusal_of(const std::string& mode) {
  try {
    scene_with(mode);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "not refused";
}

TEST(StructureScene, IsRefusedInWords) {
  EXPECT_EQ(refusal_of(R"({"type": "keep_out", "structure": "aorta", "strength_n": 1})"),
            "test: modes[0].structure: there is no structure \"aorta\" in structures");
  EXPECT_THAT(refusal_of(R"({"type": "keep_out", "strength_n": 1})"), HasSubstr("modes[0].structure: is missing"));
  EXPECT_THAT(refusal_of(R"({"type": "keep_out", "structure": "liver", "margin_mm": 0, "strength_n": 1})"),
              HasSubstr("modes[0].margin_mm: 0 is not a number above 0; it is in mm"));
  EXPECT_THAT(refusal_of(R"({"type": "friction", "strength_n": {"of": "distance_mm", "nodes": [[0, 1]]}})"),
              HasSubstr("modes[0].strength_n.structure: is missing"));
}

TEST(StructurePlan, RefusesMoreThanItCanRead) {
  const BallSource source;
  Scene scene;
  for (int n = 0; n < 9; ++n) {
    const std::string name = "s" + std::to_string(n);
    scene.structures.push_back({.name = name, .file = "seg.dcm", .segment = name});
    Mode mode;
    mode.type = "keep_out";
    mode.structure = name;
    mode.strength_n = TransferFunction(1.0);
    scene.modes.push_back(mode);
  }
  try {
    make_plan(scene, source.available(), {});
    FAIL() << "was planned";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "structures: more than 8 are read by modes or have a margin; switch some off");
  }
}

// What is off, or has no strength, is not read and does not count: first, last or between the others.
TEST(StructurePlan, ModesThatAreOffDoNotCountAgainstTheLimit) {
  const BallSource source;
  for (const bool by_strength : {false, true}) {
    for (std::size_t off = 0; off < 9; ++off) {
      Scene scene;
      for (std::size_t n = 0; n < 9; ++n) {
        const std::string name = "s" + std::to_string(n);
        scene.structures.push_back({.name = name, .file = "seg.dcm", .segment = name});
        Mode mode;
        mode.type = "keep_out";
        mode.structure = name;
        mode.strength_n = TransferFunction(n == off && by_strength ? 0.0 : 1.0);
        mode.enabled = n != off || by_strength;
        scene.modes.push_back(mode);
      }
      const Plan plan = make_plan(scene, source.available(), {});
      EXPECT_EQ(plan.structures.size(), 8U) << off;
      EXPECT_EQ(plan.modes.size(), 8U) << off;
      EXPECT_EQ(std::ranges::count(plan.structures, off), 0) << off;
    }
  }
}

}  // namespace
}  // namespace palpate::modes
