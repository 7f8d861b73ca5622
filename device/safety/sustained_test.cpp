#include "device/safety/sustained.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate::device {
namespace {

constexpr SustainedLimit motor{.continuous = 1, .peak = 2, .time = 4};

/// The last size given after asking for one for some seconds, in steps of a millisecond.
double after(SustainedLoad& load, double asked, double seconds) {
  double given = 0;
  for (int i = 0; i < static_cast<int>(seconds * 1e3); ++i) {
    given = std::min(asked, load.allowed(motor));
    load.add(motor, given, 1e-3);
  }
  return given;
}

TEST(SustainedLoad, GivesThePeakForThreeQuartersOfItsTime) {
  SustainedLoad load;
  EXPECT_DOUBLE_EQ(after(load, 2, 2.99), 2);
}

TEST(SustainedLoad, ComesDownToTheContinuousOne) {
  SustainedLoad load;
  after(load, 2, 60);
  EXPECT_NEAR(after(load, 2, 1), 1, 1e-3);
}

TEST(SustainedLoad, NeverGivesMoreHeatThanThePeakForItsTime) {
  SustainedLoad load;
  double heat = 0;
  for (int i = 0; i < 60'000; ++i) {
    const double given = std::min(2.0, load.allowed(motor));
    load.add(motor, given, 1e-3);
    heat += (given * given - 1) * 1e-3;
    ASSERT_LE(heat, 12 + 1e-9) << "(2^2 - 1^2) x 4 s";
  }
  EXPECT_GT(heat, 11.9);
}

TEST(SustainedLoad, RestGivesThePeakBack) {
  SustainedLoad load;
  after(load, 2, 60);
  after(load, 0, 12.1);  // 12 A^2 s leave at 1 A^2
  EXPECT_DOUBLE_EQ(after(load, 2, 0.5), 2);
}

TEST(SustainedLoad, TheContinuousOneLastsForEver) {
  SustainedLoad load;
  EXPECT_DOUBLE_EQ(after(load, 1, 100), 1);
}

TEST(SustainedLoad, AnUnknownLimitLimitsNothing) {
  EXPECT_TRUE(std::isinf(SustainedLoad{}.allowed({})));
}

}  // namespace
}  // namespace palpate::device
