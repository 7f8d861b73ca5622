/// When impossible poses are a fault: by a count of its own, and where the answer is known.

#include "device/link/pose_doubt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace palpate::device {
namespace {

constexpr double ms = 1e-3;

TEST(PoseDoubt, OnlyImpossiblePosesLastAfterTheirPatience) {
  for (const double begin : {ms, 5000.0}) {
    PoseDoubt doubt(0.25);
    doubt.ends(begin);
    for (int n = 1; n <= 79; ++n) ASSERT_FALSE(doubt.lasts(begin + n * ms)) << n;
    EXPECT_TRUE(doubt.lasts(begin + 81 * ms));
    doubt.forget();
    EXPECT_FALSE(doubt.lasts(begin + 500 * ms)) << "from here on it counts anew";
    EXPECT_FALSE(doubt.lasts(begin + 579 * ms));
    EXPECT_TRUE(doubt.lasts(begin + 581 * ms));
  }
}

/// Of a millisecond of doubt good poses take a quarter back in as long: of impossible poses that
/// are one in four 0.25 ms are left each time, which lasts after 1.28 s; one in six never lasts.
TEST(PoseDoubt, GoodPosesTakeItBackAtTheirRate) {
  for (const int every : {4, 6}) {
    PoseDoubt doubt(0.25);
    int lasted = 0;
    for (int n = 1; n <= 2000 && lasted == 0; ++n) {
      if (n % every != 0) {
        doubt.ends(n * ms);
      } else if (doubt.lasts(n * ms)) {
        lasted = n;
      }
    }
    if (every == 4) {
      EXPECT_NEAR(lasted, 1280, 12);
    } else {
      EXPECT_EQ(lasted, 0);
    }
  }
}

/// The time up to an impossible pose adds to the doubt, the time up to a possible one takes its share away, and there
/// is never less than none.
TEST(PoseDoubt, IsTheSumOfItsStretches) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> stretch(0, 4 * ms);
  for (const double recovery : {0.1, 0.5, 2.0}) {
    PoseDoubt doubt(recovery);
    double now = 10, sum = 0;
    doubt.ends(now);
    int lasting = 0;
    for (int n = 0; n < 3000; ++n) {
      const double elapsed = stretch(random);
      now += elapsed;
      if ((n / 200) % 2 == 0 ? random() % 4 != 0 : random() % 4 == 0) {
        sum += elapsed;
        ASSERT_EQ(doubt.lasts(now), sum > 0.080) << n;
        lasting += sum > 0.080 ? 1 : 0;
      } else {
        doubt.ends(now);
        sum = std::max(0.0, sum - recovery * elapsed);
      }
    }
    EXPECT_GT(lasting, 50);
    EXPECT_LT(lasting, 2900);
  }
}

}  // namespace
}  // namespace palpate::device
