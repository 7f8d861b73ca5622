/// Every device that is opened is closed, however its connection ends.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "device/force_dimension/force_dimension.h"
#include "device/testing/force_dimension_fixture.h"

namespace palpate::device {
namespace {

class ForceDimensionClosing : public ForceDimensionFixture {};

/// Whatever comes of it, each device that was opened is closed again, but for the one that is held.
TEST_F(ForceDimensionClosing, OpensAndClosesInPairs) {
  drd->devices = 3;  // 1234, 1235, 1236
  const auto held = [&] { return drd->opened - drd->closed; };
  for (const char* const serial : {"1234", "1235", "1236"}) {
    auto driver = connected({.address = serial});
    EXPECT_EQ(held(), 1) << serial;
    driver->disconnect();
    EXPECT_EQ(held(), 0);
    driver->disconnect();
    EXPECT_EQ(held(), 0) << "twice is once";
  }
  EXPECT_THAT(refusal([] { connected(); }), ::testing::HasSubstr("there are 3"));
  EXPECT_THAT(refusal([] { connected({.address = "7"}); }), ::testing::HasSubstr("not found"));
  EXPECT_EQ(held(), 0);
  drd->homed = 0;
  EXPECT_NE(refusal([] { connected({.address = "1235"}); }), "");
  EXPECT_EQ(held(), 0);
  const auto found = find_force_dimension();
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(held(), 0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found[i].kind, "force_dimension");
    EXPECT_EQ(found[i].name, "omega.3");
    EXPECT_EQ(found[i].address, std::to_string(1234 + i));
    EXPECT_TRUE(found[i].accessible);
    EXPECT_EQ(found[i].note, "it has no home yet: to find it the arm moves by itself");
  }
  drd->homed = 1;
  EXPECT_EQ(find_force_dimension().at(0).note, "");
  const int stopped = drd->stopped;
  EXPECT_TRUE(stop_force_dimension("1236"));
  EXPECT_EQ(drd->stopped, stopped + 1);
  EXPECT_FALSE(stop_force_dimension("7"));
  EXPECT_EQ(drd->stopped, stopped + 1);
  EXPECT_TRUE(stop_force_dimension(""));
  EXPECT_EQ(drd->stopped, stopped + 4);
  EXPECT_EQ(held(), 0);
}

/// Of several that are meant each is tried, and one that is not stopped is told, whichever it is.
TEST_F(ForceDimensionClosing, TheyAreStoppedOnlyIfEachIs) {
  drd->devices = 3;
  for (int failing = 0; failing < 3; ++failing) {
    drd->unstoppable = failing;
    const int stopped = drd->stopped;
    EXPECT_FALSE(stop_force_dimension("")) << failing;
    EXPECT_EQ(drd->stopped, stopped + 3);
    EXPECT_EQ(drd->opened, drd->closed);
    for (int one = 0; one < 3; ++one) EXPECT_EQ(stop_force_dimension(std::to_string(1234 + one)), one != failing);
  }
  drd->unstoppable = -1;
  for (int held = 0; held < 3; ++held) {
    drd->unopenable = held;
    EXPECT_FALSE(stop_force_dimension("")) << "it may be the one that pushes";
    for (int one = 0; one < 3; ++one) EXPECT_EQ(stop_force_dimension(std::to_string(1234 + one)), one != held);
  }
  drd->devices = 0;
  EXPECT_FALSE(stop_force_dimension("")) << "there is none";
}

/// Whoever could not be connected to needs no disconnecting: it is stopped and closed, and can be tried again.
TEST_F(ForceDimensionClosing, OneThatCannotBeBroughtUpIsStoppedAndClosed) {
  const struct {
    bool may_home;
    int homed, homing_fails, failing;
  } cases[] = {{false, 0, 0, 0}, {true, 0, 1, 0}, {false, 1, 0, 1}};
  for (const auto& one : cases) {
    *drd = FakeDrd{};
    drd->homed = one.homed;
    drd->homing_fails = one.homing_fails;
    drd->failing = one.failing;
    ForceDimensionDriver driver({.may_home = one.may_home}, {&now, &pass});
    EXPECT_NE(refusal([&] { driver.connect(); }), "");
    EXPECT_EQ(drd->opened, 1);
    EXPECT_EQ(drd->stopped, 1);
    EXPECT_EQ(drd->closed, 1);
    EXPECT_EQ(drd->forces_on, 0);
    drd->homed = 1;
    drd->failing = 0;
    driver.connect();
    driver.disconnect();
    EXPECT_EQ(drd->opened, 2);
    EXPECT_EQ(drd->closed, 2);
  }
}

/// Looking for devices opens them, which one that is held does not bear: it is told as it is.
TEST_F(ForceDimensionClosing, OneThatIsHeldIsNotOpenedByASearch) {
  auto driver = connected();
  const int opened = drd->opened;
  const auto found = find_force_dimension();
  EXPECT_EQ(drd->opened, opened);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].note, "held by this session");
  EXPECT_TRUE(found[0].accessible);
  driver->disconnect();
  EXPECT_EQ(find_force_dimension().at(0).note, "");
}

/// Looking for devices in another thread happens at any time: while one is opened, moves to its home, is stopped and is
/// closed. However the connection ends, the search opens none, waits for nothing, and says that one is held.
TEST_F(ForceDimensionClosing, NoSearchOpensOneThatIsBeingConnectedOrClosed) {
  static FakeDrd* fake;
  static std::set<std::string> calls;
  static std::vector<std::string> told;
  static bool looks;
  fake = drd;
  const struct {
    int homed, homing_fails, failing, devices;
    std::set<std::string> calls;
  } cases[] = {{1, 0, 0, 1, {"drdOpenID", "drdStop", "dhdStop", "drdClose"}},
               {0, 0, 0, 1, {"drdOpenID", "drdAutoInit", "drdStop", "dhdStop", "drdClose"}},
               {0, 1, 0, 1, {"drdOpenID", "drdAutoInit", "dhdStop", "drdClose"}},
               {1, 0, 1, 1, {"drdOpenID", "drdStop", "dhdStop", "drdClose"}},
               {1, 0, 0, 3, {"drdOpenID", "drdClose"}}};
  for (const auto& one : cases) {
    *drd = FakeDrd{};
    drd->homed = one.homed;
    drd->homing_fails = one.homing_fails;
    drd->failing = one.failing;
    drd->devices = one.devices;
    calls.clear();
    told.clear();
    looks = false;
    set_hook([](const char* call) {
      if (looks) return;
      looks = true;
      calls.insert(call);
      const int opened = fake->opened, closed = fake->closed;
      for (const FoundDevice& device : find_force_dimension()) told.push_back(device.note);
      EXPECT_EQ(fake->opened, opened) << call;
      EXPECT_EQ(fake->closed, closed) << call;
      looks = false;
    });
    const std::string why = refusal([] { connected({.may_home = true}); });
    set_hook(nullptr);
    EXPECT_EQ(why != "", one.homing_fails != 0 || one.failing != 0 || one.devices > 1) << why;
    EXPECT_EQ(calls, one.calls);
    EXPECT_GE(told.size(), calls.size());
    for (const std::string& note : told) EXPECT_EQ(note, "held by this session");
    EXPECT_EQ(drd->opened, one.devices);
    EXPECT_EQ(drd->closed, one.devices);
    drd->failing = 0;
    EXPECT_EQ(find_force_dimension().size(), static_cast<std::size_t>(one.devices));
    EXPECT_EQ(drd->opened, 2 * one.devices) << "none is held any more";
  }
}

/// A library that is not there holds nothing.
TEST_F(ForceDimensionClosing, WhatCannotBeConnectedKeepsNoSearchAway) {
  setenv("PALPATE_LIBDRD", "/absent/libdrd.so", 1);
  ForceDimensionDriver driver({}, {&now, &pass});
  EXPECT_NE(refusal([&] { driver.connect(); }), "");
  setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
  EXPECT_EQ(find_force_dimension().at(0).note, "");
}

/// Of two, one that is closed leaves the other held.
TEST_F(ForceDimensionClosing, EachOfTwoIsHeldByItself) {
  drd->devices = 2;
  auto first = connected({.address = "1234"}), second = connected({.address = "1235"});
  first->disconnect();
  EXPECT_EQ(find_force_dimension().at(0).note, "held by this session");
  second->disconnect();
  EXPECT_EQ(find_force_dimension().size(), 2U);
}

/// A search that runs has a device open: connecting waits until that is closed.
TEST_F(ForceDimensionClosing, ConnectingWaitsForASearchThatRuns) {
  static FakeDrd* fake;
  static std::thread connecting;
  static int open_then;
  fake = drd;
  open_then = -1;
  set_hook([](const char* call) {
    if (std::strcmp(call, "drdOpenID") != 0) return;
    if (connecting.joinable()) {
      if (open_then < 0) open_then = fake->opened - fake->closed;
      return;
    }
    connecting = std::thread([] { connected(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // in which it would have opened the device
  });
  EXPECT_EQ(find_force_dimension().size(), 1U);
  connecting.join();
  set_hook(nullptr);
  EXPECT_EQ(open_then, 1) << "its own alone";
  EXPECT_EQ(drd->opened, 2);
  EXPECT_EQ(drd->closed, 2);
}

/// Connected anew: at rest, no fault, not lost; poses are counted on.
TEST_F(ForceDimensionClosing, ConnectedAnewItKnowsNothingOfBefore) {
  const auto driver = connected();
  put({0.01, 0.02, 0.03});
  drd->buttons = 3;
  driver->take(1);
  drd->failing = 1;
  for (int n = 0; n < 20; ++n) driver->take(1);
  ASSERT_TRUE(driver->lost());
  drd->failing = 0;
  driver->disconnect();
  driver->connect();
  EXPECT_FALSE(driver->lost());
  EXPECT_EQ(driver->status().state, State::homing);
  EXPECT_EQ(driver->status().fault, LinkFault::none);
  EXPECT_EQ(driver->status().position, Vec3(0));
  EXPECT_EQ(driver->status().buttons, 0U);
  EXPECT_EQ(driver->status().news, 1U);
}

}  // namespace
}  // namespace palpate::device
