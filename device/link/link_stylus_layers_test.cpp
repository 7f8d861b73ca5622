/// The layers of a link one by one, each reached to the exchange: a layer that another one stands in for is a layer
/// that nobody tests.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "device/testing/link_bench.h"

namespace palpate::device {
namespace {

constexpr double exchange_s = 1e-3;

/// The force stays as long as it is young enough, falls at the slew ceiling in the exchange in which it is not, and
/// comes back.
TEST(LinkStylusLayers, AForceThatIsNotRenewedEndsAtItsAge) {
  const Vec3 force(1, -2, 0.5);
  for (const double age : {0.020, 0.0075}) {
    LinkBench bench;
    const auto stylus = unthreaded(bench, {.force_age = age + 0.1 * exchange_s});
    for (int round = 0; round < 2; ++round) {
      for (int n = 0; n < 300; ++n) {
        stylus->write_force(force);
        stylus->service(exchange_s);
      }
      EXPECT_EQ(bench.force, force);
      double before = glm::length(force);
      for (int n = 1; n <= 60; ++n) {
        stylus->service(exchange_s);
        const bool is_young = n * exchange_s < age + 0.05 * exchange_s;
        const double wanted = is_young ? before : std::max(0.0, before - ceiling::slew_n_per_s * exchange_s);
        EXPECT_NEAR(glm::length(bench.force), wanted, 1e-9) << n;
        before = glm::length(bench.force);
      }
      EXPECT_EQ(bench.force, Vec3(0));
    }
    EXPECT_EQ(stylus->fault(), LinkFault::none);
  }
}

TEST(LinkStylusLayers, WhatIsNotANumberIsNoForce) {
  for (const double odd : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
    for (int axis = 0; axis < 3; ++axis) {
      LinkBench bench;
      const auto stylus = unthreaded(bench);
      push(bench, *stylus, 1, 0.01);
      Vec3 force(0, 1, 0);
      force[axis] = odd;
      stylus->write_force(force);
      stylus->service(exchange_s);
      EXPECT_EQ(bench.force, Vec3(0));
    }
  }
}

/// Each axis has a sign of its own for poses and one for forces.
TEST(LinkStylusLayers, TurnsEachAxisByItsOwnSign) {
  LinkBench bench;
  const auto stylus = unthreaded(bench, {.signs = {.position = {1, -1, 1}, .force = {-1, 1, -1}}});
  bench.position = Vec3(0.01, 0.02, 0.03);
  for (int n = 0; n < 400; ++n) {
    stylus->write_force(Vec3(1, 2, 3));
    stylus->service(exchange_s);
  }
  EXPECT_EQ(stylus->read().position, Vec3(0.01, -0.02, 0.03));
  EXPECT_EQ(bench.force, Vec3(-1, 2, -3));
}

/// A pose is new once, and of the time since the stylus was opened; a force is kept through exchanges without one.
TEST(LinkStylusLayers, APoseIsFreshOnceAndAsOldAsItIs) {
  LinkBench bench;
  bench.time = 1000;
  const auto stylus = unthreaded(bench);
  EXPECT_FALSE(stylus->read().fresh) << "there was none yet";
  for (int n = 1; n <= 3; ++n) stylus->service(exchange_s);
  const Reading reading = stylus->read();
  EXPECT_TRUE(reading.fresh);
  EXPECT_NEAR(reading.time, 3 * exchange_s, 1e-9);
  EXPECT_FALSE(stylus->read().fresh);
  bench.speaks = false;
  stylus->service(exchange_s);
  EXPECT_FALSE(stylus->read().fresh);
  EXPECT_NEAR(stylus->read().time, 3 * exchange_s, 1e-9);
}

/// Exchanges of a device that sends so many poses in a quarter of a second, evenly, for a while.
LinkFault fault_of(LinkBench& bench, LinkStylus& stylus, int poses, double seconds) {
  const int exchanges = static_cast<int>(std::lround(seconds / exchange_s));
  for (int n = 1; n <= exchanges; ++n) {
    bench.speaks = n * poses / 250 > (n - 1) * poses / 250;
    stylus.service(exchange_s);
  }
  return stylus.fault();
}

/// 30 poses in a quarter of a second are the fewest to push with; a device that is homing is not judged.
TEST(LinkStylusLayers, ADeviceThatSpeaksTooSeldomIsTooSlow) {
  LinkBench fast, slow, homing;
  EXPECT_EQ(fault_of(fast, *unthreaded(fast), 31, 3), LinkFault::none);
  const auto stylus = unthreaded(slow);
  EXPECT_EQ(fault_of(slow, *stylus, 29, 0.24), LinkFault::none) << "judged only after a quarter of a second";
  EXPECT_EQ(fault_of(slow, *stylus, 29, 1), LinkFault::slow);
  LinkBench slower;
  const auto tiring = unthreaded(slower);
  EXPECT_EQ(fault_of(slower, *tiring, 250, 1), LinkFault::none);
  EXPECT_EQ(fault_of(slower, *tiring, 25, 1), LinkFault::slow) << "what it sent before does not count";
  homing.state = State::homing;
  EXPECT_EQ(fault_of(homing, *unthreaded(homing), 29, 3), LinkFault::none);
}

/// Each clock alone: just within its limit nothing happens, just beyond it is its own fault.
TEST(LinkStylusLayers, EachDelayIsAFaultBeyondItsOwnLimit) {
  for (const double over : {-0.005, 0.005}) {
    LinkBench silent;
    const auto quiet = unthreaded(silent);
    push(silent, *quiet, 1, 0.01);
    EXPECT_EQ(fault_of(silent, *quiet, 0, 0.100 + over), over < 0 ? LinkFault::none : LinkFault::silent);

    LinkBench stopped;
    const auto still = unthreaded(stopped);
    push(stopped, *still, 1, 0.01);
    still->service(0.2 + over);
    EXPECT_EQ(still->fault(), over < 0 ? LinkFault::none : LinkFault::held_up);

    LinkBench asleep_then;
    const auto sleeper = unthreaded(asleep_then);
    push(asleep_then, *sleeper, 1, 0.01);
    asleep_s += 0.1 + over;
    sleeper->service(exchange_s);
    EXPECT_EQ(sleeper->fault(), over < 0 ? LinkFault::none : LinkFault::slept);
  }
}

/// A program that was stopped is told so: that the device was silent meanwhile, or sent few poses, is not its fault.
TEST(LinkStylusLayers, WhoWasStoppedDoesNotBlameTheDevice) {
  for (const double stopped_s : {0.21, 0.3, 0.6, 60.0}) {
    for (const bool speaks : {true, false}) {
      LinkBench bench;
      const auto stylus = unthreaded(bench);
      push(bench, *stylus, 1, 0.01);
      bench.speaks = speaks;
      stylus->service(stopped_s);
      EXPECT_EQ(stylus->fault(), LinkFault::held_up) << stopped_s;
    }
  }
}

/// A fault that the device tells is the stylus' fault, and takes the force away in the same exchange.
TEST(LinkStylusLayers, TheDevicesOwnFaultIsTold) {
  LinkBench bench;
  const auto stylus = unthreaded(bench);
  push(bench, *stylus, 1, 0.05);
  bench.state = State::fault;
  bench.fault = LinkFault::own_safety;
  push(bench, *stylus, 1, exchange_s);
  EXPECT_EQ(bench.force, Vec3(0));
  EXPECT_EQ(stylus->fault(), LinkFault::own_safety);
  EXPECT_EQ(stylus->state(), State::fault);
}

/// The motors are warmed by what they are given, not by what was asked for.
TEST(LinkStylusLayers, OnlyWhatIsGivenWarmsTheMotors) {
  LinkBench bench;
  const auto stylus = unthreaded(bench);
  stylus->write_force(Vec3(0, 8, 0));
  for (int n = 0; n < 20'000; ++n) stylus->service(exchange_s);  // too old after the first of them
  EXPECT_EQ(bench.force, Vec3(0));
  push(bench, *stylus, 8, 2.5);
  EXPECT_EQ(bench.force, Vec3(0, 8, 0));
}

/// The first fault is what is told, and nothing is pushed with until the stylus is opened anew.
TEST(LinkStylusLayers, TheFirstFaultIsKeptUntilItIsOpenedAnew) {
  LinkBench bench;
  const auto stylus = unthreaded(bench);
  push(bench, *stylus, 1, 0.1);
  bench.time = bench.time + 5;
  stylus->service(exchange_s);
  asleep_s += 30;
  push(bench, *stylus, 1, 0.1);
  EXPECT_EQ(stylus->fault(), LinkFault::held_up);
  EXPECT_EQ(stylus->state(), State::fault);
  EXPECT_EQ(bench.force, Vec3(0));
  stylus->open();
  EXPECT_EQ(stylus->fault(), LinkFault::none);
  push(bench, *stylus, 1, 0.3);
  EXPECT_EQ(stylus->state(), State::idle);
  EXPECT_EQ(bench.force, Vec3(0, 1, 0));
}

/// Nothing of before is left: no pose, no force that was asked for meanwhile, no heat of the motors.
TEST(LinkStylusLayers, OpenedAnewItKnowsNothingOfBefore) {
  LinkBench bench;
  const auto stylus = unthreaded(bench);
  bench.position = Vec3(0.01, 0, 0);
  push(bench, *stylus, 8, 20);
  ASSERT_LT(bench.force.y, 5) << "warm";
  EXPECT_EQ(stylus->read().position, Vec3(0.01, 0, 0));
  stylus->close();
  stylus->write_force(Vec3(0, 8, 0));
  stylus->open();
  const Reading reading = stylus->read();
  EXPECT_EQ(reading.position, Vec3(0));
  EXPECT_FALSE(reading.fresh);
  stylus->service(exchange_s);
  EXPECT_EQ(bench.force, Vec3(0));
  push(bench, *stylus, 8, 0.3);
  EXPECT_EQ(bench.force, Vec3(0, 8, 0));
}

/// Poses that came while the device was connected are none of the exchanges': no reading is fresh of them, and they are
/// not counted for the device's rate.
TEST(LinkStylusLayers, WhatCameBeforeItWasOpenIsNoNews) {
  LinkBench bench;
  bench.first_news = 40;
  bench.speaks = false;
  const auto stylus = unthreaded(bench);
  for (int round = 0; round < 2; ++round) {
    stylus->service(exchange_s);
    EXPECT_FALSE(stylus->read().fresh);
    EXPECT_EQ(fault_of(bench, *stylus, 29, 0.26), LinkFault::slow) << "within the first quarter of a second";
    stylus->close();
    bench.first_news += 1000;
    bench.speaks = false;
    stylus->open();
  }
}

/// A device that is idle at once, as one that has kept its home, tells no pose before it sends one: until then it
/// counts as homing, however late the first pose is. Nobody ever sees it idle at a place where it is not.
TEST(LinkStylusLayers, ItIsIdleWithItsFirstPoseAndNotBefore) {
  const Vec3 there(0.01, -0.02, 0.03);
  for (const std::uint64_t before : {0, 40}) {
    for (const int late : {0, 1, 10, 60, 90}) {  // exchanges, ms
      LinkBench bench;
      bench.first_news = before;
      bench.position = there;
      const auto stylus = unthreaded(bench);
      for (int round = 0; round < 2; ++round) {
        bench.speaks = false;
        EXPECT_EQ(stylus->state(), State::homing);
        for (int n = 0; n < late; ++n) {
          stylus->service(exchange_s);
          EXPECT_EQ(stylus->state(), State::homing) << late << " " << n;
        }
        bench.speaks = true;
        stylus->service(exchange_s);
        EXPECT_EQ(stylus->state(), State::idle) << late;
        EXPECT_EQ(stylus->read().position, there);
        bench.speaks = false;
        stylus->service(exchange_s);
        EXPECT_EQ(stylus->state(), State::idle) << "it goes on to be";
        stylus->open();
      }
    }
  }
}

/// What is told of a device that is homing, or has a fault, needs no pose.
TEST(LinkStylusLayers, OnlyIdleNeedsAPose) {
  LinkBench bench;
  bench.speaks = false;
  bench.state = State::homing;
  const auto stylus = unthreaded(bench);
  stylus->service(exchange_s);
  EXPECT_EQ(stylus->state(), State::homing);
  bench.state = State::fault;
  bench.fault = LinkFault::unhomed;
  stylus->service(exchange_s);
  EXPECT_EQ(stylus->state(), State::fault);
}

/// A device that is lost may still take forces, and hold its last: it gets zeros in each exchange, whatever is asked
/// for, and in the first that it takes. One that has taken a zero before gets nothing more. None of these zeros counts
/// as taken, because no pose follows.
TEST(LinkStylusLayers, ADeviceThatIsLostIsGivenZeros) {
  for (const ForceAnswer first : {ForceAnswer::taken, ForceAnswer::refused, ForceAnswer::waiting}) {
    for (const double newtons : {0.5, 3.0, 8.0}) {
      LinkBench bench;
      const auto stylus = unthreaded(bench);
      push(bench, *stylus, newtons, 0.5);
      ASSERT_EQ(bench.force, Vec3(0, newtons, 0));
      bench.forces.clear();
      bench.lost = true;
      bench.answer = first;
      for (int n = 0; n < 200; ++n) {
        if (n == 20) bench.answer = ForceAnswer::taken;
        stylus->write_force(Vec3(0, newtons, 0));
        stylus->service(exchange_s);
        EXPECT_EQ(bench.force, first == ForceAnswer::taken || n >= 20 ? Vec3(0) : Vec3(0, newtons, 0)) << n;
      }
      EXPECT_EQ(stylus->fault(), LinkFault::unplugged);
      EXPECT_EQ(stylus->on_device(), OnDevice::unknown);
      for (const Vec3& force : bench.forces) EXPECT_EQ(force, Vec3(0));
    }
  }
  LinkBench at_rest;
  const auto stylus = unthreaded(at_rest);
  push(at_rest, *stylus, 0, 0.1);
  at_rest.forces.clear();
  at_rest.lost = true;
  for (int n = 0; n < 20; ++n) stylus->service(exchange_s);
  EXPECT_TRUE(at_rest.forces.empty());
  EXPECT_EQ(stylus->on_device(), OnDevice::zero_taken);
}

/// A stylus that is closed gives zeros until the device has sent two poses after the first of them, or for 50 ms; then
/// what was given is waited for.
TEST(LinkStylusLayers, ClosingGivesZerosUntilTheDeviceHasTakenThem) {
  for (const bool speaks : {true, false}) {
    LinkBench bench;
    const auto stylus = unthreaded(bench);
    push(bench, *stylus, 1, 0.3);
    ASSERT_EQ(bench.force, Vec3(0, 1, 0));
    stylus->write_force(Vec3(0, 1, 0));  // news that closing does not heed
    bench.speaks = speaks;
    bench.forces.clear();
    stylus->close();
    for (const Vec3& force : bench.forces) EXPECT_EQ(force, Vec3(0));
    if (speaks) {
      EXPECT_EQ(bench.forces.size(), 3U);
    } else {
      EXPECT_NEAR(static_cast<double>(bench.forces.size()) * exchange_s, 0.050, 1.1 * exchange_s);
    }
    EXPECT_EQ(bench.flushes, 1);
    EXPECT_EQ(bench.open, 0);
    EXPECT_EQ(stylus->state(), State::disconnected);
    stylus->close();
    EXPECT_EQ(bench.open, 0) << "twice is once";
  }
}

/// Silence, poses and pauses count from the opening on, whatever the clock says and whenever it was open before.
TEST(LinkStylusLayers, ADeviceIsJudgedFromItsOpeningOn) {
  LinkBench bench;
  bench.time = 5000;
  const auto stylus = unthreaded(bench);
  for (int round = 0; round < 2; ++round) {
    bench.speaks = false;
    for (int n = 0; n < 80; ++n) stylus->service(exchange_s);
    EXPECT_EQ(stylus->fault(), LinkFault::none);
    bench.speaks = true;
    push(bench, *stylus, 1, 1);
    EXPECT_EQ(stylus->fault(), LinkFault::none);
    stylus->close();
    bench.time = bench.time + 60;
    stylus->open();
  }
}

}  // namespace
}  // namespace palpate::device
