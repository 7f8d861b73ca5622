// Scenes, scans, time frames and styluses change while the session runs: the force is ramped, never stepped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "plugin/session/session.h"
#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;

constexpr double slew_n = 1.0;  // N in a tick of 1 ms: the limit of the safety filter

struct Watched {
  double largest_step_n = 0;
  glm::dvec3 last_n{0};
};

void tick(Session& session, int ticks, Watched& watched) {
  for (int n = 0; n < ticks; ++n) {
    const glm::dvec3 sent = vector_of(session.tick().sent_n);
    watched.largest_step_n = std::max(watched.largest_step_n, glm::length(sent - watched.last_n));
    watched.last_n = sent;
  }
}

TEST(SessionChange, AnotherSceneComesInByTheRamp) {
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()));
  Watched watched;
  tick(session, 1500, watched);
  const double pressed = glm::length(watched.last_n);
  EXPECT_GT(pressed, 0.5);
  watched.largest_step_n = 0;
  const std::uint32_t epoch = session.publish(snapshot("ct-bone", slab()));
  EXPECT_EQ(session.tick().scene_epoch, epoch);
  EXPECT_LT(session.tick().change_part, 0.02);
  tick(session, 1500, watched);
  EXPECT_EQ(session.tick().change_part, 1);
  EXPECT_LT(glm::length(watched.last_n), 0.02) << "without its skin the scene holds nothing here";
  EXPECT_LT(watched.largest_step_n, 0.1 * slew_n);
  EXPECT_EQ(session.fault(), device::Fault::none);
}

TEST(SessionChange, AnotherTimeFrameMovesTheWallAndTheProxyWithIt) {
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()));
  Watched watched;
  tick(session, 1500, watched);
  const double before = glm::length(watched.last_n);
  watched.largest_step_n = 0;
  session.publish(snapshot("ct-skin-and-bone", slab(-1.0)));
  tick(session, 1500, watched);
  // 1 mm deeper: of the hand's 3 mm into the wall 2 are left.
  EXPECT_NEAR(glm::length(watched.last_n), 2.0 / 3.0 * before, 0.1);
  EXPECT_LT(watched.largest_step_n, 0.1 * slew_n);
}

TEST(SessionChange, OfSeveralThatWaitTheLastCounts) {
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()));
  session.tick();
  session.publish(snapshot("ct-bone", slab()));
  session.tick();
  session.publish(snapshot("ct-vessels", slab()));
  const std::uint32_t last = session.publish(snapshot("ct-skin-and-bone", slab()));
  EXPECT_EQ(session.tick().scene_epoch, 1U) << "one change at a time";
  for (int n = 0; n < 320; ++n) session.tick();
  EXPECT_EQ(session.tick().scene_epoch, last);
}

TEST(SessionChange, WhatTheServoHasLeftIsFreed) {
  auto old_source = slab();
  const std::weak_ptr<const io::FieldSource> old = old_source;
  Session session(snapshot("ct-skin-and-bone", old_source), stylus(hold()));
  old_source.reset();
  session.publish(snapshot("ct-bone", slab()));
  for (int n = 0; n < 400; ++n) session.tick();
  EXPECT_FALSE(old.expired()) << "the servo frees nothing";
  session.collect();
  EXPECT_TRUE(old.expired());
}

/// The other one may be held somewhere else: that is no jump.
TEST(SessionChange, AnotherStylusStartsFromZeroForce) {
  std::vector<device::Waypoint> elsewhere = hold(-0.004);
  for (device::Waypoint& point : elsewhere) point.position.x = 0.06;
  const auto first = stylus(hold()), second = stylus(elsewhere);
  Session session(snapshot("ct-skin-and-bone", slab()), first);
  Watched watched;
  tick(session, 1500, watched);
  EXPECT_GT(glm::length(watched.last_n), 0.5);
  watched.largest_step_n = 0;
  const std::uint32_t epoch = session.change_stylus(second);
  EXPECT_FALSE(session.holds_stylus(epoch));
  tick(session, 60, watched);
  EXPECT_TRUE(session.holds_stylus(epoch));
  EXPECT_LT(glm::length(watched.last_n), 0.05) << "fallen, and hardly ramped up again";
  session.collect();
  EXPECT_EQ(first->state(), device::State::disconnected) << "closed";
  tick(session, 2000, watched);
  EXPECT_GT(glm::length(watched.last_n), 0.5);
  EXPECT_LT(watched.largest_step_n, 0.2 * slew_n);
  EXPECT_EQ(session.fault(), device::Fault::none);
}

/// What may be sent is what the stylus held now can take, from the tick that it is taken in, in both directions.
/// From the tick in which another stylus is taken, the session does to the bit what one does that begins with it then:
/// whatever was pressed with the stylus before.
TEST(SessionChange, WithAnotherStylusItIsAsOneThatBeginsWithIt) {
  Snapshot felt = snapshot("ct-skin-and-bone", slab());
  felt.limits.slew = 5;  // N/s: what a force leaves behind would be felt for a tenth of a second
  const std::vector<device::Waypoint> pressed{{.time = 0, .position = {0, 0.004, 0}},
                                              {.time = 0.2, .position = {0, -0.003, 0}},
                                              {.time = 100, .position = {0, -0.003, 0}}};
  for (const double before_y_m : {-0.004, 0.02}) {
    Session session(felt, stylus(hold(before_y_m)));
    std::unique_ptr<Session> fresh;
    double strongest_n = 0;
    for (int n = 0; n < 2000; ++n) {
      const Beat beat{.time_s = 1e-3 * n, .heartbeat_s = 1e-3 * n};
      if (n == 1000) session.change_stylus(stylus(pressed, 5));
      const TickRecord& tick = session.tick(beat);
      if (tick.stylus_epoch == 0) continue;
      if (!fresh) fresh = std::make_unique<Session>(felt, stylus(pressed, 5));
      const TickRecord& as_new = fresh->tick(beat);
      ASSERT_EQ(vector_of(tick.sent_n), vector_of(as_new.sent_n)) << n;
      ASSERT_EQ(vector_of(tick.proxy_m), vector_of(as_new.proxy_m)) << n;
      ASSERT_EQ(tick.safety, as_new.safety) << n;
      strongest_n = std::max(strongest_n, glm::length(vector_of(tick.sent_n)));
    }
    EXPECT_GT(strongest_n, 0.5);
  }
}

TEST(SessionChange, EachStylusHasItsOwnForceLimit) {
  const auto held = [](double maximum_n) {
    device::SimulatedDevice model;
    model.maximum_force = maximum_n;
    auto made = std::make_shared<device::SimulatedStylus>(model);
    made->follow(hold());
    return made;
  };
  const auto felt = snapshot("ct-skin-and-bone", slab());
  Session session(felt, held(5));
  const auto longest_n = [&](int ticks) {
    double longest = 0;
    for (int n = 0; n < ticks; ++n) longest = std::max(longest, glm::length(vector_of(session.tick().sent_n)));
    return longest;
  };
  EXPECT_GT(longest_n(2000), 0.5);
  for (const double limit : {0.3, 5.0, 0.2}) {
    const std::uint32_t epoch = session.change_stylus(held(limit));
    for (int n = 0; n < 100 && !session.holds_stylus(epoch); ++n) session.tick();
    ASSERT_TRUE(session.holds_stylus(epoch));
    const double longest = longest_n(2000);
    EXPECT_LE(longest, limit);
    EXPECT_GT(longest, std::min(0.9 * limit, 0.5)) << "reached, or nothing is shown here";
    session.collect();
  }
}

TEST(SessionChange, UnpluggedThenPluggedInAgain) {
  const auto held = stylus(hold());
  Session session(snapshot("ct-skin-and-bone", slab()), held);
  Watched watched;
  tick(session, 1500, watched);
  held->inject(device::SimulatedFault::unplugged);
  tick(session, 2, watched);
  EXPECT_EQ(glm::length(watched.last_n), 0);
  EXPECT_EQ(session.fault(), device::Fault::device_lost);
  const std::uint32_t none = session.change_stylus(nullptr);
  tick(session, 2, watched);
  ASSERT_TRUE(session.holds_stylus(none));
  held->inject(device::SimulatedFault::none);
  session.change_stylus(held);
  tick(session, 100, watched);
  EXPECT_EQ(session.fault(), device::Fault::device_lost) << "latched until the user clears it";
  session.clear_fault();
  session.arm();
  watched.largest_step_n = 0;
  tick(session, 1500, watched);
  EXPECT_GT(glm::length(watched.last_n), 0.3);
  EXPECT_LT(watched.largest_step_n, 0.1 * slew_n);
}

TEST(SessionChange, ArmingAgainForgetsWhatWasTouchedBefore) {
  // Disarmed, the hand goes from above the skin far into the bone; armed there it is not thrown out.
  const std::vector<device::Waypoint> dive{{.time = 0, .position = {0, 0.004, 0}},
                                           {.time = 1, .position = {0, -0.02, 0}},
                                           {.time = 100, .position = {0, -0.02, 0}}};
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(dive));
  session.disarm();
  Watched watched;
  tick(session, 1500, watched);
  EXPECT_EQ(glm::length(watched.last_n), 0);
  session.arm();
  tick(session, 1000, watched);
  EXPECT_LT(glm::length(watched.last_n), 0.1);
}

TEST(SessionChange, ASilentCommanderRampsTheForceToZero) {
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()));
  TickRecord tick;
  for (int n = 0; n < 4600; ++n) {
    const double time = 1e-3 * n;
    tick = session.tick({.time_s = time, .heartbeat_s = std::min(time, 2.0)});
    if (n == 3900) {
      EXPECT_GT(glm::length(vector_of(tick.sent_n)), 0.3) << "alive 1.9 s ago";
    }
  }
  EXPECT_EQ(fault_of(tick), device::Fault::commander_silent);
  EXPECT_EQ(glm::length(vector_of(tick.sent_n)), 0);
}

TEST(SessionChange, TheStagesOfATickAddUp) {
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()));
  std::uint64_t sums[stage_count] = {};
  for (int n = 0; n < 2000; ++n) {
    const TickRecord& tick = session.tick();
    for (std::size_t stage = 0; stage < stage_count; ++stage) {
      ASSERT_LT(tick.stage_ns[stage], 1000000000U) << stage_names[stage] << ": below zero, wrapped";
      sums[stage] += tick.stage_ns[stage];
    }
  }
  for (std::size_t stage = 0; stage < stage_count; ++stage) EXPECT_GT(sums[stage], 0U) << stage_names[stage];
}

}  // namespace
}  // namespace palpate::plugin
