// Another workspace moves the stylus through the patient. No force may meet it on its way.

#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "plugin/recording/recording.h"
#include "plugin/recording/replay.h"
#include "plugin/session/session.h"
#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;

/// The mapping of the session's rig, moved, turned or scaled.
const std::vector<std::pair<std::string, modes::Workspace>>& workspaces() {
  static const std::vector<std::pair<std::string, modes::Workspace>> all = [] {
    std::vector<std::pair<std::string, modes::Workspace>> made{
        {"as it was", {}}, {"moved", {}}, {"turned", {}}, {"scaled", {}}, {"all", {}}};
    const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(0.6, glm::normalize(glm::dvec3(1, 2, 3))));
    made[1].second.center_mm = {0, 0, -6};
    made[2].second.rotation = turn * made[2].second.rotation;
    made[3].second.mm_per_m *= 1.7;
    made[4].second.center_mm = {3, -2, -4};
    made[4].second.rotation = turn * made[4].second.rotation;
    made[4].second.mm_per_m *= 0.8;
    return made;
  }();
  return all;
}

Snapshot placed(std::size_t workspace, double change_s = 0.3) {
  Snapshot made = snapshot("ct-skin-and-bone", slab(), change_s);
  const modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  made.plan = std::make_shared<const modes::Plan>(
      modes::make_plan(scene, made.source->available(), workspaces()[workspace].second));
  return made;
}

double sent_n(const TickRecord& tick) {
  return glm::length(vector_of(tick.sent_n));
}

/// On the skin from 0.5 to 2.5 s, above it, and from 3.5 s on again.
std::shared_ptr<device::SimulatedStylus> presses_twice(std::uint64_t seed = 1) {
  const device::Vec3 above{0, 0.02, 0}, below{0, -0.003, 0};
  return stylus({{.time = 0, .position = above},
                 {.time = 0.5, .position = below},
                 {.time = 2.5, .position = below},
                 {.time = 3, .position = above},
                 {.time = 3.5, .position = below},
                 {.time = 100, .position = below}},
                seed);
}

/// A session under test, with all its ticks.
struct MappedFeel {
  std::uint32_t publish(std::size_t workspace) {
    workspace_of.push_back(workspace);
    return session.publish(placed(workspace));
  }
  void tick(int times = 1) {
    for (int n = 0; n < times; ++n) ticks.push_back(session.tick());
  }
  bool pushes() const { return sent_n(ticks.back()) > 0.3; }
  /// The first tick with another workspace; the count of ticks if there is none.
  std::size_t changed() const {
    std::size_t n = 0;
    while (n < ticks.size() && ticks[n].scene_epoch == 0) ++n;
    return n;
  }

  /// In no tick a force acts with another workspace than in the tick before, or with one between two.
  void expect_no_move_under_a_force() const {
    for (std::size_t n = 1; n < ticks.size(); ++n) {
      const TickRecord &before = ticks[n - 1], &tick = ticks[n];
      if (workspace_of[tick.scene_epoch] == workspace_of[before.scene_epoch]) continue;
      ASSERT_EQ(tick.change_part, 1) << n;
      ASSERT_EQ(sent_n(before), 0) << n;
      ASSERT_EQ(sent_n(tick), 0) << n;
    }
  }

  Session session{placed(0), presses_twice()};
  std::vector<TickRecord> ticks;
  std::vector<std::size_t> workspace_of{0};  ///< of each epoch
};

TEST(SessionWorkspace, AnotherOneComesAtOnceAndWithoutAForce) {
  for (std::size_t to = 1; to < workspaces().size(); ++to) {
    SCOPED_TRACE(workspaces()[to].first);
    MappedFeel felt;
    felt.tick(1500);
    ASSERT_TRUE(felt.pushes());
    felt.publish(to);
    felt.tick(2500);
    const std::size_t changed = felt.changed();
    ASSERT_GT(changed, 1500U);
    EXPECT_LT(changed, 1600U) << "the force falls in a twentieth of a second";
    felt.expect_no_move_under_a_force();
    EXPECT_TRUE(felt.pushes()) << "armed again";
    EXPECT_EQ(felt.session.fault(), device::Fault::none);
  }
}

TEST(SessionWorkspace, ThatOfTheSameSceneKeepsTheForce) {
  MappedFeel felt;
  felt.tick(1500);
  felt.publish(0);
  felt.tick(900);
  for (std::size_t n = 1500; n < felt.ticks.size(); ++n) ASSERT_GT(sent_n(felt.ticks[n]), 0.3) << n;
  EXPECT_EQ(felt.changed(), 1500U);
}

/// Whatever is asked before, with and after it, and as soon as it may: in no tick a force meets the stylus on its way,
/// and at the end there is a force if that was the last that was asked.
TEST(SessionWorkspace, NoOrderOfCommandsMovesItUnderAForce) {
  const std::vector<std::pair<std::string, std::function<void(MappedFeel&)>>> commands{
      {"arm", [](MappedFeel& felt) { felt.session.arm(); }},
      {"disarm", [](MappedFeel& felt) { felt.session.disarm(); }},
      {"both", [](MappedFeel& felt) { felt.session.disarm(), felt.session.arm(); }},
      {"stylus", [](MappedFeel& felt) { felt.session.change_stylus(presses_twice(7)); }},
      {"moved", [](MappedFeel& felt) { felt.publish(1); }},
      {"all", [](MappedFeel& felt) { felt.publish(4); }},
      {"back", [](MappedFeel& felt) { felt.publish(0); }}};
  std::mt19937 random(48);
  const auto below = [&](std::size_t bound) { return static_cast<int>(random() % bound); };
  for (int round = 0; round < 24; ++round) {
    MappedFeel felt;
    felt.tick(below(2) == 0 ? 1500 : 1 + below(4));  // in full contact, or just armed
    bool armed = true;
    std::string order;
    for (int n = 2 + below(5); n > 0; --n) {
      const auto& [name, give] = commands[static_cast<std::size_t>(below(commands.size()))];
      if (name == "disarm") armed = false;
      if (name == "arm" || name == "both") armed = true;
      give(felt);
      const int ticks = below(3) == 0 ? 0 : below(70);
      order += name + " " + std::to_string(ticks) + ", ";
      felt.tick(ticks);
    }
    SCOPED_TRACE(order);
    felt.tick(4000);
    EXPECT_EQ(felt.pushes(), armed);
    felt.expect_no_move_under_a_force();
    EXPECT_EQ(felt.session.fault(), device::Fault::none);
  }
}

TEST(SessionWorkspace, OfSeveralThatWaitTheLastCounts) {
  MappedFeel felt;
  felt.tick(1500);
  felt.publish(1);
  felt.tick(3);
  felt.publish(2);
  felt.tick(3);
  const std::uint32_t last = felt.publish(4);
  felt.tick(200);
  ASSERT_LT(felt.changed(), felt.ticks.size());
  EXPECT_EQ(felt.ticks[felt.changed()].scene_epoch, last);
}

TEST(SessionWorkspace, WhatIsDisarmedMeanwhileStaysSo) {
  for (const int after : {0, 1, 20}) {
    MappedFeel felt;
    felt.tick(1500);
    felt.publish(1);
    felt.tick(after);
    felt.session.disarm();
    felt.tick(2500);
    EXPECT_LT(felt.changed(), felt.ticks.size());
    EXPECT_EQ(sent_n(felt.ticks.back()), 0) << after;
  }
}

/// A fault on the way is cleared without a force, like any other.
TEST(SessionWorkspace, AFaultMeanwhileIsClearedWithoutAForce) {
  Session session(placed(0), presses_twice());
  const auto held = presses_twice();
  session.change_stylus(held);
  for (int n = 0; n < 1500; ++n) session.tick();
  session.publish(placed(1));
  session.tick();
  held->inject(device::SimulatedFault::not_a_number);
  session.tick();
  ASSERT_EQ(session.fault(), device::Fault::pose_not_finite);
  held->inject(device::SimulatedFault::none);
  session.clear_fault();
  for (int n = 0; n < 4000; ++n) ASSERT_EQ(sent_n(session.tick()), 0) << n;
  EXPECT_EQ(session.fault(), device::Fault::none);
}

/// Against the session itself: a replay gives each command and each snapshot before the tick in which it took effect.
TEST(SessionWorkspace, IsReplayedToTheBit) {
  std::mt19937 random(7);
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    MappedFeel felt;
    Recording recording;
    const auto note = [&](std::size_t workspace) {
      recording.scenes.push_back(
          {.epoch = static_cast<std::uint32_t>(recording.scenes.size()), .scene = std::to_string(workspace)});
    };
    const auto note_stylus = [&] {
      const device::Specification held = presses_twice()->specification();
      recording.styluses.push_back(
          {static_cast<std::uint32_t>(recording.styluses.size()), held.name, held.force_axes, held.maximum_force});
    };
    note(0);
    note_stylus();
    felt.tick(1200);
    for (int n = 0; n < 8; ++n) {
      switch (random() % 5) {
        case 0:
          felt.session.arm();
          break;
        case 1:
          felt.session.disarm();
          break;
        case 2:
          note_stylus();
          felt.session.change_stylus(presses_twice(9));
          break;
        default: {
          const std::size_t to = random() % workspaces().size();
          note(to);
          felt.publish(to);
        }
      }
      felt.tick(static_cast<int>(random() % 90));
    }
    felt.tick(800);
    recording.ticks = felt.ticks;
    const Replay result = replay(recording, [](const SceneRecord& record) { return placed(std::stoul(record.scene)); });
    EXPECT_EQ(result.ticks, felt.ticks.size());
    EXPECT_EQ(result.different, 0U) << "first: " << result.first_different.value_or(0);
  }
}

/// A recording of an earlier version, in which the stylus slid to its new place, is repeated as it was.
TEST(SessionWorkspace, OfARecordingComesAsItWasRecorded) {
  Session session(placed(0), presses_twice());
  for (int n = 0; n < 1500; ++n) session.tick();
  Snapshot recorded = placed(1);
  recorded.is_replayed = true;
  session.publish(recorded);
  EXPECT_LT(session.tick().change_part, 0.1);
  for (int n = 0; n < 150; ++n) session.tick();
  EXPECT_NEAR(session.tick().change_part, 0.5, 0.02);
}

}  // namespace
}  // namespace palpate::plugin
