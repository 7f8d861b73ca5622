/// A Touch's limits, each reached, and that no round of the library's counts twice.

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/geometric.hpp>
#include <random>
#include <string>

#include "device/link/realtime.h"
#include "device/testing/fake_libhd.h"
#include "device/touch/touch.h"
#include "device/touch/touch_driver.h"

namespace palpate::device {
namespace {

template <typename Function>
Function of_library(const char* name) {
  return reinterpret_cast<Function>(dlsym(dlopen(PALPATE_FAKE_LIBHD, RTLD_NOW | RTLD_NODELETE), name));
}

constexpr double ms = 1e-3;

/// Rounds come by hand, by a clock that only they move.
class TouchLimits : public ::testing::Test {
 protected:
  TouchLimits() {
    setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
    hd = of_library<FakeHd* (*)()>("fake_hd")();
    *hd = FakeHd{};
    of_library<void (*)(bool)>("fake_hd_by_hand")(true);
  }
  ~TouchLimits() override {
    of_library<void (*)(bool)>("fake_hd_by_hand")(false);
    unsetenv("PALPATE_LIBHD");
  }
  static double now() noexcept { return time; }
  static void pass(double seconds) noexcept { time += seconds; }
  static void round(double seconds = ms) {
    static const auto call = of_library<void (*)()>("fake_hd_call");
    time += seconds;
    call();
  }
  Vec3 acting() const { return {hd->force[0], hd->force[1], hd->force[2]}; }
  /// What a device of this model and these settings says of itself.
  Specification told(const char* model, const TouchSettings& settings = {}) const {
    std::strncpy(hd->model, model, sizeof hd->model - 1);
    TouchDriver driver(settings, {&now, &pass});
    driver.connect();
    Specification specification;
    driver.describe(specification);
    return specification;
  }

  FakeHd* hd = nullptr;
  inline static double time = 50;  // s
};

/// Any force and stiffness above zero that the library tells is its device's, however small.
TEST_F(TouchLimits, WhatTheLibraryTellsIsBelieved) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.01, 1);
  for (int n = 0; n < 50; ++n) {
    hd->force_newtons = uniform(random);
    hd->continuous_newtons = hd->force_newtons * uniform(random);
    hd->stiffness_newtons_per_mm = 0.35 * uniform(random);
    for (int axis = 0; axis < 3; ++axis) {
      hd->box_mm[axis] = -1000 * uniform(random);
      hd->box_mm[axis + 3] = 1000 * uniform(random);
    }
    const Specification can = told("Touch");
    EXPECT_DOUBLE_EQ(can.maximum_force, hd->force_newtons);
    EXPECT_DOUBLE_EQ(can.continuous_force, hd->continuous_newtons);
    EXPECT_DOUBLE_EQ(can.stiffness_limit, 1e3 * hd->stiffness_newtons_per_mm);
    EXPECT_EQ(can.orientation_axes, 3);
    EXPECT_EQ(can.rate, 1000);
    EXPECT_EQ(can.position_resolution, 0.055e-3);
    for (int axis = 0; axis < 3; ++axis) {
      const double reach = 1e-3 * std::min(-hd->box_mm[axis], hd->box_mm[axis + 3]);
      EXPECT_DOUBLE_EQ(can.workspace_half_extent[axis], reach > 0.01 ? reach : 0.05);
    }
  }
}

/// A box that does not reach farther than 1 cm, or reaches 1 m, is none that a hand works in.
TEST_F(TouchLimits, ABoxThatCannotBeIsNotBelieved) {
  for (const auto& [edge_mm, half_m] :
       {std::pair{9.9, 0.05}, {10.0, 0.05}, {10.1, 0.0101}, {999.0, 0.999}, {1000.0, 0.05}}) {
    for (int axis = 0; axis < 3; ++axis) {
      hd->box_mm[axis] = -edge_mm;
      hd->box_mm[axis + 3] = edge_mm;
    }
    EXPECT_LT(glm::distance(told("Touch").workspace_half_extent, Vec3(half_m)), 1e-12) << edge_mm;
  }
}

/// N/m that each model bears, by a word of its name; the settings go before all of it.
TEST_F(TouchLimits, EachModelHasItsStiffness) {
  hd->stiffness_newtons_per_mm = 10;
  EXPECT_EQ(told("PHANToM Omni").stiffness_limit, 700);
  EXPECT_EQ(told("Desktop").stiffness_limit, 1000);
  EXPECT_EQ(told("PHANTOM Premium 1.5").stiffness_limit, 1000);
  EXPECT_EQ(told("Touch X").stiffness_limit, 400);
  EXPECT_EQ(told("another").stiffness_limit, 400);
  EXPECT_EQ(told("another").name, "another");
  hd->model[0] = 0;
  EXPECT_EQ(told("").name, "Touch") << "it does not say";
  const TouchSettings settings{.maximum_force = 0.5, .stiffness_limit = 0.75};
  EXPECT_EQ(told("Desktop", settings).stiffness_limit, 0.75);
  EXPECT_EQ(told("Desktop", settings).maximum_force, 0.5);
  EXPECT_EQ(told("Desktop", settings).continuous_force, 0.5) << "no motor lasts at more";
}

/// 1 kHz, at HD_MAX_SCHEDULER_PRIORITY, which is USHRT_MAX, of the device that was opened.
TEST_F(TouchLimits, IsScheduledAsTheLibraryAsks) {
  TouchDriver driver({}, {&now, &pass});
  driver.connect();
  EXPECT_EQ(hd->rate_hz, 1000U);
  EXPECT_EQ(hd->priority, 65535);
  EXPECT_EQ(hd->made_current, 7U);
}

/// However many rounds there were since, one look takes the newest pose, once.
TEST_F(TouchLimits, APoseIsTakenOnce) {
  TouchDriver driver({}, {&now, &pass});
  driver.connect();
  std::uint64_t news = 0;
  for (const int rounds : {1, 5, 0, 2, 0, 0, 17}) {
    for (int n = 1; n <= rounds; ++n) {
      hd->place_mm[0] = n;
      round();
    }
    news += rounds > 0 ? 1 : 0;
    for (int look = 0; look < 3; ++look) driver.take(0);
    EXPECT_EQ(driver.status().news, news) << rounds;
    if (rounds > 0) {
      EXPECT_DOUBLE_EQ(driver.status().position.x, 1e-3 * rounds);
    }
  }
}

/// Where no round comes it is waited for, and no pose is told.
TEST_F(TouchLimits, ARoundIsWaitedForAsLongAsItIsTold) {
  TouchDriver driver({}, {&now, &pass});
  driver.connect();
  for (const double wait_s : {0.005, 0.02}) {
    const double begun = monotonic_time();
    driver.take(wait_s);
    EXPECT_GE(monotonic_time() - begun, 0.99 * wait_s);
    EXPECT_EQ(driver.status().news, 0U);
  }
}

/// A force lasts for nineteen rounds after the one that it came in, and ends with the next; a pause of more than a
/// tenth of a second ends it at once, and one that was given before such a pause is nothing to begin with.
TEST_F(TouchLimits, AForceEndsAfterTwentyRoundsOrAPause) {
  TouchDriver driver({}, {&now, &pass});
  driver.connect();
  const Vec3 force(0.5, -0.25, 1);
  round();
  EXPECT_EQ(acting(), Vec3(0)) << "none was given";
  for (int again = 0; again < 2; ++again) {
    driver.give(force);
    for (int n = 0; n < 20; ++n) {
      round();
      EXPECT_EQ(acting(), force) << n;
    }
    for (int n = 0; n < 30; ++n) {
      round();
      EXPECT_EQ(acting(), Vec3(0)) << n;
    }
  }
  for (const double pause : {0.099, 0.101}) {
    driver.give(force);
    round();
    EXPECT_EQ(acting(), force);
    round(pause);
    EXPECT_EQ(acting(), pause < 0.1 ? force : Vec3(0));
    driver.give(force);
    round(pause);
    EXPECT_EQ(acting(), pause < 0.1 ? force : Vec3(0)) << "given before the pause";
    round();
    EXPECT_EQ(acting(), pause < 0.1 ? force : Vec3(0));
  }
}

/// However long ago an earlier round was, the first one is no pause.
TEST_F(TouchLimits, AForceThatIsGivenBeforeTheFirstRoundActsInIt) {
  for (int connection = 0; connection < 2; ++connection) {
    pass(5);
    TouchDriver driver({}, {&now, &pass});
    driver.connect();
    driver.give(Vec3(0, 1, 0));
    round();
    EXPECT_EQ(acting(), Vec3(0, 1, 0));
  }
}

/// Its home is looked at every hundredth round; where it can find it by itself it is told to, in its own style, until
/// it once had one.
TEST_F(TouchLimits, LooksAtItsHomeEveryHundredRounds) {
  hd->calibration = 0x5001;
  hd->after_update = 0x5002;
  TouchDriver driver({}, {&now, &pass});
  driver.connect();
  for (int n = 1; n <= 250; ++n) {
    round();
    EXPECT_EQ(hd->updates, n <= 100 ? 1 : 2) << n;
    if (n == 50) hd->calibration = 0x5001;
    if (n == 150) hd->calibration = 0x5000;
    driver.take(0);
    EXPECT_EQ(driver.status().state, n <= 200 ? State::homing : State::idle) << n;
  }
  EXPECT_EQ(hd->updates, 2);
  EXPECT_EQ(hd->style, 4U) << "the inkwell's, which is all that it has";
}

/// In metres, wherever it is, up to one.
TEST_F(TouchLimits, NoArmReachesFartherThanAMetre) {
  for (const double mm : {999.0, 1001.0, std::nan("")}) {
    for (int axis = 0; axis < 3; ++axis) {
      *hd = FakeHd{};
      hd->place_mm[axis] = -mm;
      TouchDriver driver({}, {&now, &pass});
      driver.connect();
      round();
      driver.take(0);
      EXPECT_EQ(driver.status().fault, mm < 1000 ? LinkFault::none : LinkFault::unreachable_pose);
      EXPECT_EQ(driver.status().position[axis], mm < 1000 ? -1e-3 * mm : 0);
    }
  }
}

/// Column by column, as OpenGL has it; what is no rotation turns nothing.
TEST_F(TouchLimits, AnyTransformTurnsTheStylus) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 50; ++n) {
    const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    const glm::dmat3 turned = glm::mat3_cast(glm::normalize(glm::dquat(w, x, y, z)));
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) hd->transform[4 * column + row] = turned[column][row];
    }
    for (const bool usable : {true, false}) {
      if (!usable) hd->transform[5] = std::nan("");
      TouchDriver driver({}, {&now, &pass});
      driver.connect();
      round();
      driver.take(0);
      const glm::dmat3 told = glm::mat3_cast(driver.status().orientation);
      const glm::dmat3 wanted = usable ? turned : glm::dmat3(1);
      for (int column = 0; column < 3; ++column) EXPECT_LT(glm::distance(told[column], wanted[column]), 1e-12);
    }
  }
}

/// Five zeros that the library bears are enough, and four are not.
TEST_F(TouchLimits, TheGuardianNeedsFiveZeros) {
  of_library<void (*)(bool)>("fake_hd_by_hand")(false);
  for (const int zeros : {4, 5}) {
    *hd = FakeHd{};
    hd->sound_calls = zeros;
    hd->error = 0x302;
    EXPECT_EQ(send_zeros_to_touch(""), zeros == 5) << zeros;
    EXPECT_EQ(hd->priority, 65535);
    EXPECT_EQ(hd->made_current, 7U);
  }
}

/// The library's thread takes the last force within three of its rounds.
TEST_F(TouchLimits, TheLastForceIsWaitedForThreeRounds) {
  TouchDriver driver({}, {&now, &pass});
  driver.connect();
  for (const auto& [most_s, waited_s] : {std::pair{0.020, 0.003}, {0.002, 0.002}, {0.003, 0.003}}) {
    const double before = time;
    driver.flush(most_s);
    EXPECT_NEAR(time - before, waited_s, 1e-9);
  }
}

}  // namespace
}  // namespace palpate::device
