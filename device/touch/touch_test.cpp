#include "device/touch/touch.h"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <thread>

#include "device/device_type.h"
#include "device/link/realtime.h"
#include "device/testing/fake_libhd.h"
#include "device/testing/test_files.h"
#include "device/touch/touch_driver.h"

namespace palpate::device {
namespace {

template <typename Function>
Function function_of_library(const char* name) {
  return reinterpret_cast<Function>(dlsym(dlopen(PALPATE_FAKE_LIBHD, RTLD_NOW | RTLD_NODELETE), name));
}

/// The scheduler's rounds come by hand, one a millisecond of a clock that only they move.
class Touch : public ::testing::Test {
 protected:
  Touch() {
    setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
    hd = function_of_library<FakeHd* (*)()>("fake_hd")();
    *hd = FakeHd{};
    function_of_library<void (*)(bool)>("fake_hd_by_hand")(true);
  }
  ~Touch() override {
    function_of_library<void (*)(bool)>("fake_hd_by_hand")(false);
    unsetenv("PALPATE_LIBHD");
  }

  static void pass(double seconds) noexcept {
    static const auto round = function_of_library<void (*)()>("fake_hd_call");
    for (long rounds = std::lround(1e3 * seconds); rounds > 0; --rounds) {
      time += 1e-3;
      round();
    }
  }
  /// Of a stylus that waits for samples while no round comes: its patience ends all the same.
  static double impatient_now() noexcept { return time += 1e-4; }
  static std::unique_ptr<LinkStylus> unthreaded(const TouchSettings& settings = {}) {
    LinkStylusOptions options;
    options.threaded = false;
    return make_touch_with(settings, options, {&impatient_now, &pass});
  }
  /// Exchanges as long as something does not hold, at most two seconds.
  static bool comes(LinkStylus& stylus, const Vec3& force, const std::function<bool()>& holds) {
    for (int i = 0; i < 2000 && !holds(); ++i) {
      stylus.write_force(force);
      pass(1e-3);
      stylus.service(0);
    }
    return holds();
  }
  Vec3 acting() const { return {hd->force[0], hd->force[1], hd->force[2]}; }
  static void expect_refusal(const std::function<void()>& open, const std::string& why) {
    try {
      open();
      FAIL() << "not refused: " << why;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("3D Systems Touch"));
      EXPECT_THAT(error.what(), ::testing::HasSubstr(why));
    }
  }

  FakeHd* hd = nullptr;
  inline static double time = 0;  // s
};

TEST_F(Touch, PosesAreInMetresAndForcesArriveWithTheirSigns) {
  hd->place_mm[0] = 10;
  hd->place_mm[1] = -20;
  hd->place_mm[2] = 30;
  hd->buttons = 2;
  const auto stylus = unthreaded();
  stylus->open();
  const Vec3 asked(0.1, -0.2, 0.3);
  EXPECT_TRUE(comes(*stylus, asked, [&] { return acting() == asked; }));
  EXPECT_EQ(stylus->state(), State::idle);
  EXPECT_LT(glm::distance(stylus->read().position, Vec3(0.010, -0.020, 0.030)), 1e-12);
  EXPECT_EQ(stylus->read().buttons, 2U);
  EXPECT_EQ(hd->misuses, 0);
  EXPECT_EQ(hd->enabled, 7);
}

TEST_F(Touch, TellsItsModelsLimits) {
  const auto stylus = unthreaded();
  stylus->open();
  const Specification can = stylus->specification();
  EXPECT_EQ(can.name, "PHANToM Omni");
  EXPECT_DOUBLE_EQ(can.maximum_force, 3.3);
  EXPECT_DOUBLE_EQ(can.continuous_force, 0.88);
  EXPECT_DOUBLE_EQ(can.stiffness_limit, 500) << "the library's 0.5 N/mm is below the model's 700 N/m";
  EXPECT_LT(glm::distance(can.workspace_half_extent, Vec3(0.080, 0.060, 0.035)), 1e-12);
}

/// Where the library tells nothing of its device, its model's public figures hold; and no motor lasts at more than its
/// largest force.
TEST_F(Touch, WhatTheLibraryDoesNotTellIsTheModels) {
  hd->force_newtons = hd->continuous_newtons = hd->stiffness_newtons_per_mm = 0;
  const auto silent = unthreaded();
  silent->open();
  EXPECT_DOUBLE_EQ(silent->specification().maximum_force, 3.3);
  EXPECT_DOUBLE_EQ(silent->specification().continuous_force, 3.3 / 4);
  EXPECT_DOUBLE_EQ(silent->specification().stiffness_limit, 700) << "an Omni's";
  silent->close();
  hd->force_newtons = 2;
  hd->continuous_newtons = 5;
  const auto weak = unthreaded();
  weak->open();
  EXPECT_DOUBLE_EQ(weak->specification().maximum_force, 2);
  EXPECT_DOUBLE_EQ(weak->specification().continuous_force, 2);
}

TEST_F(Touch, PushesNothingBeforeItIsCalibrated) {
  hd->calibration = hd->after_update = 0x5002;  // by hand: the inkwell
  const auto stylus = unthreaded();
  stylus->open();
  EXPECT_FALSE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() != Vec3(0); }));
  EXPECT_EQ(stylus->state(), State::homing);
  hd->calibration = 0x5000;
  EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  EXPECT_EQ(stylus->state(), State::idle);
}

TEST_F(Touch, CalibratesItselfWhereItCan) {
  hd->calibration = 0x5001;
  const auto stylus = unthreaded();
  stylus->open();
  EXPECT_TRUE(comes(*stylus, Vec3(0), [&] { return stylus->state() == State::idle; }));
}

/// Its home would move under the hand.
TEST_F(Touch, IsNotCalibratedAnewOnceItPushed) {
  const auto stylus = unthreaded();
  stylus->open();
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  hd->calibration = 0x5001;
  EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->state() == State::fault; }));
  EXPECT_EQ(stylus->fault(), LinkFault::unhomed);
  EXPECT_EQ(hd->calibration, 0x5001U);
  EXPECT_EQ(acting(), Vec3(0));
}

TEST_F(Touch, AnErrorWhileItOpensIsSaidAndItIsClosed) {
  const char* const failing[] = {"it does not tell what it can do", "its forces cannot be switched on",
                                 "its servo loop does not start"};
  for (int step = 0; step < 3; ++step) {
    *hd = FakeHd{};
    hd->error = 0x303;
    hd->sound_answers = 1 + step;
    expect_refusal([] { unthreaded()->open(); }, failing[step]);
    hd->sound_answers = 1 + step;
    expect_refusal([] { unthreaded()->open(); }, ": a fault of the fake");
    EXPECT_EQ(hd->disabled, 2);
    EXPECT_EQ(hd->running, 0);
    EXPECT_EQ(hd->misuses, 0);
  }
}

TEST_F(Touch, AForceThatNobodyRenewsEnds) {
  const auto stylus = unthreaded();
  stylus->open();
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  pass(0.020);  // no exchange at all
  EXPECT_EQ(acting(), Vec3(0, 1, 0));
  pass(0.001);
  EXPECT_EQ(acting(), Vec3(0));
}

TEST_F(Touch, ClosesInTheOrderThatTheLibraryBears) {
  const auto stylus = unthreaded();
  stylus->open();
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  stylus->close();
  EXPECT_EQ(acting(), Vec3(0));
  EXPECT_EQ(hd->disabled, 1);
  EXPECT_EQ(hd->running, 0);
  EXPECT_EQ(hd->misuses, 0);
  stylus->open();
  EXPECT_TRUE(comes(*stylus, Vec3(0), [&] { return stylus->state() == State::idle; })) << "again";
}

TEST_F(Touch, EveryErrorEndsAsItShould) {
  const struct {
    unsigned code;
    LinkFault fault;
  } errors[] = {{0x200, LinkFault::own_safety},
                {0x203, LinkFault::own_safety},
                {0x204, LinkFault::own_safety},
                {0x300, LinkFault::unplugged},
                {0x302, LinkFault::unplugged}};
  for (const auto& error : errors) {
    *hd = FakeHd{};
    const auto stylus = unthreaded();
    stylus->open();
    ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
    hd->error = error.code;
    EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->fault() != LinkFault::none; })) << error.code;
    EXPECT_EQ(stylus->fault(), error.fault) << error.code;
    EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0); })) << error.code;
  }
  for (const unsigned harmless : {0x201U, 0x202U}) {
    *hd = FakeHd{};
    const auto stylus = unthreaded();
    stylus->open();
    hd->error = harmless;
    EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); })) << "it clamped the force";
    EXPECT_EQ(stylus->fault(), LinkFault::none);
  }
}

TEST_F(Touch, IsCalledBackByTheLibrarysOwnThread) {
  function_of_library<void (*)(bool)>("fake_hd_by_hand")(false);
  hd->place_mm[0] = 10;
  const auto stylus = make_touch({.guarded = false});
  stylus->open();
  while (stylus->read().position.x != 0.010) std::this_thread::yield();
  stylus->close();
  EXPECT_EQ(acting(), Vec3(0));
  EXPECT_EQ(hd->misuses, 0);
}

TEST_F(Touch, ASchedulerThatStandsStillIsSilence) {
  const auto stylus = unthreaded();
  stylus->open();
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  hd->stalled = 1;
  EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->fault() == LinkFault::silent; }));
}

TEST_F(Touch, WhatIsMissingIsSaid) {
  hd->present = 0;
  expect_refusal([] { unthreaded()->open(); },
                 "3D Systems Touch: it cannot be opened: a fault of the fake; check its plug and power, and set it up "
                 "with the maker's Touch_Setup");
  // Where it gives no reason: "no device".
  setenv("PALPATE_LIBHD", "/absent/libHD.so", 1);
  expect_refusal([] { unthreaded()->open(); }, ": its maker's library cannot be loaded (");
  EXPECT_TRUE(find_touch().empty());
  setenv("PALPATE_LIBHD", "libm.so.6", 1);
  expect_refusal([] { unthreaded()->open(); }, " is another version: it has no hdInitDevice; ");
}

TEST_F(Touch, TheTransformTurnsTheStylus) {
  const double turned[16] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // x goes to y
  for (int i = 0; i < 16; ++i) hd->transform[i] = turned[i];
  const auto stylus = unthreaded({.address = "Left"});
  stylus->open();
  EXPECT_STREQ(hd->named, "Left");
  ASSERT_TRUE(comes(*stylus, Vec3(0), [&] { return stylus->state() == State::idle; }));
  comes(*stylus, Vec3(0), [] { return false; });
  EXPECT_LT(glm::distance(stylus->read().orientation * Vec3(1, 0, 0), Vec3(0, 1, 0)), 1e-12);
}

/// Its home is looked at in the first round of each connection, however many rounds there were before.
TEST_F(Touch, OpenedAnewItIsReadyInTheFirstRound) {
  const auto stylus = unthreaded();
  for (int n = 0; n < 2; ++n) {
    stylus->open();
    EXPECT_EQ(stylus->state(), State::homing);
    pass(1e-3);
    stylus->service(0);
    EXPECT_EQ(stylus->state(), State::idle);
    comes(*stylus, Vec3(0), [&] { return hd->callbacks % 100 == 42; });
    stylus->close();
  }
}

/// Neither the fault nor the pose nor the buttons of before are left.
TEST_F(Touch, OpenedAnewAfterAFaultItIsAsNew) {
  hd->place_mm[0] = 10;
  hd->buttons = 1;
  const auto stylus = unthreaded();
  stylus->open();
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  hd->error = 0x302;
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->fault() == LinkFault::unplugged; }));
  hd->error = 0;
  hd->buttons = 0;
  hd->calibration = hd->after_update = 0x5002;
  stylus->open();
  EXPECT_FALSE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->state() != State::homing; }));
  EXPECT_EQ(stylus->read().position, Vec3(0)) << "it does not know yet where it is";
  EXPECT_EQ(stylus->read().buttons, 0U);
  hd->calibration = 0x5000;
  EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  EXPECT_EQ(stylus->fault(), LinkFault::none);
}

TEST_F(Touch, ADriverThatIsDroppedLetsGoOfItsDevice) {
  auto driver = std::make_unique<TouchDriver>(TouchSettings{}, DriverClock{&impatient_now, &pass});
  driver->connect();
  EXPECT_EQ(hd->running, 1);
  driver.reset();
  EXPECT_EQ(hd->running, 0);
  EXPECT_EQ(hd->disabled, 1);
  EXPECT_EQ(hd->scheduled, 0);
  EXPECT_EQ(hd->misuses, 0);
}

/// The guardian's five zeros come from the library's own thread. They take as long as they take, and no longer than a
/// tenth of a second where none arrives; nothing stays scheduled.
TEST_F(Touch, TheGuardiansZerosTakeNoLongerThanTheyMust) {
  function_of_library<void (*)(bool)>("fake_hd_by_hand")(false);
  for (const bool arrives : {true, false}) {
    *hd = FakeHd{};
    hd->force[1] = 1;
    hd->sound_answers = arrives ? 0 : 1;
    hd->error = arrives ? 0 : 0x302;
    const double begun = monotonic_time();
    EXPECT_EQ(send_zeros_to_touch("Left"), arrives);
    ASSERT_EQ(monotonic_time() - begun < 0.1, arrives);
    EXPECT_EQ(acting(), Vec3(0));
    EXPECT_GE(hd->callbacks, 5);
    EXPECT_STREQ(hd->named, "Left");
    EXPECT_EQ(hd->running, 0);
    EXPECT_EQ(hd->scheduled, 0);
    EXPECT_EQ(hd->disabled, 1);
    EXPECT_EQ(hd->misuses, 0);
  }
}

/// What is named beside a settings file is meant, and what is not is as the file has it.
TEST_F(Touch, AnAddressThatIsChosenGoesBeforeTheSettings) {
  const TestFiles files;
  const std::string settings = files.write("touch.json", R"({"address": "Right", "guarded": false})");
  for (const std::string chosen : {"Left", ""}) {
    const auto stylus = find_device_type("touch")->make({.address = chosen, .settings = settings});
    stylus->open();
    stylus->close();
    EXPECT_STREQ(hd->named, chosen.empty() ? "Right" : "Left");
  }
}

}  // namespace
}  // namespace palpate::device
