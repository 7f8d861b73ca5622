#include "device/safety/sustained.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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

/// Whatever is asked for and however long it rests in between: over no stretch of time does more heat come than that of
/// the peak for its time. A rest gives no credit.
TEST(SustainedLoad, NoStretchOfTimeHasMoreHeatThanThePeakForItsTime) {
  std::mt19937 random(1);
  SustainedLoad load;
  double most = 0;  // of all stretches that end now
  double largest = 0;
  for (int n = 0; n < 200; ++n) {
    const double asked = n % 2 == 0 ? 0 : std::uniform_real_distribution<double>(0, 2)(random);
    const int steps = static_cast<int>(random() % (n % 10 == 0 ? 100'000 : 10'000));
    for (int step = 0; step < steps; ++step) {
      const double given = std::min(asked, load.allowed(motor));
      load.add(motor, given, 1e-3);
      most = std::max(0.0, most + (given * given - 1) * 1e-3);
      ASSERT_LE(most, 12 + 1e-9) << "(2^2 - 1^2) x 4 s";
    }
    largest = std::max(largest, most);
  }
  EXPECT_GT(largest, 9) << "the limit is reached";
  // After any rest, the peak lasts as long as on a motor that was never used.
  for (const double rest : {10.0, 60.0, 600.0}) {
    SustainedLoad rested, unused;
    after(rested, 0, rest);
    for (int ms = 0; ms < 8000; ++ms) ASSERT_DOUBLE_EQ(after(rested, 2, 1e-3), after(unused, 2, 1e-3)) << rest;
  }
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
