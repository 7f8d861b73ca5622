#include "device/touch/touch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semaphore.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <thread>

#include "device/device_type.h"
#include "device/link/realtime.h"
#include "device/testing/test_files.h"
#include "device/testing/touch_fixture.h"

namespace {

bool wall_clock_is_set_ahead = false;

}  // namespace

/// In place of libc's: a wait by a wall clock that is set ahead meanwhile is over at once.
extern "C" int sem_timedwait(sem_t* semaphore, const timespec* until) {
  if (!wall_clock_is_set_ahead) return sem_clockwait(semaphore, CLOCK_REALTIME, until);
  errno = ETIMEDOUT;
  return -1;
}

namespace palpate::device {
namespace {

class Touch : public TouchFixture {};

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

/// Whatever call it is that fails: its reason is said, and nothing stays initialized, so that it can be opened again.
TEST_F(Touch, AnErrorWhileItOpensIsSaidAndItIsClosed) {
  const struct {
    const char* call;
    const char* why;
  } failing[] = {{"hdInitDevice", "it cannot be opened: a fault of the fake"},
                 {"hdGetDoublev", "it does not tell what it can do: a fault of the fake"},
                 {"hdGetIntegerv", "it does not tell what it can do: a fault of the fake"},
                 {"hdEnable", "its forces cannot be switched on: a fault of the fake"},
                 {"hdStartScheduler", "its servo loop does not start: a fault of the fake"}};
  for (const auto& one : failing) {
    *hd = FakeHd{};
    hd->error = 0x303;
    std::strncpy(hd->failing_call, one.call, sizeof hd->failing_call - 1);
    for (const int times : {1, 2}) {
      expect_refusal([] { unthreaded()->open(); }, one.why);
      EXPECT_EQ(hd->disabled, times) << one.call;
      EXPECT_EQ(hd->running, 0);
      EXPECT_EQ(hd->misuses, 0);
    }
    hd->error = 0;
    const auto stylus = unthreaded();
    stylus->open();
    EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); })) << one.call;
  }
}

/// Warnings of the force (0x2xx) say nothing against a device, how many there are and wherever they lie on the stack;
/// an error beneath them does, and so does one above them.
TEST_F(Touch, WarningsAtItsInitializationArePassedOver) {
  for (const unsigned warning : {0x200U, 0x201U, 0x202U, 0x203U, 0x204U}) {
    *hd = FakeHd{};
    for (unsigned& one : hd->at_init) one = warning;
    const auto stylus = unthreaded();
    stylus->open();
    EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); })) << warning;
    EXPECT_EQ(stylus->fault(), LinkFault::none) << "the warning is not kept for the first round";
    stylus->close();
    EXPECT_EQ(hd->disabled, 1);
    for (const int place : {0, 3}) {
      hd->at_init[place] = 0x302;
      const int disabled = hd->disabled;
      expect_refusal([] { unthreaded()->open(); }, "it cannot be opened: a fault of the fake");
      EXPECT_EQ(hd->disabled, disabled + 1) << "what was initialized is not left so";
      hd->at_init[place] = warning;
    }
  }
}

/// One round may fail in several ways: the gravest counts, wherever it lies on the stack.
TEST_F(Touch, OfSeveralErrorsTheGravestCounts) {
  const auto stylus = unthreaded();
  stylus->open();
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  hd->error = 0x200;  // it lies above the one of the unplugging
  hd->unplugged = 1;
  EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->fault() != LinkFault::none; }));
  EXPECT_EQ(stylus->fault(), LinkFault::unplugged);
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
  function_of_libhd<void (*)(bool)>("fake_hd_by_hand")(false);
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

/// What the library called back with after the last exchange of a session is not the next session's.
TEST_F(Touch, AnErrorOfTheSessionBeforeIsNotToldAsNew) {
  const auto stylus = unthreaded();
  stylus->open();
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  hd->error = 0x302;
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->fault() == LinkFault::unplugged; }));
  pass(0.003);
  stylus->close();
  hd->error = 0;
  stylus->open();
  stylus->service(0);  // before the library calls back
  EXPECT_EQ(stylus->fault(), LinkFault::none);
  EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
}

TEST_F(Touch, WaitsAsLongAsItIsToldThoughTheWallClockIsSet) {
  TouchDriver driver(TouchSettings{}, DriverClock{&impatient_now, &pass});
  driver.connect();
  wall_clock_is_set_ahead = true;
  const double begun = monotonic_time();
  driver.take(0.02);
  EXPECT_GE(monotonic_time() - begun, 0.02);
  wall_clock_is_set_ahead = false;
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
  function_of_libhd<void (*)(bool)>("fake_hd_by_hand")(false);
  for (const bool arrives : {true, false}) {
    *hd = FakeHd{};
    hd->force[1] = 1;
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

/// The guardian comes when something went wrong: a warning on the stack keeps no zero from the device, and a device
/// that it could not open is left as it was found, so that the next try is as good as the first.
TEST_F(Touch, TheGuardiansZerosAreSentInSpiteOfWarnings) {
  function_of_libhd<void (*)(bool)>("fake_hd_by_hand")(false);
  for (const unsigned warning : {0x200U, 0x201U, 0x202U, 0x203U, 0x204U}) {
    *hd = FakeHd{};
    hd->force[1] = 1;
    hd->error = hd->at_init[0] = hd->at_init[1] = warning;
    EXPECT_TRUE(send_zeros_to_touch("")) << warning;
    EXPECT_EQ(acting(), Vec3(0)) << warning;
    EXPECT_EQ(hd->disabled, 1);
    hd->force[1] = 1;
    hd->error = 0;
    hd->at_init[2] = 0x302;
    EXPECT_FALSE(send_zeros_to_touch("")) << warning;
    EXPECT_EQ(hd->disabled, 2);
    hd->at_init[2] = 0;
    EXPECT_TRUE(send_zeros_to_touch("")) << "a second try is not refused for the first";
    EXPECT_EQ(acting(), Vec3(0));
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
