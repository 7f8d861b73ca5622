/// What scene and stylus allow, what was asked of the session, and what comes out at the stylus: each limit alone, in
/// its own unit, reached to the tick.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;

/// Is where the test says, and keeps what it is fed.
class Puppet final : public device::Stylus {
 public:
  device::Specification specification() const override {
    return {.name = "puppet", .maximum_force = maximum_n, .stiffness_limit = 1e9};
  }
  void open() override {}
  void close() noexcept override { closed_with_n = force_n; }
  device::Reading read() noexcept override {
    time_s += 1e-3;
    return {.time = time_s, .position = position_m, .fresh = true};
  }
  void write_force(const device::Vec3& force) noexcept override { force_n = force; }
  device::State state() const noexcept override { return device::State::idle; }

  double maximum_n = 1e9, time_s = 0;
  device::Vec3 position_m{0}, force_n{0}, closed_with_n{1e9};
};

/// A point at the origin that pulls with 50 N from anywhere, as soon as the stylus is a decimeter away.
Snapshot pull(const std::string& limits) {
  const auto source = slab();
  const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "stiffness_n_per_m": 1000, "modes": [{"type": "landmark", "shape": "point", "strength_n": 50,
          "position_mm": [0, 0, 0]}], "limits": {)" +
          limits + "}}",
      "test");
  return {.plan = std::make_shared<const modes::Plan>(modes::make_plan(scene, source->available(), {})),
          .source = source,
          .limits = limits_for(scene.limits, Puppet().specification()),
          .change_s = 0.2};
}

const device::Vec3 away_m{0.03, -0.06, 0.06};

double sent_n(Session& session) {
  return glm::length(vector_of(session.tick().sent_n));
}

TEST(SessionLimits, TheForceLimitIsTheScenesInNewtons) {
  for (const double limit : {0.4, 1.7, 2.9}) {
    const auto puppet = std::make_shared<Puppet>();
    puppet->position_m = away_m;
    Session session(pull("\"force_limit_n\": " + std::to_string(limit)), puppet);
    for (int n = 0; n < 600; ++n) EXPECT_LE(sent_n(session), limit + 1e-12);
    EXPECT_NEAR(sent_n(session), limit, 1e-12);
    EXPECT_LT(glm::distance(puppet->force_n, -limit * glm::normalize(away_m)), 1e-9) << "towards the point";
  }
}

TEST(SessionLimits, TheRampIsTheScenesInSeconds) {
  for (const double ramp_s : {0.3, 0.8}) {
    const auto puppet = std::make_shared<Puppet>();
    puppet->position_m = away_m;
    Session session(pull("\"force_limit_n\": 1, \"ramp_s\": " + std::to_string(ramp_s)), puppet);
    session.tick();
    for (int n = 1; n < 900; ++n) ASSERT_NEAR(sent_n(session), std::min(1.0, n * 1e-3 / ramp_s), 1e-9) << n;
  }
}

TEST(SessionLimits, TheSlewIsTheScenesInNewtonsInAMillisecond) {
  for (const double slew : {0.01, 0.2}) {
    const auto puppet = std::make_shared<Puppet>();
    Snapshot fast = pull("\"force_limit_n\": 2, \"slew_limit_n_per_ms\": " + std::to_string(slew));
    fast.limits.speed = 1000;
    Session session(fast, puppet);
    for (int n = 0; n < 600; ++n) ASSERT_EQ(sent_n(session), 0) << "at the point";
    puppet->position_m = away_m;
    for (int n = 1; n < 250; ++n) ASSERT_NEAR(sent_n(session), std::min(2.0, n * slew), 1e-9) << n;
  }
}

TEST(SessionLimits, TheSpeedIsTheScenesInMetersInASecond) {
  for (const double speed : {0.1, 0.6}) {
    for (const double part : {0.97, 1.03}) {
      const auto puppet = std::make_shared<Puppet>();
      Session session(pull("\"speed_limit_m_per_s\": " + std::to_string(speed)), puppet);
      for (int n = 0; n < 100; ++n) {
        puppet->position_m.z += part * speed * 1e-3;
        session.tick();
      }
      EXPECT_EQ(session.fault(), part > 1 ? device::Fault::speed_exceeded : device::Fault::none) << speed;
    }
  }
}

/// At each tick of a change what may be sent is as far between the two scenes' limits as the change has come.
TEST(SessionLimits, AChangeTakesTheForceFromOneLimitToTheOther) {
  for (const auto& [from, to] : {std::pair{0.5, 2.5}, std::pair{2.5, 0.5}}) {
    const auto puppet = std::make_shared<Puppet>();
    puppet->position_m = away_m;
    Session session(pull("\"force_limit_n\": " + std::to_string(from)), puppet);
    for (int n = 0; n < 600; ++n) session.tick();
    session.publish(pull("\"force_limit_n\": " + std::to_string(to)));
    int between = 0;
    for (int n = 0; n < 300; ++n) {
      const TickRecord& tick = session.tick();
      ASSERT_NEAR(tick.change_part, std::min(1.0, n * 1e-3 / 0.2), 1e-9) << n;
      ASSERT_NEAR(glm::length(vector_of(tick.sent_n)), from + tick.change_part * (to - from), 1e-9) << n;
      between += tick.change_part > 0 && tick.change_part < 1 ? 1 : 0;
    }
    EXPECT_GT(between, 190);
  }
}

/// Of stiffness a stylus gets what the scene asks for, as far as it can render it; without motors there is nothing to
/// ring.
TEST(SessionLimits, TheStiffnessIsTheLeastOfSceneAndStylus) {
  for (const double scene_n_per_m : {300.0, 900.0}) {
    modes::Scene scene;
    scene.stiffness_n_per_m = scene_n_per_m;
    EXPECT_EQ(stiffness_for(scene, {.force_axes = 3, .stiffness_limit = 600}), std::min(scene_n_per_m, 600.0));
    EXPECT_EQ(stiffness_for(scene, {.force_axes = 0, .stiffness_limit = 600}), scene_n_per_m);
  }
}

/// Whether the force comes back after another stylus was taken: as it was asked for last, before or while the force
/// fell; in one tick or in several.
TEST(SessionLimits, AfterAnotherStylusTheLastCommandCounts) {
  enum class Ask { nothing, arm, disarm };
  const auto ask = [](Session& session, Ask what) {
    if (what == Ask::arm) session.arm();
    if (what == Ask::disarm) session.disarm();
  };
  for (const Ask before : {Ask::arm, Ask::disarm}) {
    for (const Ask first : {Ask::nothing, Ask::arm, Ask::disarm}) {
      for (const Ask second : {Ask::nothing, Ask::arm, Ask::disarm}) {
        for (const int ticks_between : {0, 5}) {
          const auto one = std::make_shared<Puppet>(), other = std::make_shared<Puppet>();
          one->position_m = other->position_m = away_m;
          Session session(pull("\"force_limit_n\": 1"), one);
          for (int n = 0; n < 600; ++n) session.tick();
          ask(session, before);
          session.tick();
          const std::uint32_t epoch = session.change_stylus(other);
          for (int n = 0; n < 10; ++n) session.tick();
          ask(session, first);
          for (int n = 0; n < ticks_between; ++n) session.tick();
          ask(session, second);
          for (int n = 0; n < 700; ++n) session.tick();
          ASSERT_TRUE(session.holds_stylus(epoch));
          const Ask last = second != Ask::nothing ? second : first != Ask::nothing ? first : before;
          EXPECT_EQ(glm::length(other->force_n) > 0.5, last == Ask::arm)
              << static_cast<int>(before) << static_cast<int>(first) << static_cast<int>(second) << ticks_between;
        }
      }
    }
  }
}

/// A stylus is let go of with no force on it, before it is closed: also by a session that ends in mid push.
TEST(SessionLimits, TheLastForceOfAStylusIsZero) {
  const auto one = std::make_shared<Puppet>(), other = std::make_shared<Puppet>();
  one->position_m = other->position_m = away_m;
  {
    Session session(pull(""), one);
    for (int n = 0; n < 600; ++n) session.tick();
    EXPECT_GT(glm::length(one->force_n), 2);
    const std::uint32_t epoch = session.change_stylus(other);
    double before_n = glm::length(one->force_n);
    while (!session.holds_stylus(epoch)) {
      session.tick();
      const double now_n = glm::length(one->force_n);
      EXPECT_LE(now_n, before_n);
      EXPECT_LT(before_n - now_n, 0.1) << "the force falls, it is not cut off";
      before_n = now_n;
    }
    EXPECT_EQ(one->force_n, device::Vec3(0));
    session.collect();
    EXPECT_EQ(one->closed_with_n, device::Vec3(0));
    for (int n = 0; n < 600; ++n) session.tick();
    EXPECT_GT(glm::length(other->force_n), 2);
  }
  EXPECT_EQ(other->closed_with_n, device::Vec3(0));
}

/// From the moment of arming on a session is as one that has just begun: whatever the hand did before, also if it
/// rang, the same poses give the same forces.
TEST(SessionLimits, WhatWasBeforeArmingDoesNotCount) {
  const auto source = slab();
  const modes::Scene scene =
      modes::scene_from_json(R"({"version": 1, "modes": [{"type": "surface", "strength_n": 0.6}]})", "test");
  const Snapshot wall{.plan = std::make_shared<const modes::Plan>(modes::make_plan(scene, source->available(), {})),
                      .source = source,
                      .limits = limits_for(scene.limits, Puppet().specification())};
  const auto shaken_m = [](int n) { return device::Vec3(0, -1e-3 + 5e-4 * std::sin(0.6 * n), 0); };
  const auto run = [&](bool shaken_before) {
    const auto puppet = std::make_shared<Puppet>();
    Session session(wall, puppet);
    session.disarm();
    std::vector<device::Vec3> sent;
    double damped_n = 0;
    for (int n = 0; n < 1600; ++n) {
      const bool armed = n >= 800;
      if (n == 800) session.arm();
      puppet->position_m = armed || shaken_before ? shaken_m(n) : device::Vec3(0, 0.02, 0);
      const TickRecord& tick = session.tick();
      if (!armed) continue;
      sent.push_back(vector_of(tick.sent_n));
      if (n > 1400) damped_n = std::max(damped_n, glm::distance(sent.back(), vector_of(tick.force_n)));
    }
    EXPECT_GT(damped_n, 0.01) << "it rings";
    return sent;
  };
  const std::vector<device::Vec3> once = run(false), again = run(true);
  for (std::size_t n = 0; n < once.size(); ++n) ASSERT_EQ(once[n], again[n]) << n << " ms after arming";
}

/// Whatever a scene asks for, on whatever device: no limit is looser than the program's or the device's, a tighter one
/// stays as it is, and what is drawn down is said, in one sentence each: its key, what was asked for, and what is felt.
TEST(SessionLimits, ASceneOnlyTightens) {
  std::mt19937_64 random(1);
  const auto any = [&](double usual) {
    return usual * std::pow(10, std::uniform_real_distribution<double>(random() % 3 == 0 ? -9 : -1, 9)(random));
  };
  for (int n = 0; n < 3000; ++n) {
    modes::Scene scene;
    scene.stiffness_n_per_m = any(1000);
    scene.limits = {.force_n = any(1), .slew_n_per_ms = any(1), .ramp_s = 1 / any(1), .speed_m_per_s = any(1)};
    const device::Specification device{.force_axes = 3, .maximum_force = any(5), .stiffness_limit = any(1000)};
    const device::SafetyLimits limits = limits_for(scene.limits, device);
    const double force_n = std::min(limits.force, limits.device_force);
    EXPECT_EQ(force_n, std::min({scene.limits.force_n, 12.0, device.maximum_force}));
    EXPECT_EQ(limits.slew, std::min(scene.limits.slew_n_per_ms * 1e3, 1000.0));
    EXPECT_EQ(limits.ramp_time, std::max(scene.limits.ramp_s, 0.25));
    EXPECT_EQ(limits.speed, std::min(scene.limits.speed_m_per_s, 1.0));
    EXPECT_EQ(stiffness_for(scene, device), std::min({scene.stiffness_n_per_m, 3000.0, device.stiffness_limit}));
    std::string said;
    for (const Text& text : drawn_down(scene, device)) said += text + "\n";
    const auto says = [&](const char* key) { return said.find(key) != std::string::npos; };
    const auto is_drawn_down = [&](const char* key, double asked, double felt, const char* unit) {
      const bool is_told =
          says(fmt::format("limits.{} of {:g} is reduced to {:g} {},", key, asked, felt, unit).c_str());
      EXPECT_EQ(is_told, says(key)) << said;
      return is_told;
    };
    EXPECT_EQ(is_drawn_down("force_limit_n", scene.limits.force_n, force_n, "N"), force_n < scene.limits.force_n);
    EXPECT_EQ(is_drawn_down("slew_limit_n_per_ms", scene.limits.slew_n_per_ms, 1, "N/ms"),
              scene.limits.slew_n_per_ms * 1e3 > 1000);
    EXPECT_EQ(is_drawn_down("ramp_s", scene.limits.ramp_s, 0.25, "s"), scene.limits.ramp_s < 0.25);
    EXPECT_EQ(is_drawn_down("speed_limit_m_per_s", scene.limits.speed_m_per_s, 1, "m/s"),
              scene.limits.speed_m_per_s > 1);
    EXPECT_EQ(says("stiffness of"), stiffness_for(scene, device) < scene.stiffness_n_per_m);
  }
  EXPECT_TRUE(drawn_down({.limits = {.force_n = 1e9}}, {.force_axes = 0}).empty()) << "without motors";
  EXPECT_TRUE(drawn_down({}, {.maximum_force = 3.3, .stiffness_limit = 1000}).empty()) << "a scene as it is made";
}

/// 12 N one tick after arming, at 10 m/s, without a fault: that was so.
TEST(SessionLimits, AnAbsurdSceneFeelsAsTheProgramAllows) {
  const auto puppet = std::make_shared<Puppet>();
  Session session(pull("\"force_limit_n\": 1e9, \"slew_limit_n_per_ms\": 1e9, \"ramp_s\": 1e-9, "
                       "\"speed_limit_m_per_s\": 1e9"),
                  puppet);
  puppet->position_m = away_m;
  double before_n = 0;
  for (int n = 1; n <= 400; ++n) {
    const double now_n = sent_n(session);
    EXPECT_LE(now_n, std::min(12.0, 12.0 * n * 1e-3 / 0.25) + 1e-9) << n;
    EXPECT_LE(now_n - before_n, 1 + 1e-9);
    before_n = now_n;
  }
  EXPECT_NEAR(before_n, 12, 1e-9);
  puppet->position_m = {0, 0.05, 0.05};
  for (int n = 0; n < 20; ++n) {
    puppet->position_m.y += 0.010;
    session.tick();
  }
  EXPECT_EQ(session.fault(), device::Fault::speed_exceeded);
}

}  // namespace
}  // namespace palpate::plugin
