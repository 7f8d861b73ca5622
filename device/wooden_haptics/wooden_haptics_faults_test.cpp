#include "device/wooden_haptics/wooden_haptics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/device_type.h"
#include "device/link/hid.h"
#include "device/testing/fake_hidapi.h"
#include "device/testing/test_files.h"
#include "device/testing/wooden_haptics_bench.h"

namespace palpate::device {
namespace {

using Bench = WoodenHapticsBench;

TEST(WoodenHapticsDriver, ShortReportsAreRefused) {
  Bench bench;
  bench.home();
  bench.arm.faults.short_every = 20;
  bench.run(1, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::none);
  EXPECT_LT(glm::length(bench.stylus->read().position - bench.arm.hand().body().position), 0.5e-3);
}

TEST(WoodenHapticsDriver, FaultsEndInZeros) {
  Bench impossible;
  impossible.home();
  impossible.run(0.1, Vec3(0, 1, 0));
  impossible.arm.faults.impossible_pose = true;
  impossible.run(0.1, Vec3(0, 1, 0));
  EXPECT_EQ(impossible.stylus->fault(), LinkFault::unreachable_pose);
  EXPECT_FALSE(impossible.is_pushing());

  Bench unplugged;
  unplugged.home();
  unplugged.run(0.1, Vec3(0, 1, 0));
  unplugged.bench.unplugged = true;
  unplugged.run(0.01, Vec3(0, 1, 0));
  EXPECT_EQ(unplugged.stylus->fault(), LinkFault::unplugged);
  EXPECT_TRUE(unplugged.is_pushing()) << "nobody can reach it";
  unplugged.bench.time += 0.51;
  EXPECT_FALSE(unplugged.is_pushing()) << "its own watchdog of 0.5 s";

  Bench stalled;
  stalled.home();
  stalled.run(0.1, Vec3(0, 1, 0));
  for (int i = 0; i < 30; ++i) stalled.stylus->service(1e-3);
  EXPECT_FALSE(stalled.is_pushing());

  Bench closed;
  closed.home();
  closed.run(0.1, Vec3(0, 1, 0));
  ASSERT_TRUE(closed.is_pushing());
  closed.stylus->close();
  EXPECT_FALSE(closed.is_pushing());
}

/// Its reports go on while every write to it fails: a fault before its own watchdog ends the force.
TEST(WoodenHapticsDriver, AnArmThatTakesNoForcesIsAFault) {
  Bench bench;
  bench.home();
  bench.arm.faults.speaks_on = true;
  bench.run(0.1, Vec3(0, 1, 0));
  bench.bench.takes = false;
  bench.run(ceiling::stall_s - 0.01, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::none);
  bench.run(0.02, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::forces_refused);
  EXPECT_TRUE(bench.is_pushing()) << "nobody can reach it";
  EXPECT_NE(bench.stylus->on_device(), OnDevice::zero_taken) << "so its guardian is told to";
  bench.bench.takes = true;
  bench.run(0.01, Vec3(0, 1, 0));
  EXPECT_FALSE(bench.is_pushing());
}

TEST(WoodenHapticsDriver, ADeviceThatDoesNotAnswerIsRefused) {
  Bench bench;
  bench.arm.faults.silent = true;
  EXPECT_THROW(bench.stylus->open(), std::runtime_error);
  EXPECT_EQ(bench.stylus->state(), State::disconnected);
}

TEST(WoodenHapticsDriver, KeepsItsHomeWhenItIsOpenedAgain) {
  for (const std::size_t size : {8U, 14U}) {
    FakeWoodenHapticsOptions options;
    options.report_size = size;
    options.arm = arm_with_home_at(Vec3(0), size);
    options.path = {{0.5, {0, 0, 0}}, {0.8, {0.04, -0.03, 0.03}}};
    Bench bench(options);
    bench.stylus->open();
    bench.run(1.2);
    bench.stylus->close();
    bench.stylus->open();
    bench.run(0.4, Vec3(0, 1, 0));
    ASSERT_EQ(bench.stylus->state(), State::idle) << size;
    EXPECT_LT(glm::distance(bench.stylus->read().position, bench.arm.hand().body().position), 0.2e-3) << size;
    EXPECT_LT(glm::distance(bench.arm.force(), Vec3(0, 1, 0)), 0.02) << size;
  }
}

TEST(WoodenHapticsDriver, AnUnpluggedArmHasToBeHomedAgain) {
  Bench bench;
  bench.home();
  bench.bench.unplugged = true;
  bench.run(0.01);
  bench.stylus->close();
  bench.bench.unplugged = false;
  bench.stylus->open();
  bench.run(0.1, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->state(), State::homing);
  EXPECT_FALSE(bench.is_pushing());
}

/// It may have had no power meanwhile: then its counters began anew, wherever the hand was.
TEST(WoodenHapticsDriver, AnArmThatSleptOrWasSilentHasToBeHomedAgain) {
  enum class Cause { slept, slept_after_another_fault, slept_while_it_was_closed, silent };
  for (const Cause cause :
       {Cause::slept, Cause::slept_after_another_fault, Cause::slept_while_it_was_closed, Cause::silent}) {
    FakeWoodenHapticsOptions options;
    options.path = {{0.5, {0, 0, 0}}, {0.8, {0.04, -0.03, 0.03}}};
    Bench bench(options);
    bench.stylus->open();
    bench.run(1.2);
    ASSERT_EQ(bench.stylus->state(), State::idle);
    if (cause == Cause::slept_after_another_fault) bench.bench.time += 5;
    if (cause == Cause::slept_while_it_was_closed) bench.stylus->close();
    if (cause == Cause::silent) bench.arm.faults.silent = true;
    if (cause != Cause::silent) asleep_s += 30;
    if (cause != Cause::slept_while_it_was_closed) bench.run(0.2, Vec3(0, 1, 0));
    const LinkFault faults[] = {LinkFault::slept, LinkFault::held_up, LinkFault::none, LinkFault::silent};
    EXPECT_EQ(bench.stylus->fault(), faults[static_cast<int>(cause)]);
    bench.arm.faults.silent = false;
    bench.arm.switch_off_and_on();
    bench.stylus->close();
    bench.stylus->open();
    bench.run(0.4, Vec3(0, 1, 0));
    EXPECT_EQ(bench.stylus->state(), State::homing) << static_cast<int>(cause);
    EXPECT_FALSE(bench.is_pushing()) << static_cast<int>(cause);
  }
}

TEST(WoodenHapticsDriver, AnotherArmThanThePresetIsRefused) {
  FakeWoodenHapticsOptions options;
  options.report_size = 8;
  options.arm = arm_with_home_at(Vec3(0), 14);
  Bench bench(options);
  try {
    bench.stylus->open();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("reports of 8 bytes, which the preset 2015 does not have"));
  }
}

TEST(WoodenHapticsDriver, MotorsAreNotHeatedForLong) {
  Bench bench;
  bench.home();
  const auto strongest = [&] {
    const auto& milliamperes = bench.arm.milliamperes();
    return std::max({std::abs(milliamperes[0]), std::abs(milliamperes[1]), std::abs(milliamperes[2])});
  };
  bench.run(1, Vec3(0, 5, 0));
  EXPECT_GT(strongest(), 1900) << "short-term, to the limit of the current";
  bench.run(15, Vec3(0, 5, 0));
  EXPECT_LT(strongest(), 1010) << "for long, to the continuous current";
  EXPECT_GT(strongest(), 900);
}

/// A link on which nobody speaks; it keeps what it is sent.
class MuteLink final : public Link {
 public:
  double now() noexcept override { return time_; }
  std::size_t receive(std::span<std::uint8_t> /*packet*/, double timeout) noexcept override {
    time_ += timeout;
    return 0;
  }
  bool send(std::span<const std::uint8_t> packet) noexcept override {
    sent.emplace_back(packet.begin(), packet.end());
    return true;
  }
  bool flush(double /*timeout*/) noexcept override { return true; }
  bool lost() const noexcept override { return false; }

  std::vector<std::vector<std::uint8_t>> sent;

 private:
  double time_ = 0;
};

/// A firmware that waits is offered zeros every 10 ms of a second: three times a report of 14 bytes, then one of 8.
TEST(WoodenHapticsDriver, OffersZerosOfBothLengthsToAFirmwareThatWaits) {
  MuteLink link;
  WoodenHapticsProtocol protocol(wooden_haptics_preset("2015"));
  EXPECT_ANY_THROW(protocol.connect(link));
  EXPECT_NEAR(static_cast<double>(link.sent.size()), 95, 6);
  for (std::size_t n = 0; n < link.sent.size(); ++n) {
    EXPECT_EQ(link.sent[n], std::vector<std::uint8_t>(n % 4 == 3 ? 8 : 14)) << n;
  }
}

/// Its counters were set under the hand: no force before the user has homed it again.
TEST(WoodenHapticsDriver, ItsButtonInMidSessionIsAFault) {
  FakeWoodenHapticsOptions options;
  options.path = {{0.3, {0, 0, 0}}, {0.5, {0.04, -0.03, 0.03}}};
  Bench bench(options);
  bench.home();
  bench.run(0.6, Vec3(0, 1, 0));
  ASSERT_TRUE(bench.is_pushing());
  bench.arm.faults.button_pressed = true;
  bench.run(0.005, Vec3(0, 1, 0));
  bench.arm.faults.button_pressed = false;
  bench.run(0.5, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::unhomed);
  EXPECT_FALSE(bench.is_pushing());
  bench.stylus->open();
  bench.run(0.5, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->state(), State::homing);
  EXPECT_FALSE(bench.is_pushing());
}

/// Its counters began anew, and its button was down: that it is up now does not mean that it was pressed since.
TEST(WoodenHapticsDriver, AButtonThatWasDownWhenItWasUnpluggedHomesNothing) {
  FakeWoodenHapticsOptions options;
  options.button_time = 60;
  Bench bench(options);
  bench.arm.faults.button_pressed = true;
  bench.stylus->open();
  bench.run(0.05);
  ASSERT_EQ(bench.stylus->state(), State::homing);
  bench.bench.unplugged = true;
  bench.run(0.01);
  bench.stylus->close();
  bench.bench.unplugged = false;
  bench.arm.faults.button_pressed = false;
  bench.stylus->open();
  bench.run(0.1, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->state(), State::homing);
  EXPECT_FALSE(bench.is_pushing());
}

/// Where an arm of another kind was refused, the home that it would have had is not that of the arm that comes next.
TEST(WoodenHapticsDriver, AnArmThatWasRefusedLeavesNothingBehind) {
  FakeWoodenHapticsOptions options, other_options;
  other_options.report_size = 8;
  other_options.arm = arm_with_home_at(Vec3(0), 8);
  FakeWoodenHaptics arm(options), other(other_options);
  FakeHidBench bench;
  FakeWoodenHaptics* plugged_in = &other;
  LinkStylusOptions link_options;
  link_options.threaded = false;
  const auto stylus = make_wooden_haptics_on(
      options.arm, [&] { return std::make_unique<FakeHidLink>(*plugged_in, bench); }, link_options);
  EXPECT_ANY_THROW(stylus->open());
  plugged_in = &arm;
  stylus->open();
  for (const double end = bench.time + 0.5; bench.time < end;) stylus->service(0.2e-3);
  ASSERT_EQ(stylus->state(), State::idle);
  EXPECT_LT(glm::distance(stylus->read().position, arm.hand().body().position), 0.2e-3);
}

/// Straight to the arm's node: a report's number and zeros in each of the three lengths.
TEST(WoodenHapticsDriver, TheGuardiansZerosHaveTheLengthOfEachFirmware) {
  const auto send_zeros = find_device_type("wooden_haptics")->send_zeros;
  const TestFiles files;
  FakeHidApi hid;
  const auto arm_at = [](const std::string& path) { return FakeHidNode{0x1234, 6, 0xffab, 0x200, path, L"arm"}; };
  const std::string node = files.write("node", ""), other = files.write("other", "");
  hid.nodes = {arm_at(node), arm_at("/dev/full"), {0x1234, 6, 1, 4, other, L"a gamepad of the same ids"}};
  EXPECT_TRUE(send_zeros(node, false));
  std::ifstream stream(node, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), std::string(15 + 9 + 65, '\0'));
  EXPECT_FALSE(send_zeros("/dev/full", false)) << "it takes nothing";
  EXPECT_FALSE(send_zeros("/absent", false));
  EXPECT_FALSE(send_zeros(other, false)) << "no arm";
  EXPECT_EQ(std::filesystem::file_size(other), 0U);
}

/// One that another session drives is left to it; from one that is stopped it is taken.
TEST(WoodenHapticsDriver, ASessionHoldsItsArmAlone) {
  const auto send_zeros = find_device_type("wooden_haptics")->send_zeros;
  const TestFiles files;
  FakeHidApi hid;
  const std::string node = files.write("node", "");
  hid.nodes = {{0x1234, 6, 0xffab, 0x200, node, L"arm"}};
  {
    const auto first = open_hid(wooden_haptics_hid, node);
    try {
      open_hid(wooden_haptics_hid, node);
      ADD_FAILURE() << "a second session drives it";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), "WoodenHaptics at " + node + ": another program drives it; close that one first");
    }
    EXPECT_FALSE(send_zeros(node, false));
    EXPECT_EQ(std::filesystem::file_size(node), 0U);
    EXPECT_TRUE(send_zeros(node, true));
  }
  EXPECT_TRUE(send_zeros(node, false));
  EXPECT_NE(open_hid(wooden_haptics_hid, node), nullptr);
}

}  // namespace
}  // namespace palpate::device
