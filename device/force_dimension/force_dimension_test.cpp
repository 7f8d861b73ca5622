#include "device/force_dimension/force_dimension.h"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <string>

#include "device/device_type.h"
#include "device/force_dimension/force_dimension_driver.h"
#include "device/testing/fake_libdrd.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

/// By a clock that only the exchanges move.
class ForceDimension : public ::testing::Test {
 protected:
  ForceDimension() {
    setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
    void* const library = dlopen(PALPATE_FAKE_LIBDRD, RTLD_NOW | RTLD_NODELETE);
    drd = reinterpret_cast<FakeDrd* (*)()>(dlsym(library, "fake_drd"))();
    is_pushing = reinterpret_cast<bool (*)()>(dlsym(library, "fake_drd_is_pushing"));
    *drd = FakeDrd{};
    set_clock = reinterpret_cast<void (*)(double (*)())>(dlsym(library, "fake_drd_set_clock"));
    set_clock([] { return time; });
  }
  ~ForceDimension() override {
    set_clock(nullptr);
    unsetenv("PALPATE_LIBDRD");
  }

  std::unique_ptr<LinkStylus> unthreaded(const ForceDimensionSettings& settings = {}) {
    LinkStylusOptions options;
    options.threaded = false;
    return make_force_dimension_with(settings, options, {&now, &pass});
  }
  static double now() noexcept { return time; }
  static void pass(double seconds) noexcept { time += seconds; }
  static void push(LinkStylus& stylus, const Vec3& force, int exchanges = 5) {
    for (int i = 0; i < exchanges; ++i) {
      pass(1e-3);
      stylus.write_force(force);
      stylus.service(1e-3);
    }
  }
  static void expect_refusal(const std::function<void()>& open, const std::string& why) {
    try {
      open();
      FAIL() << "not refused: " << why;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("Force Dimension"));
      EXPECT_THAT(error.what(), ::testing::HasSubstr(why));
    }
  }

  FakeDrd* drd = nullptr;
  bool (*is_pushing)() = nullptr;
  void (*set_clock)(double (*)()) = nullptr;
  inline static double time = 0;  // s
};

TEST_F(ForceDimension, PoseAndForceChangeFramesAndNothingElse) {
  const auto stylus = unthreaded();
  stylus->open();
  // Right, up, towards the user, in the maker's axes.
  const struct {
    double theirs[3];
    Vec3 ours;
  } axes[] = {{{0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}}};
  for (const auto& axis : axes) {
    for (int i = 0; i < 3; ++i) drd->place[i] = 0.02 * axis.theirs[i];
    push(*stylus, 2.0 * axis.ours, 400);
    EXPECT_EQ(stylus->read().position, 0.02 * axis.ours);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(drd->force[i], 2 * axis.theirs[i]);
  }
}

TEST_F(ForceDimension, IsBroughtUpWithItsOwnWatchdogLimitAndGravity) {
  const auto stylus = unthreaded({.maximum_force = 5});
  stylus->open();
  EXPECT_NEAR(drd->watchdog_s, 0.030, 1e-9);
  EXPECT_EQ(drd->told_max_force, 5);
  EXPECT_EQ(drd->gravity, 1);
  EXPECT_EQ(stylus->specification().maximum_force, 5);
  EXPECT_EQ(stylus->specification().name, "Force Dimension omega.3");
  push(*stylus, Vec3(30, 40, 0), 400);
  EXPECT_NEAR(drd->force[1], 3, 1e-12);
  EXPECT_NEAR(drd->force[2], 4, 1e-12);
}

TEST_F(ForceDimension, ItsFirmwareTakesAForceAwayThatIsNotRenewed) {
  const auto stylus = unthreaded();
  stylus->open();
  push(*stylus, Vec3(0, 1, 0));
  ASSERT_TRUE(is_pushing());
  pass(0.029);
  EXPECT_TRUE(is_pushing());
  pass(0.002);
  EXPECT_FALSE(is_pushing());
}

TEST_F(ForceDimension, ClosingLeavesNoForce) {
  auto stylus = unthreaded();
  stylus->open();
  push(*stylus, Vec3(0, 1, 0));
  EXPECT_TRUE(is_pushing());
  stylus->close();
  EXPECT_EQ(drd->force[2], 0);
  EXPECT_EQ(drd->stopped, 1);
  EXPECT_EQ(drd->closed, 1);
}

TEST_F(ForceDimension, AnArmWithoutAHomeMovesOnlyWhenItMay) {
  drd->homed = 0;
  expect_refusal([&] { unthreaded()->open(); },
                 "Force Dimension: the arm is not homed yet, and homing moves it by itself; keep hands off it, then "
                 "allow it in its settings file: may_home, true");
  EXPECT_EQ(drd->auto_inits, 0);
  unthreaded({.may_home = true})->open();
  EXPECT_EQ(drd->auto_inits, 1);
  drd->homed = 0;
  drd->homing_fails = 1;
  expect_refusal([&] { unthreaded({.may_home = true})->open(); },
                 "Force Dimension: the arm did not find its home: a fault of the fake; free its way and try again");
}

TEST_F(ForceDimension, WhatIsMissingIsSaid) {
  drd->devices = 0;
  expect_refusal(
      [&] { unthreaded()->open(); },
      ": not found; check its plug, its power and the rights to it (udev, idVendor 1451): a fault of the fake");
  drd->devices = 2;
  expect_refusal([&] { unthreaded()->open(); }, "there are 2; name the address of one");
  unthreaded({.address = "1235"})->open();
  expect_refusal([&] { unthreaded({.address = "7"})->open(); }, "Force Dimension 7: not found");
  drd->major = 2;
  expect_refusal([&] { unthreaded()->open(); }, " is version 2.17; this driver needs version 3; install");
  drd->major = 3;
  drd->failing = 1;
  drd->devices = 1;
  expect_refusal(
      [&] { unthreaded()->open(); },
      "Force Dimension: its forces cannot be switched on: a fault of the fake; press its force button, then try again");
  setenv("PALPATE_LIBDRD", "/absent/libdrd.so", 1);
  expect_refusal([&] { unthreaded()->open(); }, "its maker's library cannot be loaded");
  setenv("PALPATE_LIBDRD", "libm.so.6", 1);
  expect_refusal([&] { unthreaded()->open(); }, "is another version: it has no dhdGetSDKVersion");
}

TEST_F(ForceDimension, ADeviceThatFailsIsLostAndOneInErrorIsAFault) {
  const auto lost = unthreaded();
  lost->open();
  drd->failing = 1;
  push(*lost, Vec3(0, 1, 0), 40);
  EXPECT_EQ(lost->fault(), LinkFault::unplugged);
  lost->close();
  drd->failing = 0;
  const auto stylus = unthreaded();
  stylus->open();
  push(*stylus, Vec3(0, 1, 0));
  drd->in_error = 1;
  push(*stylus, Vec3(0, 1, 0), 40);
  EXPECT_EQ(stylus->fault(), LinkFault::own_safety);
  EXPECT_EQ(drd->force[2], 0);
}

/// Every force is refused and every pose is good: the device still holds what it took last.
TEST_F(ForceDimension, ForcesThatAreRefusedForLongAreAFault) {
  const auto stylus = unthreaded();
  stylus->open();
  drd->has_watchdog = 0;
  push(*stylus, Vec3(0, 1, 0), 300);
  ASSERT_EQ(drd->force[2], 1);
  std::strcpy(drd->failing_call, "dhdSetForceAndTorqueAndGripperForce");
  push(*stylus, Vec3(0, 1, 0), 45);
  EXPECT_EQ(stylus->fault(), LinkFault::none);
  push(*stylus, Vec3(0, 1, 0), 10);
  EXPECT_EQ(stylus->fault(), LinkFault::forces_refused);
  EXPECT_EQ(drd->force[2], 1);
  std::strcpy(drd->failing_call, "");
  push(*stylus, Vec3(0, 1, 0), 5);
  EXPECT_EQ(drd->force[2], 0) << "a zero, as soon as it is taken";
}

/// A model without a watchdog holds its last force. Poses that fail for ten milliseconds are a device that is lost, but
/// its forces are still taken: it gets a zero, in any direction that it pushed, and as soon as it takes one.
TEST_F(ForceDimension, OneWhosePosesFailIsGivenAZero) {
  for (const bool takes_forces : {true, false}) {
    for (const Vec3& force : {Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0.6, 0, -0.8)}) {
      *drd = FakeDrd{};
      drd->has_watchdog = 0;
      const auto stylus = unthreaded();
      stylus->open();
      push(*stylus, force, 300);
      ASSERT_TRUE(is_pushing());
      std::strcpy(drd->failing_call, "dhdGetPosition");
      drd->failing = takes_forces ? 0 : 1;
      push(*stylus, force, 45);
      EXPECT_EQ(stylus->fault(), LinkFault::unplugged);
      EXPECT_EQ(is_pushing(), !takes_forces);
      drd->failing = 0;
      push(*stylus, force, 1);
      EXPECT_FALSE(is_pushing());
      for (const double newtons : drd->force) EXPECT_EQ(newtons, 0);
      EXPECT_EQ(stylus->fault(), LinkFault::unplugged);
    }
  }
}

TEST_F(ForceDimension, TheWristTurnsTheStylus) {
  drd->has_wrist = 1;
  const auto stylus = unthreaded();
  stylus->open();
  push(*stylus, Vec3(0));
  // Their quarter turn about up takes towards-the-user to the right: ours takes z to x, about y.
  const Vec3 turned = stylus->read().orientation * Vec3(0, 0, 1);
  EXPECT_LT(glm::distance(turned, Vec3(1, 0, 0)), 1e-12);
  EXPECT_EQ(stylus->specification().orientation_axes, 3);
}

TEST_F(ForceDimension, IsFoundWithItsSerialNumber) {
  const auto found = find_force_dimension();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].address, "1234");
  setenv("PALPATE_LIBDRD", "/absent/libdrd.so", 1);
  EXPECT_TRUE(find_force_dimension().empty());
}

/// Half the edge of a cube in what the maker says that each model reaches: an omega 160 mm across and 110 mm deep, a
/// delta 400 by 260, a sigma 190 by 130, a lambda 240 by 170.
TEST_F(ForceDimension, TellsHowFarItsModelReaches) {
  const struct {
    int type;
    double half_extent_mm;
  } models[] = {{33, 55},  {34, 55},  {35, 55},  {36, 55},  {37, 55},  {63, 100}, {206, 65}, {104, 65}, {105, 65},
                {203, 80}, {108, 80}, {109, 80}, {131, 80}, {132, 80}, {60, 40},  {1, 40},   {9999, 40}};
  for (const auto& model : models) {
    drd->type = model.type;
    const auto stylus = unthreaded();
    stylus->open();
    EXPECT_EQ(stylus->specification().workspace_half_extent, Vec3(1e-3 * model.half_extent_mm)) << model.type;
  }
}

TEST_F(ForceDimension, IsAskedTwiceAMillisecond) {
  const auto stylus = unthreaded();
  stylus->open();
  const double begun = time;
  for (int n = 0; n < 1000; ++n) stylus->service(1);
  EXPECT_NEAR(time - begun, 0.5, 1e-3);
}

/// Opened anew it has failed at nothing yet: twenty poses in a row have to fail, and its status is looked at with each
/// twentieth.
TEST_F(ForceDimension, OpenedAnewItCountsFromTheBeginning) {
  const auto stylus = unthreaded();
  for (int n = 0; n < 2; ++n) {
    stylus->open();
    push(*stylus, Vec3(0), 33);
    drd->failing = 1;
    push(*stylus, Vec3(0), 17);
    drd->failing = 0;
    stylus->open();
    drd->failing = 1;
    push(*stylus, Vec3(0), 19);
    EXPECT_EQ(stylus->fault(), LinkFault::none) << n;
    push(*stylus, Vec3(0), 1);
    EXPECT_EQ(stylus->fault(), LinkFault::unplugged) << n;
    drd->failing = 0;
    stylus->open();
    drd->in_error = 1;
    push(*stylus, Vec3(0), 19);
    EXPECT_EQ(stylus->fault(), LinkFault::none) << n;
    push(*stylus, Vec3(0), 1);
    EXPECT_EQ(stylus->fault(), LinkFault::own_safety) << n;
    drd->in_error = 0;
  }
}

TEST_F(ForceDimension, ItsSettingsFileLetsItFindItsHome) {
  const TestFiles files;
  for (const bool may : {false, true}) {
    drd->homed = 0;
    const std::string json = std::string(R"({"guarded": false, "may_home": )") + (may ? "true}" : "false}");
    const auto stylus = find_device_type("force_dimension")->make({.settings = files.write("omega.json", json)});
    may ? stylus->open() : expect_refusal([&] { stylus->open(); }, "the arm is not homed yet");
    stylus->close();
    EXPECT_EQ(drd->auto_inits, may ? 1 : 0);
  }
}

}  // namespace
}  // namespace palpate::device
