/// What the Haply's service may do to a force on its own: add another program's, heed ours late, brake the arm, and
/// tell that it is not calibrated. What is measured is what acts on the arm.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include "device/haply/haply_service.h"
#include "device/safety/safety_limits.h"
#include "device/testing/haply_server.h"
#include "device/testing/haply_session.h"

namespace palpate::device {
namespace {

/// A millisecond an exchange, as far as the service's clock goes.
struct HeldHaply {
  FakeHaply service;
  std::unique_ptr<LinkStylus> stylus;
  double largest_step = 0;  ///< N, of what acts, from one exchange to the next
  Vec3 acted{0};

  HeldHaply() {
    LinkStylusOptions options;
    options.threaded = false;
    stylus = make_haply_on(
        {}, [this] { return std::make_unique<FakeHaplyLink>(service); }, options);
  }
  void run(double seconds, const Vec3& force) {
    for (const double end = service.time + seconds; service.time < end;) {
      stylus->write_force(force);
      stylus->service(1e-3);
      const Vec3 acts = service.acting(service.time);
      largest_step = std::max(largest_step, glm::distance(acts, acted));
      acted = acts;
    }
  }
  void open_and_push(const Vec3& force) {
    stylus->open();
    run(0.5, force);
    ASSERT_NEAR(glm::length(acted), glm::length(force), 1e-4);
    largest_step = 0;
  }
};

Vec3 any_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return glm::normalize(Vec3(x, y, z));
}

/// The service adds up the forces of several programs. What lies neither on ours nor between ours and nothing is
/// another's; ours is taken away then, and it is said.
TEST(HaplySafety, AnotherProgramsForceIsAFault) {
  std::mt19937 random(3);
  for (const double newtons : {0.45, 0.6, 1.0, 3.0}) {
    for (int n = 0; n < 3; ++n) {
      HeldHaply one;
      // Away from ours, so that all of it is over and above.
      const Vec3 ours = any_direction(random);
      Vec3 other = any_direction(random);
      if (glm::dot(Vec3(ours.x, -ours.z, ours.y), other) < 0) other = -other;
      one.open_and_push(ours);
      one.service.others_force = newtons * other;
      one.run(0.005, ours);
      EXPECT_EQ(one.stylus->fault(), LinkFault::none);
      one.run(0.2, ours);
      EXPECT_EQ(one.stylus->fault(), newtons > 0.5 ? LinkFault::foreign_force : LinkFault::none) << newtons;
      if (newtons > 0.5) {
        EXPECT_LT(glm::distance(one.acted, one.service.others_force), 1e-9) << "ours is gone";
      }
    }
  }
  EXPECT_STREQ(name_of(LinkFault::foreign_force), "another program pushes it, too");
}

/// Also before anything is pushed.
TEST(HaplySafety, AnotherProgramsForceIsAFaultBeforeOursActs) {
  HeldHaply one;
  one.service.others_force = Vec3(0, 0, 1);
  one.stylus->open();
  one.run(0.1, Vec3(0));
  EXPECT_EQ(one.stylus->fault(), LinkFault::foreign_force);
}

/// A service that tells of a force up to three messages late, or weakens it, adds none: whatever ours does within the
/// slew ceiling.
TEST(HaplySafety, AForceThatIsToldLateOrWeakenedIsOurs) {
  std::mt19937 random(4);
  for (const int late : {0, 1, 2, 3}) {
    for (const double part : {1.0, 0.3}) {
      HaplySession session;
      session.answer(arm_at(Vec3(0)));
      std::array<Vec3, 4> sent{};
      Vec3 force(0), aim(0);
      for (int n = 0; n < 2000; ++n) {
        if (n % 20 == 0) aim = 3.0 * any_direction(random);
        const Vec3 way = aim - force;
        const double length = glm::length(way);
        force += way * std::min(1.0, length > 0 ? ceiling::slew_n_per_s * 1e-3 / length : 0);
        session.step(force);
        std::shift_right(sent.begin(), sent.end(), 1);
        sent[0] = Vec3(force.x, -force.z, force.y);
        session.answer(arm_at(Vec3(0), part * sent[static_cast<std::size_t>(late)]));
        ASSERT_EQ(session.status().fault, LinkFault::none) << late << " " << part << " " << n;
      }
    }
  }
}

/// It does not heed our forces, in a contact, and then does: what acts begins at a trial and grows by the ramp.
TEST(HaplySafety, AServiceThatHeedsForcesLateMakesNoStep) {
  for (const double deaf_s : {0.002, 0.004, 0.01, 0.02}) {
    HeldHaply one;
    one.service.heeds = false;
    one.stylus->open();
    one.run(deaf_s, Vec3(0, 3, 0));
    one.service.heeds = true;
    one.run(1, Vec3(0, 3, 0));
    EXPECT_NEAR(glm::length(one.acted), 3, 1e-4) << deaf_s;
    EXPECT_EQ(one.stylus->fault(), LinkFault::none);
    if (deaf_s > 0.006) {
      EXPECT_LT(one.largest_step, 0.21) << deaf_s;
    }
  }
}

/// The version misleads about a force's spelling: after the other one was tried no step comes either.
TEST(HaplySafety, TheOtherSpellingMakesNoStep) {
  HeldHaply one;
  one.service.spelling = "values";
  one.stylus->open();
  one.run(1, Vec3(0, 3, 0));
  EXPECT_NEAR(glm::length(one.acted), 3, 1e-4);
  EXPECT_LT(one.largest_step, 0.21);
}

/// The service's brake: while it holds nobody knows what lies beneath the hand, and when it lets go a force would come
/// back by itself. Either event alone ends it; those of another device, or of another kind, do not.
TEST(HaplySafety, ItsBrakeTakesTheForceUntilItIsOpenedAnew) {
  const struct {
    std::string type, id;
    bool ends;
  } events[] = {{"ebrake_triggered", "049D", true},   {"ebrake_released", "049D", true},
                {"ebrake_triggered", "", true},       {"ebrake_triggered", "049E", false},
                {"stall_detected", "049D", false},    {"stability_ceiling", "049D", false},
                {"fod_stage_changed", "049D", false}, {"", "049D", false}};
  for (const auto& event : events) {
    HeldHaply one;
    one.open_and_push(Vec3(0, 1, 0));
    one.service.events = {haply_safety_event(event.type, event.id)};
    one.run(0.05, Vec3(0, 1, 0));
    EXPECT_EQ(one.stylus->fault(), event.ends ? LinkFault::own_safety : LinkFault::none) << event.type;
    EXPECT_EQ(one.acted == Vec3(0), event.ends) << event.type;
    one.service.events = {haply_safety_event("ebrake_released", event.id)};
    if (!event.ends) continue;
    one.run(0.5, Vec3(0, 1, 0));
    EXPECT_EQ(one.acted, Vec3(0)) << "it does not come back by itself";
    one.stylus->open();
    one.run(0.5, Vec3(0, 1, 0));
    EXPECT_NEAR(glm::length(one.acted), 1, 1e-4);
  }
  for (const char* const nonsense :
       {"{\"name\": 3}", "{\"name\": \"device-safety-triggered\"}", "{\"name\": null, \"data\": []}",
        "{\"name\": \"device-safety-triggered\", \"data\": {\"safety_type\": 7}}"}) {
    HeldHaply one;
    one.open_and_push(Vec3(0, 1, 0));
    one.service.events = {nonsense};
    one.run(0.05, Vec3(0, 1, 0));
    EXPECT_EQ(one.stylus->fault(), LinkFault::none) << nonsense;
    EXPECT_NEAR(glm::length(one.acted), 1, 1e-4) << "an event is no answer";
  }
}

/// What the inventory tells of an arm holds until an answer tells otherwise.
TEST(HaplySafety, AnArmThatIsNotCalibratedIsNotPushed) {
  for (bool FakeHaply::*const told : {&FakeHaply::calibrated, &FakeHaply::ready}) {
    HeldHaply one;
    one.service.*told = false;
    one.service.tells_status = false;
    one.stylus->open();
    one.run(0.3, Vec3(0, 1, 0));
    EXPECT_EQ(one.stylus->state(), State::homing);
    EXPECT_EQ(one.acted, Vec3(0));
    one.service.*told = true;
    one.service.tells_status = true;
    one.run(0.1, Vec3(0));
    one.service.tells_status = false;
    one.run(0.5, Vec3(0, 1, 0));
    EXPECT_EQ(one.stylus->state(), State::idle);
    EXPECT_NEAR(glm::length(one.acted), 1, 1e-4);
  }
}

/// Once it was pushed with, an arm that is not calibrated has lost its home, however soon it is calibrated anew and
/// whatever it told of being ready meanwhile: its frame may be another one. An arm that is only not ready goes on.
TEST(HaplySafety, AnArmThatLosesItsCalibrationIsNotPushedAgainUntilItIsOpened) {
  const Vec3 force(0, 1, 0);
  for (const bool loses_calibration : {true, false}) {
    for (const bool is_ready : {true, false}) {
      for (const double lost_s : {0.002, 0.05, 0.5}) {
        HeldHaply one;
        one.open_and_push(force);
        one.service.ready = false;
        one.run(0.002, force);
        one.service.ready = is_ready;
        one.service.calibrated = !loses_calibration;
        one.run(lost_s, force);
        one.service.ready = one.service.calibrated = true;
        one.run(0.5, force);
        EXPECT_EQ(one.stylus->fault(), loses_calibration ? LinkFault::unhomed : LinkFault::none) << lost_s;
        EXPECT_NEAR(glm::length(one.acted), loses_calibration ? 0 : 1, 1e-4) << lost_s;
        if (!loses_calibration) continue;
        one.stylus->open();
        one.run(0.5, force);
        EXPECT_EQ(one.stylus->fault(), LinkFault::none);
        EXPECT_NEAR(glm::length(one.acted), 1, 1e-4) << "opened anew";
      }
    }
  }
}

/// Opened anew, one that is still not calibrated has lost nothing: it waits for its home.
TEST(HaplySafety, OpenedAnewAnArmWaitsForItsCalibration) {
  HeldHaply one;
  one.open_and_push(Vec3(0, 1, 0));
  one.service.calibrated = false;
  one.run(0.05, Vec3(0, 1, 0));
  ASSERT_EQ(one.stylus->fault(), LinkFault::unhomed);
  one.stylus->open();
  one.run(0.1, Vec3(0, 1, 0));
  EXPECT_EQ(one.stylus->state(), State::homing);
  EXPECT_EQ(one.acted, Vec3(0));
  one.service.calibrated = true;
  one.run(0.5, Vec3(0, 1, 0));
  EXPECT_NEAR(glm::length(one.acted), 1, 1e-4);
}

/// Over the service's second socket; one that is not there leaves the first as it is, and it is said.
TEST(HaplySafety, ItsBrakeIsHeardOverItsSocket) {
  HaplyServer server;
  const auto opened = [&](int events_port) {
    auto stylus =
        make_haply({.host = "127.0.0.1", .port = server.port(), .events_port = events_port, .guarded = false});
    stylus->open();
    return stylus;
  };
  const auto comes = [](const std::function<bool()>& holds) {
    for (int ms = 0; ms < 5000 && !holds(); ++ms) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return holds();
  };
  const auto deaf = opened(1);
  EXPECT_TRUE(comes([&] { return deaf->state() == State::idle; }));
  EXPECT_EQ(deaf->specification().watchdog,
            "the service ends a force that is not renewed; its emergency brake is not heard");
  deaf->close();
  const auto stylus = opened(server.events_port());
  EXPECT_EQ(stylus->specification().watchdog, "");
  ASSERT_TRUE(comes([&] { return stylus->state() == State::idle; }));
  server.tell(haply_safety_event("ebrake_triggered", "049E"));
  server.tell(haply_safety_event("ebrake_triggered"));
  EXPECT_TRUE(comes([&] { return stylus->state() == State::fault; }));
}

}  // namespace
}  // namespace palpate::device
