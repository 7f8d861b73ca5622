/// What a session counts, opens, closes and frees, and what it is before anything was asked of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "device/safety/fault_log.h"
#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

using testing::slab;
using testing::snapshot;

/// Counts what is done with it.
class CountedStylus final : public device::Stylus {
 public:
  device::Specification specification() const override {
    return {.name = "counted", .maximum_force = 1e9, .stiffness_limit = 1e9, .rate = rate_hz};
  }
  void open() override { ++opened; }
  void close() noexcept override { ++closed; }
  device::Reading read() noexcept override {
    time_s += 1 / rate_hz;
    return {.time = time_s, .position = position_m, .buttons = buttons, .fresh = true, .orientation = turned};
  }
  void write_force(const device::Vec3& force) noexcept override { force_n = force; }
  device::State state() const noexcept override { return its_state; }

  double rate_hz = 1000, time_s = 0;
  int opened = 0, closed = 0;
  std::uint32_t buttons = 0;
  device::Vec3 position_m{0, 0.02, 0}, force_n{0};
  device::State its_state = device::State::idle;
  glm::dquat turned{1, 0, 0, 0};
};

void tick_many(Session& session, int ticks) {
  for (int n = 0; n < ticks; ++n) session.tick();
}

TEST(SessionNumbers, EachStylusIsOpenedOnceAndClosedOnce) {
  std::vector<std::shared_ptr<CountedStylus>> styluses;
  for (int n = 0; n < 4; ++n) styluses.push_back(std::make_shared<CountedStylus>());
  {
    Session session(snapshot("ct-bone", slab()), styluses[0]);
    EXPECT_EQ(styluses[0]->opened, 1);
    EXPECT_TRUE(session.holds_stylus(0));
    EXPECT_FALSE(session.holds_stylus(1));
    EXPECT_EQ(session.tick().stylus_epoch, 0U);
    EXPECT_EQ(session.change_stylus(styluses[1]), 1U);
    EXPECT_EQ(styluses[1]->opened, 1) << "here, not by the servo";
    tick_many(session, 200);
    EXPECT_TRUE(session.holds_stylus(1));
    EXPECT_FALSE(session.holds_stylus(0));
    EXPECT_EQ(session.tick().stylus_epoch, 1U);
    EXPECT_EQ(styluses[0]->closed, 0) << "nor closed by it";
    EXPECT_EQ(session.change_stylus(styluses[2]), 2U) << "which frees what is over";
    EXPECT_EQ(styluses[0]->closed, 1);
    EXPECT_EQ(session.change_stylus(styluses[3]), 3U);
    EXPECT_EQ(styluses[2]->closed, 1) << "never held: another came before the servo took it";
    tick_many(session, 200);
    EXPECT_EQ(session.tick().stylus_epoch, 3U);
  }
  for (const auto& stylus : styluses) {
    EXPECT_EQ(stylus->opened, 1);
    EXPECT_EQ(stylus->closed, 1);
    EXPECT_EQ(stylus->force_n, device::Vec3(0));
  }
}

TEST(SessionNumbers, ScenesAreCountedAndFreedByThePublishThatComesAfter) {
  Session session(snapshot("ct-bone", slab(), 0.05), std::make_shared<CountedStylus>());
  EXPECT_EQ(session.tick().scene_epoch, 0U);
  std::vector<std::weak_ptr<const io::FieldSource>> sources(1);
  for (std::uint32_t n = 1; n <= 5; ++n) {
    auto source = slab(0.1 * n);
    sources.emplace_back(source);
    EXPECT_EQ(session.publish(snapshot("ct-bone", source, 0.05)), n);
    source.reset();
    for (std::size_t of = 1; of <= n; ++of) EXPECT_EQ(sources[of].expired(), of + 1 < n) << of << " at " << n;
    tick_many(session, 100);
    EXPECT_EQ(session.tick().scene_epoch, n);
    EXPECT_EQ(session.tick().change_part, 1);
  }
}

/// A change of stylus frees a scene that is over, as a publish does.
TEST(SessionNumbers, AStylusThatChangesFreesWhatIsOver) {
  auto source = slab();
  const std::weak_ptr<const io::FieldSource> old = source;
  Session session(snapshot("ct-bone", source, 0.05), std::make_shared<CountedStylus>());
  source.reset();
  session.publish(snapshot("ct-bone", slab(1), 0.05));
  tick_many(session, 100);
  EXPECT_FALSE(old.expired());
  session.change_stylus(nullptr);
  EXPECT_TRUE(old.expired());
}

/// A change that takes no time is there in the next tick.
TEST(SessionNumbers, AChangeWithoutTimeIsThereAtOnce) {
  Session session(snapshot("ct-bone", slab()), std::make_shared<CountedStylus>());
  tick_many(session, 5);
  session.publish(snapshot("ct-bone", slab(1), 0));
  const TickRecord& tick = session.tick();
  EXPECT_EQ(tick.scene_epoch, 1U);
  EXPECT_EQ(tick.change_part, 1);
  session.publish(snapshot("ct-bone", slab(2), 0));
  EXPECT_EQ(session.tick().scene_epoch, 2U) << "and the next one can come";
}

/// By itself a session ticks at its first stylus' rate, with a heartbeat in each tick and none missed.
TEST(SessionNumbers, ByItselfItTicksAtItsStylusRate) {
  for (const double rate_hz : {333.0, 1000.0, 4000.0}) {
    const auto stylus = std::make_shared<CountedStylus>();
    stylus->rate_hz = rate_hz;
    Session session(snapshot("ct-bone", slab()), stylus);
    for (int n = 0; n < 50; ++n) {
      const TickRecord& tick = session.tick();
      ASSERT_EQ(tick.index, static_cast<std::uint64_t>(n));
      ASSERT_NEAR(tick.time_s, n / rate_hz, 1e-12);
      ASSERT_NEAR(tick.dt_s, n == 0 ? 0 : 1 / rate_hz, 1e-12);
      ASSERT_EQ(tick.heartbeat_s, tick.time_s);
      ASSERT_EQ(tick.missed, 0U);
      ASSERT_EQ(tick.late_ns, 0U);
      ASSERT_EQ(tick.buttons, 0U);
    }
  }
}

TEST(SessionNumbers, ButtonsAreTheStylusAndThePanelsTogether) {
  const auto stylus = std::make_shared<CountedStylus>();
  Session session(snapshot("ct-bone", slab()), stylus);
  for (const std::uint32_t of_stylus : {0U, 1U, 2U, 6U}) {
    for (const std::uint32_t of_panel : {0U, 2U, 9U}) {
      stylus->buttons = of_stylus;
      session.press(of_panel);
      for (int n = 0; n < 3; ++n) EXPECT_EQ(session.tick().buttons, of_stylus | of_panel);
    }
  }
}

TEST(SessionNumbers, TheOrientationIsTheStylusOrUpright) {
  const auto stylus = std::make_shared<CountedStylus>();
  stylus->turned = {0.5, 0.5, -0.5, 0.5};
  Session session(snapshot("ct-bone", slab()), stylus);
  EXPECT_EQ(session.orientation(), glm::dquat(1, 0, 0, 0)) << "before the first tick";
  session.tick();
  EXPECT_EQ(session.orientation(), stylus->turned);
}

/// Each limit of a scene in the filter's unit, and the device's own.
TEST(SessionNumbers, LimitsAreTheScenesInTheFiltersUnits) {
  const device::SafetyLimits limits = limits_for(
      {.force_n = 1.5, .slew_n_per_ms = 0.25, .ramp_s = 0.75, .speed_m_per_s = 0.875}, {.maximum_force = 7.25});
  EXPECT_EQ(limits.force, 1.5);
  EXPECT_EQ(limits.device_force, 7.25);
  EXPECT_EQ(limits.slew, 250) << "N/s";
  EXPECT_EQ(limits.ramp_time, 0.75);
  EXPECT_EQ(limits.speed, 0.875);
  EXPECT_EQ(limits.heartbeat_time, device::SafetyLimits().heartbeat_time) << "no scene's to change";
}

/// Each fault is found once, with the ticks before it, by whichever call comes first; the next one is found again.
TEST(SessionNumbers, EachFaultIsFoundOnceWithItsTicks) {
  const auto stylus = std::make_shared<CountedStylus>();
  stylus->position_m = {0, -0.002, 0};
  Session session(snapshot("ct-skin-and-bone", slab()), stylus);
  EXPECT_TRUE(session.fault_ticks().empty());
  EXPECT_EQ(session.faults(), 0);
  for (int fault = 1; fault <= 3; ++fault) {
    std::vector<glm::dvec3> sent;
    for (int n = 0; n < 700; ++n) sent.push_back(vector_of(session.tick().sent_n));
    stylus->its_state = device::State::disconnected;
    const double before_s = session.tick().time_s;
    for (int n = 0; n < 120; ++n) session.tick();
    EXPECT_EQ(session.fault(), device::Fault::device_lost);
    EXPECT_EQ(session.faults(), fault - 1) << "the servo counts nothing";
    if (fault == 1) session.collect();
    if (fault == 2) session.publish(snapshot("ct-skin-and-bone", slab()));
    if (fault == 3) session.change_stylus(stylus);
    EXPECT_EQ(session.faults(), fault);
    session.collect();
    EXPECT_EQ(session.faults(), fault) << "once";
    const std::vector<device::SafetyTick>& ticks = session.fault_ticks();
    const auto first =
        std::ranges::find_if(ticks, [](const auto& one) { return one.result.fault != device::Fault::none; });
    ASSERT_EQ(ticks.end() - first, 1 + static_cast<std::ptrdiff_t>(device::FaultLog::ticks_after_fault));
    EXPECT_EQ(first->input.time, before_s);
    EXPECT_EQ(first->input.device, device::State::disconnected);
    EXPECT_EQ(first->input.reading.position, stylus->position_m);
    ASSERT_GT(first - ticks.begin(), 500);
    for (int n = 1; n <= 500; ++n)
      EXPECT_EQ((first - n)->result.force, sent[sent.size() - static_cast<std::size_t>(n)]);
    stylus->its_state = device::State::idle;
    session.clear_fault();
    session.arm();
    session.tick();
    EXPECT_EQ(session.fault(), device::Fault::none);
  }
}

/// Between two styluses there is none: nothing is pushed, and a tick says so.
TEST(SessionNumbers, WithoutAStylusNothingIsPushed) {
  const auto stylus = std::make_shared<CountedStylus>();
  stylus->position_m = {0, -0.002, 0};
  Session session(snapshot("ct-skin-and-bone", slab()), stylus);
  tick_many(session, 600);
  const std::uint32_t none = session.change_stylus(nullptr);
  tick_many(session, 100);
  ASSERT_TRUE(session.holds_stylus(none));
  for (int n = 0; n < 700; ++n) {
    const TickRecord& tick = session.tick();
    ASSERT_EQ(static_cast<device::State>(tick.stylus_state), device::State::disconnected);
    ASSERT_EQ(vector_of(tick.sent_n), glm::dvec3(0));
    ASSERT_EQ(vector_of(tick.probe_m), glm::dvec3(0));
    ASSERT_EQ(tick.fresh, 0U);
    ASSERT_EQ(tick.buttons, 0U);
  }
}

/// What the stages of a tick took are nanoseconds, which add up to the tick.
TEST(SessionNumbers, TheStagesOfATickAreItsNanoseconds) {
  using Clock = std::chrono::steady_clock;
  const auto stylus = std::make_shared<CountedStylus>();
  stylus->position_m = {0, -0.002, 0};
  Session session(snapshot("ct-skin-and-bone", slab()), stylus);
  std::vector<double> parts;  // of the time around the tick
  for (int n = 0; n < 500; ++n) {
    const auto began = Clock::now();
    const TickRecord& tick = session.tick();
    const double around_ns = std::chrono::duration<double, std::nano>(Clock::now() - began).count();
    double sum_ns = 0;
    for (const std::uint32_t ns : tick.stage_ns) sum_ns += ns;
    parts.push_back(sum_ns / around_ns);
  }
  std::ranges::sort(parts);
  EXPECT_GT(parts[250], 0.6);
  EXPECT_LT(parts[250], 1.1);
}

/// A vector field that is no number below a height.
class BrokenVectors final : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override { return io::FieldSet::value | io::FieldSet::vector; }
  io::Sample sample(const io::Vec3& at, io::FieldSet) const noexcept override {
    io::Sample sample;
    sample.inside = true;
    sample.vector = {at.z < 0 ? std::numeric_limits<double>::infinity() : 1, 0, 0};
    return sample;
  }
};

/// What cannot be solved takes the force away at once, as a force that is no number.
TEST(SessionNumbers, WhatCannotBeSolvedLetsGoAtOnce) {
  const auto source = std::make_shared<BrokenVectors>();
  const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "force", "field": "vector", "strength_n": 0.5}]})", "force");
  const auto stylus = std::make_shared<CountedStylus>();
  Session session({.plan = std::make_shared<const modes::Plan>(modes::make_plan(scene, source->available(), {})),
                   .source = source,
                   .limits = limits_for(scene.limits, stylus->specification())},
                  stylus);
  tick_many(session, 600);
  EXPECT_NEAR(glm::length(vector_of(session.tick().sent_n)), 0.5, 0.05);
  TickRecord tick;
  for (int n = 0; n < 100 && session.fault() == device::Fault::none; ++n) {
    stylus->position_m.y -= 5e-4;
    tick = session.tick();
  }
  EXPECT_EQ(fault_of(tick), device::Fault::force_not_finite);
  EXPECT_EQ(state_of(tick), device::State::fault);
  EXPECT_EQ(static_cast<solver::Outcome>(tick.outcome), solver::Outcome::refused);
  EXPECT_EQ(vector_of(tick.sent_n), glm::dvec3(0));
}

}  // namespace
}  // namespace palpate::plugin
