#include "device/falcon/falcon_driver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "device/testing/falcon_bench.h"

namespace palpate::device {
namespace {

using Bench = FalconBench;

TEST(FalconDriver, AStalledServoIsAnsweredWithZeros) {
  Bench bench;
  bench.home();
  bench.run(0.1, Vec3(1, 0, 0));
  const double stalled = bench.fake.time;
  while (bench.fake.time < stalled + 0.2) bench.stylus->service(1e-3);  // no read, no write
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
  EXPECT_LT(bench.fake.falcon.pushed_until() - stalled, 0.023);
  EXPECT_EQ(bench.stylus->state(), State::idle);
}

TEST(FalconDriver, ClosingLeavesZeros) {
  Bench bench;
  bench.home();
  bench.run(0.1, Vec3(1, 0, 0));
  ASSERT_TRUE(bench.fake.falcon.is_pushing());
  bench.stylus->close();
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
  EXPECT_EQ(bench.stylus->state(), State::disconnected);
  bench.stylus->close();
  bench.stylus->open();  // still homed: the Falcon has not been told otherwise
  bench.run(0.1, Vec3(1, 0, 0));
  ASSERT_TRUE(bench.fake.falcon.is_pushing());
  bench.stylus.reset();
  EXPECT_FALSE(bench.fake.falcon.is_pushing()) << "the destructor closes";
}

TEST(FalconDriver, SplitRepliesLoseNothing) {
  for (const std::size_t most : {1U, 5U, 15U}) {
    Bench bench;
    bench.home();
    bench.fake.falcon.faults.most_payload = most;
    int fresh = 0;
    bench.run(0.5, [&](const Reading& reading) {
      fresh += reading.fresh ? 1 : 0;
      return Vec3(0, 0.5, 0);
    });
    EXPECT_EQ(bench.stylus->state(), State::idle);
    EXPECT_GT(fresh, 20) << most;
    EXPECT_LT(glm::length(bench.fake.falcon.force() - Vec3(0, 0.5, 0)), 0.01);
  }
}

/// What is asked again may only be late: it is waited for, so each costs 70 ms.
TEST(FalconDriver, LostAndGarbledRepliesAreAskedForAgain) {
  for (const bool lost : {true, false}) {
    Bench bench;
    bench.home();
    (lost ? bench.fake.falcon.faults.drop_every : bench.fake.falcon.faults.garble_every) = 37;
    int fresh = 0;
    double worst_gap = 0;
    double last = 0;
    bench.run(2, [&](const Reading& reading) {
      if (reading.fresh) {
        ++fresh;
        if (last > 0) worst_gap = std::max(worst_gap, reading.time - last);
        last = reading.time;
      }
      return Vec3(0);
    });
    EXPECT_EQ(bench.stylus->fault(), LinkFault::none) << name_of(bench.stylus->fault());
    EXPECT_GT(fresh, 500);
    EXPECT_LT(worst_gap, 0.08);
  }
}

TEST(FalconDriver, NoReplyStaysInThePipeAfterADelay) {
  // Late answers must not leave the driver one exchange behind for ever.
  Bench bench;
  bench.home();
  bench.fake.falcon.faults.reply_delay = 0.030;
  bench.run(0.3);
  bench.fake.falcon.faults.reply_delay = 0;
  bench.run(0.3);
  const std::uint64_t before = bench.fake.falcon.commands();
  bench.run(1);
  EXPECT_LE(bench.fake.falcon.commands() - before, 1100U) << "two in flight would be up to 2000";
}

TEST(FalconDriver, AnImpossiblePoseIsAFaultAndNoForce) {
  Bench bench;
  bench.home();
  bench.run(0.1, Vec3(1, 0, 0));
  bench.fake.falcon.faults.impossible_pose = true;
  const double start = bench.fake.time;
  bench.run(0.1, [](const Reading& reading) {
    EXPECT_LT(glm::length(reading.position), 0.1);
    return Vec3(1, 0, 0);
  });
  EXPECT_EQ(bench.stylus->state(), State::fault);
  EXPECT_EQ(bench.stylus->fault(), LinkFault::unreachable_pose);
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
  EXPECT_LT(bench.fake.falcon.pushed_until() - start, 25e-3) << "held for 20 ms, as of a single garbled packet";
  bench.fake.falcon.faults.impossible_pose = false;
  bench.run(0.1, Vec3(1, 0, 0));
  EXPECT_EQ(bench.stylus->state(), State::fault) << "until it is opened again";
}

TEST(FalconDriver, APoseBeyondTheReachIsHeldWithoutForceUntilItIsBack) {
  Bench bench;
  bench.home();
  bench.run(0.1, Vec3(1, 0, 0));
  const Vec3 before = bench.stylus->read().position;
  bench.fake.falcon.faults.impossible_pose = true;
  bench.run(0.03, Vec3(1, 0, 0));
  EXPECT_LT(glm::distance(bench.stylus->read().position, before), 1e-3);
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
  bench.fake.falcon.faults.impossible_pose = false;
  bench.run(0.14, Vec3(1, 0, 0));
  EXPECT_FALSE(bench.fake.falcon.is_pushing()) << "a hand that trembles would be out again";
  bench.run(0.1, Vec3(1, 0, 0));
  EXPECT_EQ(bench.stylus->state(), State::idle);
  EXPECT_TRUE(bench.fake.falcon.is_pushing());
}

TEST(FalconDriver, UnpluggedAndSilentAreFaults) {
  Bench unplugged;
  unplugged.home();
  unplugged.fake.unplugged = true;
  unplugged.run(0.01, Vec3(1, 0, 0));
  EXPECT_EQ(unplugged.stylus->fault(), LinkFault::unplugged);
  unplugged.stylus->close();

  Bench silent;
  silent.home();
  silent.run(0.1, Vec3(1, 0, 0));
  silent.fake.falcon.faults.silent = true;
  silent.run(0.2, Vec3(1, 0, 0));
  EXPECT_EQ(silent.stylus->fault(), LinkFault::silent);
  silent.fake.falcon.faults.silent = false;
  silent.run(0.1, Vec3(1, 0, 0));
  EXPECT_EQ(silent.stylus->state(), State::fault);
  EXPECT_FALSE(silent.fake.falcon.is_pushing()) << "a device that comes back gets zeros";
}

TEST(FalconDriver, WorksWithItsOwnThread) {
  // The same driver, threaded: the fake's clock races ahead of the real one, so only outcomes count here.
  FakeFalconBench fake;
  LinkStylusOptions options;
  options.force_age = 1e9;
  auto stylus = make_falcon_on(
      {}, [&] { return std::make_unique<FakeFalconLink>(fake); }, options);
  stylus->open();
  for (int i = 0; i < 5000 && stylus->state() != State::idle; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(stylus->state(), State::idle);
  for (int i = 0; i < 50; ++i) {
    EXPECT_LT(glm::length(stylus->read().position), 0.06);
    stylus->write_force(Vec3(0, 0, 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  stylus->close();
  EXPECT_GT(fake.falcon.pushed_until(), 0);
  EXPECT_FALSE(fake.falcon.is_pushing());
}

/// A Falcon that has lost its home in the hand is not believed again before it is opened anew: no force, a red light.
TEST(FalconDriver, AFaultIsKeptWhateverItRepliesAfterwards) {
  FakeFalconBench bench;
  FakeFalconLink link(bench);
  FalconProtocol protocol({});
  protocol.connect(link);
  const auto flags = [](unsigned bits) { return static_cast<char>(0x41 + bits); };
  std::array<std::uint8_t, 64> command{};
  const auto exchange = [&](unsigned homed_legs) {
    const std::string reply = std::string("<") + "AAAAAAAAAAAA" + flags(homed_legs) + "A>";
    protocol.receive({reinterpret_cast<const std::uint8_t*>(reply.data()), reply.size()}, bench.time += 1e-3);
    const std::size_t size = protocol.step(Vec3(0, 2, 0), bench.time, command);
    return std::string(command.begin(), command.begin() + static_cast<std::ptrdiff_t>(size));
  };
  const std::string none = std::string("<AAAAAAAAAAAA") + flags(1 + 8) + "A>";  // the homing bit and the red light
  protocol.step(Vec3(0), bench.time, command);
  EXPECT_EQ(exchange(0), none);
  EXPECT_NE(exchange(0x70), none);
  EXPECT_EQ(protocol.status().state, State::idle);
  EXPECT_EQ(exchange(0x30), none);
  EXPECT_EQ(protocol.status().fault, LinkFault::unhomed);
  EXPECT_EQ(exchange(0x70), none);
  EXPECT_EQ(protocol.status().state, State::fault);
  EXPECT_EQ(protocol.status().fault, LinkFault::unhomed);
}

}  // namespace
}  // namespace palpate::device
