// Scenes of two structures: each mode acts at its own, and walls that hold together each hold at their own place, in
// any workspace.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "modes/scene/scene_json.h"
#include "modes/testing/test_rig.h"

namespace palpate::modes {
namespace {

/// What the scene "liver" and "spleen" are, and the scan's value.
class TwoStructures : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override {
    return io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::distance;
  }
  io::Sample sample(const Vec3& position_mm, io::FieldSet) const noexcept override {
    io::Sample sample;
    sample.inside = true;
    sample.value = 100;
    set_value(position_mm, sample);
    for (std::size_t n = 0; n < read_.size(); ++n) sample.distance[n] = distance_to(read_[n], position_mm);
    return sample;
  }
  /// The order in which the plan reads them.
  void read(const std::vector<std::size_t>& structures) { read_ = structures; }

 private:
  virtual io::Distance distance_to(std::size_t structure, const Vec3& position_mm) const noexcept = 0;
  virtual void set_value(const Vec3&, io::Sample&) const noexcept {}

  std::vector<std::size_t> read_;
};

io::Distance distance_to_ball(const Vec3& from_center_mm, double radius_mm) {
  const double r = glm::length(from_center_mm);
  return {.mm = radius_mm - r, .gradient = r > 0 ? -from_center_mm / r : Vec3(0)};
}

Scene scene_of_two(const std::string& modes) {
  return scene_from_json(R"({"version": 1, "structures": [{"name": "liver", "file": "seg.dcm", "segment": 1},
    {"name": "spleen", "file": "seg.dcm", "segment": 2}], "modes": [)" +
                             modes + "]}",
                         "test");
}

/// A list of two modes, and the other way round.
std::array<std::string, 2> in_either_order(const std::string& one, const std::string& other) {
  std::array<std::string, 2> lists{one, other};
  lists[0].append(", ").append(other);
  lists[1].append(", ").append(one);
  return lists;
}

/// Two balls of 20 mm.
class TwoBalls final : public TwoStructures {
 public:
  explicit TwoBalls(double apart_mm) : centers_{Vec3(-0.5 * apart_mm, 0, 0), Vec3(0.5 * apart_mm, 0, 0)} {}
  Vec3 center(std::size_t structure) const { return centers_[structure]; }

 private:
  io::Distance distance_to(std::size_t structure, const Vec3& position_mm) const noexcept override {
    return distance_to_ball(position_mm - centers_[structure], 20);
  }

  std::array<Vec3, 2> centers_;
};

/// With the structure's name in place of each $.
std::string at_structure(std::string mode, const std::string& name) {
  for (auto at = mode.find('$'); at != std::string::npos; at = mode.find('$')) mode.replace(at, 1, name);
  return mode;
}

/// The forces on a way through the ball of a structure, out of its middle.
std::vector<Vec3> forces_through(std::size_t structure, const std::string& modes) {
  TwoBalls source(200);
  testing::Hand hand(scene_of_two(modes), source);
  source.read(hand.plan.structures);
  std::vector<Vec3> forces;
  for (int n = 0; n <= 1500; ++n) {
    hand.move_to(source.center(structure) + Vec3(30 - 0.04 * n, 3, 1));
    EXPECT_EQ(hand.result.outcome, solver::Outcome::solved) << n;
    forces.push_back(hand.force());
  }
  return forces;
}

TEST(TwoStructures, EachModeActsAtItsOwnAndOneThatIsFarAwayChangesNothing) {
  const std::array modes{R"({"type": "surface", "structure": "$", "strength_n": 1.5})",
                         R"({"type": "surface", "structure": "$", "side": "leaving", "level_mm": 4, "strength_n": 1})",
                         R"({"type": "keep_out", "structure": "$", "margin_mm": 5, "strength_n": 2})",
                         R"({"type": "friction", "strength_n": 0.3, "gates":
                             [{"of": "distance_mm", "structure": "$", "nodes": [[0, 0], [1, 1]]}]})",
                         R"({"type": "friction", "strength_n":
                             {"of": "distance_mm", "structure": "$", "nodes": [[0, 0], [10, 0.5]]}})",
                         R"({"type": "keep_in", "structure": "$", "strength_n": 2})"};
  const std::array<std::string, 2> names{"liver", "spleen"};
  for (const std::size_t structure : {0U, 1U}) {
    for (const std::string here : modes) {
      const std::string near = at_structure(here, names[structure]);
      const std::vector<Vec3> alone = forces_through(structure, near);
      EXPECT_TRUE(std::ranges::any_of(alone, [](const Vec3& force) { return glm::length(force) > 0.2; })) << near;
      for (const std::string there : modes) {
        if (there.find("keep_in") != std::string::npos) continue;  // felt wherever the hand is outside
        const std::string far = at_structure(there, names[1 - structure]);
        for (const std::string& both : in_either_order(near, far)) {
          const std::vector<Vec3> forces = forces_through(structure, both);
          double most = 0;
          for (std::size_t n = 0; n < alone.size(); ++n) most = std::max(most, glm::distance(forces[n], alone[n]));
          EXPECT_LT(most, 1e-9) << both;
        }
      }
    }
  }
}

/// Where two organs touch, a hand that presses into the cleft is held by both walls, and every tick is solved.
TEST(TwoStructures, BothHoldWhereTheyTouch) {
  TwoBalls source(39);
  testing::Hand hand(scene_of_two(R"({"type": "surface", "structure": "liver", "strength_n": 2},
                                     {"type": "surface", "structure": "spleen", "strength_n": 2})"),
                     source);
  source.read(hand.plan.structures);
  for (int n = 0; n <= 1800; ++n) {
    hand.move_to({0.3 * std::sin(0.01 * n), 0, 12 - 0.005 * n});
    ASSERT_EQ(hand.result.outcome, solver::Outcome::solved) << n;
  }
  EXPECT_NEAR(glm::distance(hand.proxy_mm(), source.center(0)), 20, 0.11);
  EXPECT_NEAR(glm::distance(hand.proxy_mm(), source.center(1)), 20, 0.11);
  const double cleft_mm = std::sqrt(20.0 * 20 - 19.5 * 19.5);
  EXPECT_NEAR(hand.force().z, 0.4 * (cleft_mm - 3), 0.1);
}

/// A bowl is the inside of the liver, 25 mm round the origin. A flat floor 15 mm below its middle is the spleen's
/// surface and a boundary of the scan.
class BowlWithFloor final : public TwoStructures {
 public:
  static constexpr double radius_mm = 25, floor_mm = -15;

 private:
  io::Distance distance_to(std::size_t structure, const Vec3& position_mm) const noexcept override {
    return structure == 0 ? distance_to_ball(position_mm, radius_mm)
                          : io::Distance{.mm = floor_mm - position_mm.z, .gradient = {0, 0, -1}};
  }
  void set_value(const Vec3& position_mm, io::Sample& sample) const noexcept override {
    sample.value = floor_mm - position_mm.z;
    sample.gradient = {0, 0, -1};
  }
};

const std::string bowl = R"({"type": "surface", "structure": "liver", "side": "leaving", "strength_n": 3})";
const std::array<std::string, 2> floors{
    R"({"type": "surface", "structure": "spleen", "strength_n": 3})",
    R"({"type": "surface", "strength_n": {"of": "value", "nodes": [[0, 0], [0.1, 3]]}})"};

/// Scenes with both walls, in either order.
std::vector<Scene> scenes_with_both_walls() {
  std::vector<Scene> scenes;
  for (const std::string& floor : floors) {
    for (const std::string& modes : in_either_order(bowl, floor)) {
      scenes.push_back(scene_of_two(modes));
      scenes.back().subdivision.most = 1;
    }
  }
  return scenes;
}

/// A probe that presses on both walls where they meet, a circle of 20 mm: 1.5 mm into the bowl and 1 mm into the floor.
Vec3 into_both_walls(double angle) {
  return {21.2 * std::cos(angle), 21.2 * std::sin(angle), -16.9};
}

/// A hand that came from the middle and presses on both.
struct HandOnBothWalls {
  explicit HandOnBothWalls(const Scene& scene) : hand(scene, source) {
    source.read(hand.plan.structures);
    hand.stroke({0, 0, 0}, into_both_walls(0), 3000);
  }

  BowlWithFloor source;
  testing::Hand hand;
};

TEST(TwoStructures, WallsThatHoldTogetherAreNotWorkedThrough) {
  for (const Scene& scene : scenes_with_both_walls()) {
    HandOnBothWalls both(scene);
    testing::Hand& hand = both.hand;
    for (int n = 0; n < 3000; ++n) {  // nine times round
      hand.move_to(into_both_walls(0.02 * n));
      ASSERT_EQ(hand.result.hold, HoldState::held) << n;
      ASSERT_NEAR(glm::length(hand.proxy_mm()), BowlWithFloor::radius_mm, 0.2) << n;
      ASSERT_NEAR(hand.proxy_mm().z, BowlWithFloor::floor_mm, 0.2) << n;
    }
  }
}

/// While a wall holds, its plane stands where the wall began to hold, however far the other wall has to bring its own
/// back.
TEST(TwoStructures, EachPlaneStandsAtItsOwnWall) {
  for (const Scene& scene : scenes_with_both_walls()) {
    HandOnBothWalls both(scene);
    testing::Hand& hand = both.hand;
    int held = 0;
    for (int n = 0; n < 300; ++n) {
      hand.move_to(into_both_walls(0.05 * n));
      for (std::size_t i = 0; i < hand.result.primitives.size(); ++i) {
        const Mode& mode = scene.modes[hand.result.mode_of[i]];
        const ActiveMode& active = hand.plan.modes[hand.result.mode_of[i]];
        const HeldSurface& surface = active.structure < 0
                                         ? hand.touch.contact.scan
                                         : hand.touch.contact.structure[static_cast<std::size_t>(active.structure)];
        if (surface.before != HoldState::held) continue;
        ++held;
        const Vec3 position_mm = hand.plan.workspace.to_patient(hand.result.primitives[i].position);
        const Vec3 outward = -hand.plan.workspace.direction_to_patient(hand.result.primitives[i].direction);
        const double level = mode.structure == "liver" ? BowlWithFloor::radius_mm - glm::dot(position_mm, outward)
                                                       : BowlWithFloor::floor_mm - position_mm.z;
        EXPECT_NEAR(level, surface.held_level, mode.structure == "liver" ? 2e-3 : 1e-9) << mode.structure << n;
      }
    }
    EXPECT_GT(held, 500);
  }
}

/// Turned, moved and scaled, with a stiffness that makes a mm of patient as hard as before, everything in the patient
/// is as it was.
TEST(TwoStructures, AreFeltTheSameInEveryWorkspace) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto any_vector = [&] {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(x, y, z);
  };
  for (const double mm_per_m : {250.0, 500.0, 1000.0, 2000.0, 4000.0}) {
    Workspace workspace;
    const Vec3 x = glm::normalize(any_vector()), y = glm::normalize(glm::cross(x, any_vector()));
    workspace.rotation = glm::dmat3(x, y, glm::cross(x, y));
    workspace.center_mm = 30.0 * any_vector();
    workspace.mm_per_m = mm_per_m;
    for (const Scene& scene : scenes_with_both_walls()) {
      Scene scaled = scene;
      scaled.stiffness_n_per_m *= mm_per_m / Workspace{}.mm_per_m;
      BowlWithFloor source;
      testing::Hand plain(scene, source), mapped(scaled, source, workspace);
      source.read(plain.plan.structures);
      plain.stroke({0, 0, 0}, into_both_walls(0), 3000);
      for (int n = 0; n < 300; ++n) {
        mapped.touch = testing::seen_in(workspace, plain.touch);  // so that rounding does not grow from tick to tick
        plain.move_to(into_both_walls(0.05 * n));
        mapped.move_to(into_both_walls(0.05 * n));
        ASSERT_LT(glm::distance(plain.proxy_mm(), mapped.proxy_mm()), 1e-6) << mm_per_m << ", " << n;
        ASSERT_LT(glm::distance(plain.force(), mapped.force()), 1e-6) << mm_per_m << ", " << n;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::modes
