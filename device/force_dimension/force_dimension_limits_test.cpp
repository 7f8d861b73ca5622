/// A Force Dimension arm's limits, each reached.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <string>

#include "device/force_dimension/force_dimension.h"
#include "device/testing/force_dimension_fixture.h"

namespace palpate::device {
namespace {

class ForceDimensionLimits : public ForceDimensionFixture {};

/// Theirs: x towards the user, y right, z up.
TEST_F(ForceDimensionLimits, AnyPoseAndForceChangeFrames) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto driver = connected({.maximum_force = 3});
  for (int n = 0; n < 200; ++n) {
    const Vec3 theirs = 0.2 * Vec3(uniform(random), uniform(random), uniform(random));
    put(theirs);
    drd->buttons = random() % 16;
    driver->take(1);
    EXPECT_EQ(driver->status().position, Vec3(theirs.y, theirs.z, theirs.x));
    EXPECT_EQ(driver->status().buttons, drd->buttons);
    EXPECT_EQ(driver->status().news, static_cast<std::uint64_t>(n) + 1);
    const Vec3 force = 4.0 * Vec3(uniform(random), uniform(random), uniform(random));
    driver->give(force);
    const Vec3 given(drd->force[1], drd->force[2], drd->force[0]);
    EXPECT_LT(glm::distance(given, force * std::min(1.0, 3 / glm::length(force))), 1e-12);
  }
  EXPECT_EQ(drd->torques, 0);
}

/// Both sides of a rotation change their frame: it turns our vectors as it turns theirs. A frame that cannot be read
/// leaves the stylus as it was turned, and an arm without a wrist is not turned.
TEST_F(ForceDimensionLimits, AnyFrameTurnsTheStylus) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const auto ours = [](const Vec3& theirs) { return Vec3(theirs.y, theirs.z, theirs.x); };
  for (const bool has_wrist : {true, false}) {
    drd->has_wrist = has_wrist ? 1 : 0;
    const auto driver = connected();
    for (int n = 0; n < 50; ++n) {
      const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
      const glm::dquat turn = glm::normalize(glm::dquat(w, x, y, z));
      const glm::dmat3 matrix = glm::mat3_cast(turn);
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) drd->frame[row][column] = matrix[column][row];
      }
      driver->take(1);
      const glm::dquat told = driver->status().orientation;
      EXPECT_NEAR(glm::length(told), 1, 1e-12);
      for (const Vec3& v : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
        EXPECT_LT(glm::distance(told * ours(v), has_wrist ? ours(turn * v) : ours(v)), 1e-12);
      }
      drd->frame_fails = 1;
      drd->frame[0][0] += 1;
      driver->take(1);
      EXPECT_EQ(driver->status().orientation, told);
      drd->frame_fails = 0;
    }
  }
}

TEST_F(ForceDimensionLimits, NoArmReachesFartherThanAMetre) {
  for (const double reach : {0.999, 1.001, HUGE_VAL, std::nan("")}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 place(0);
      place[axis] = -reach;
      put(place);
      const auto driver = connected();
      driver->take(1);
      EXPECT_EQ(driver->status().fault, reach < 1 ? LinkFault::none : LinkFault::unreachable_pose);
      EXPECT_EQ(driver->status().state, reach < 1 ? State::idle : State::fault);
      put(Vec3(0));
      driver->take(1);
      EXPECT_EQ(driver->status().state, reach < 1 ? State::idle : State::fault) << "it is kept";
      driver->give(Vec3(0, 1, 0));
      EXPECT_EQ(drd->force[2], reach < 1 ? 1 : 0);
    }
  }
}

/// The least of the settings' force and the arm's own; 12 N at most where the settings ask for none, or the arm tells
/// none. A Falcon bears 8 N, whatever the library tells.
TEST_F(ForceDimensionLimits, TheLargestForceIsTheLeastThatIsSaid) {
  const struct {
    double set, told, largest;
    int type = 33;
  } cases[] = {{0, 8, 8},      {0, 12, 12},   {0, 20, 12},     {0, 0.5, 0.5},  {0, 0, 12},
               {0, -1, 12},    {0.5, 8, 0.5}, {12, 8, 8},      {10, 20, 10},   {12, 0, 12},
               {0, 12, 8, 60}, {0, 0, 8, 60}, {12, 12, 8, 60}, {3, 12, 3, 60}, {0, 5, 5, 60}};
  for (const auto& one : cases) {
    drd->max_force = one.told;
    drd->type = one.type;
    const auto driver = connected({.maximum_force = one.set});
    Specification told;
    driver->describe(told);
    EXPECT_EQ(told.maximum_force, one.largest);
    EXPECT_EQ(told.continuous_force, one.largest);
    EXPECT_EQ(drd->told_max_force, one.largest);
    driver->take(1);
    driver->give(Vec3(0, 100, 0));
    EXPECT_DOUBLE_EQ(drd->force[2], one.largest);
  }
  EXPECT_EQ(make_force_dimension({.maximum_force = 0.5})->specification().maximum_force, 0.5);
}

/// Before a force can act, its firmware knows when to take it away and how large it may be; what the regulation of the
/// homing left on is gone by then.
TEST_F(ForceDimensionLimits, ItIsLimitedBeforeItsForcesAreSwitchedOn) {
  for (const bool homes : {false, true}) {
    *drd = FakeDrd{};
    drd->homed = homes ? 0 : 1;
    const auto driver = connected({.may_home = true});
    EXPECT_STREQ(drd->order, "S0WME0");
    EXPECT_EQ(drd->force[2], 0) << "the regulation's last force";
    EXPECT_EQ(drd->forces_on, 1);
  }
}

/// To stop a regulation that never ran is no failure, and one that cannot be stopped is.
TEST_F(ForceDimensionLimits, ARegulationIsStoppedOnlyIfItRan) {
  std::strcpy(drd->failing_call, "drdStop");
  EXPECT_EQ(refusal([] { connected(); }), "");
  drd->homed = 0;
  EXPECT_THAT(refusal([] { connected({.may_home = true}); }), ::testing::HasSubstr("forces cannot be switched on"));
  EXPECT_EQ(drd->forces_on, 0);
}

/// Only some models have a watchdog: of one that has none nobody is promised its 30 ms.
TEST_F(ForceDimensionLimits, AWatchdogIsPromisedWhereThereIsOne) {
  for (const int has : {1, 0}) {
    drd->has_watchdog = has;
    auto driver = connected();
    Specification told;
    driver->describe(told);
    EXPECT_EQ(told.watchdog,
              has != 0 ? "30 ms, in its firmware" : "none of its own: without palpate-guardian, switch it off");
    driver->disconnect();
    for (const int homed : {1, 0}) {
      drd->homed = homed;
      const std::string note = find_force_dimension().at(0).note;
      EXPECT_EQ(note.find("watchdog: none of its own") != std::string::npos, has == 0) << note;
      EXPECT_EQ(note.find("no home") != std::string::npos, homed == 0) << note;
    }
    drd->homed = 1;
  }
}

/// A good pose says nothing for a force, and a force nothing for a pose.
TEST_F(ForceDimensionLimits, AForceThatIsRefusedIsToldApartFromThePoses) {
  const auto driver = connected();
  driver->take(1);
  EXPECT_EQ(driver->give(Vec3(0, 1, 0)), ForceAnswer::taken);
  std::strcpy(drd->failing_call, "dhdSetForceAndTorqueAndGripperForce");
  for (int n = 0; n < 100; ++n) {
    const std::uint64_t news = driver->status().news;
    driver->take(1);
    EXPECT_EQ(driver->status().news, news + 1);
    EXPECT_EQ(driver->give(Vec3(0, 1, 0)), ForceAnswer::refused);
  }
  EXPECT_FALSE(driver->lost());
  std::strcpy(drd->failing_call, "dhdGetPosition");
  for (int n = 0; n < 20; ++n) {
    EXPECT_FALSE(driver->lost()) << n;
    driver->take(1);
    EXPECT_EQ(driver->give(Vec3(0, 1, 0)), ForceAnswer::taken);
  }
  EXPECT_TRUE(driver->lost());
}

/// The library writes as many numbers as its version knows.
TEST_F(ForceDimensionLimits, AStatusOfAnyLengthIsRead) {
  for (const int size : {14, 17, 32, 64}) {
    drd->status_size = size;
    const auto driver = connected();
    for (int n = 0; n < 20; ++n) driver->take(1);
    EXPECT_EQ(drd->status_reads, 1) << size;
    EXPECT_EQ(driver->status().state, State::idle) << size;
    drd->status_reads = 0;
  }
}

/// 65535, or no answer, is the number of none: it is found and opened without an address, and by no address.
TEST_F(ForceDimensionLimits, ADeviceWithoutASerialNumberHasNoAddress) {
  for (const bool answers : {true, false}) {
    drd->serial = 65535;
    drd->serial_fails = answers ? 0 : 1;
    EXPECT_EQ(find_force_dimension().at(0).address, "");
    EXPECT_EQ(refusal([] { connected(); }), "");
    for (const char* const number : {"65535", "0"}) {
      EXPECT_NE(refusal([&] { connected({.address = number}); }), "");
      EXPECT_FALSE(stop_force_dimension(number));
    }
    EXPECT_TRUE(stop_force_dimension(""));
  }
}

/// Twenty poses in a row that fail are a device that is gone; nineteen are not, whatever failed before them.
TEST_F(ForceDimensionLimits, TwentyErrorsInARowAreAnUnplugging) {
  const auto driver = connected();
  for (int round = 0; round < 3; ++round) {
    drd->failing = 1;
    for (int n = 0; n < 19; ++n) driver->take(1);
    EXPECT_FALSE(driver->lost());
    drd->failing = 0;
    driver->take(1);
  }
  drd->failing = 1;
  for (int n = 0; n < 20; ++n) {
    EXPECT_FALSE(driver->lost());
    driver->take(1);
  }
  EXPECT_TRUE(driver->lost());
}

/// Its status is looked at with every twentieth pose: a lost home, an error or a force that the user has switched off
/// ends the session; a status that cannot be read tells nothing.
TEST_F(ForceDimensionLimits, ItsStatusIsBelieved) {
  const struct {
    int FakeDrd::*what;
    int value;
    LinkFault fault;
  } cases[] = {{&FakeDrd::homed, 0, LinkFault::unhomed},
               {&FakeDrd::in_error, 1, LinkFault::own_safety},
               {&FakeDrd::in_error, -3, LinkFault::own_safety},
               {&FakeDrd::no_force, 1, LinkFault::own_safety},
               {&FakeDrd::has_wrist, 1, LinkFault::none}};
  for (const bool readable : {true, false}) {
    for (const auto& one : cases) {
      *drd = FakeDrd{};
      const auto driver = connected();
      drd->*one.what = one.value;
      drd->status_fails = readable ? 0 : 1;
      for (int n = 1; n < 20; ++n) driver->take(1);
      EXPECT_EQ(drd->status_reads, 0);
      EXPECT_EQ(driver->status().state, State::idle);
      driver->take(1);
      const LinkFault fault = readable || one.fault == LinkFault::unhomed ? one.fault : LinkFault::none;
      EXPECT_EQ(driver->status().fault, fault);
      EXPECT_EQ(driver->status().state, fault == LinkFault::none ? State::idle : State::fault);
    }
  }
}

/// It is asked again half a millisecond after it was last due, or now where that is past, and waited for no longer than
/// the caller has.
TEST_F(ForceDimensionLimits, IsAskedEveryHalfMillisecond) {
  const auto driver = connected();
  const auto waited = [&](double most) {
    const double before = time;
    driver->take(most);
    return time - before;
  };
  EXPECT_EQ(waited(1), 0) << "at once";
  EXPECT_NEAR(waited(1), 0.5e-3, 1e-12);
  pass(0.2e-3);
  EXPECT_NEAR(waited(1), 0.3e-3, 1e-12);
  pass(0.1);
  EXPECT_EQ(waited(1), 0);
  EXPECT_EQ(waited(1), 0) << "what was missed is not made up for, but for one";
  EXPECT_NEAR(waited(0.1e-3), 0.1e-3, 1e-12);
}

}  // namespace
}  // namespace palpate::device
