#include "plugin/bench/hand_study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "solver/descent.h"

namespace palpate::plugin {
namespace {

TEST(HandStudy, RmsOfABandIsThatOfTheSinesInIt) {
  constexpr double rate = 1000;
  std::vector<double> signal;
  for (int n = 0; n < 1000; ++n) {
    const auto sine = [&](double hz) { return std::sin(2 * std::numbers::pi * hz * n / rate); };
    signal.push_back(5 + 3 * sine(10) + 0.4 * sine(100) + 0.3 * sine(400));
  }
  EXPECT_NEAR(band_rms(signal, rate, 30, 500), std::sqrt((0.16 + 0.09) / 2), 1e-9);
  EXPECT_NEAR(band_rms(signal, rate, 30, 200), 0.4 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(band_rms(signal, rate, 5, 20), 3 / std::sqrt(2.0), 1e-9);
}

TEST(HandStudy, SteadyIsWhatIsHeldAndStill) {
  const HandStudyRow still{.median_rms_n = 0.01, .steady_below_n = 0.02, .kept = 1};
  EXPECT_TRUE(is_steady(still));
  HandStudyRow rings = still, lost = still;
  rings.median_rms_n = 0.03;
  lost.kept = 0.7;
  EXPECT_FALSE(is_steady(rings));
  EXPECT_FALSE(is_steady(lost)) << "a hand in free space is as still as it can be";
}

TEST(HandStudy, OnEveryArmAndHandASoftWallIsHeldAndSteady) {
  // 200 N/m is below the passive bound of the first arm even without a hand: 300 N/m (device/safety/stiffness.h).
  const auto rows = study_hand({.hands = 1, .hold_s = 2, .stiffness_n_per_m = {200}}, [](double) {});
  int walls = 0;
  for (const HandStudyRow& row : rows) {
    if (row.solver == solver::descent_solver.name && row.scene != "surface + friction")
      continue;  // which loses that wall
    ++walls;
    EXPECT_TRUE(is_steady(row)) << row.scene << ", " << row.motion << ", " << row.arm << ", " << row.hand << ", "
                                << row.solver << ": kept " << row.kept << ", RMS " << row.median_rms_n << " N of "
                                << row.steady_below_n;
  }
  const int solvers = static_cast<int>(hand_study_solvers().size());
  EXPECT_EQ(walls, 4 * 3 * (2 * solvers + 2 * (solvers - 1)));
}

}  // namespace
}  // namespace palpate::plugin
