/// The bounds on a wall's stiffness, against a mass that swings on a sampled and delayed spring.

#include "device/safety/stiffness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate::device {
namespace {

/// How much energy is left, after two seconds, of a mass of 1 kg that swings on this wall: the position is read once a
/// period, and the force acts `delay_periods` later and is held for a period.
double energy_left(double stiffness, double damping, double period, int delay_periods) {
  constexpr int parts = 100;
  const double dt = period / parts;
  double x = 1e-3, v = 0;
  std::vector<double> forces(static_cast<std::size_t>(delay_periods) + 1, -stiffness * x);
  const auto energy = [&] { return 0.5 * stiffness * x * x + 0.5 * v * v; };
  const double before = energy();
  for (double time = 0; time < 2; time += period) {
    std::rotate(forces.begin(), forces.end() - 1, forces.end());
    forces.front() = -stiffness * x;
    for (int part = 0; part < parts; ++part) {
      v += dt * (forces.back() - damping * v);
      x += dt * v;
    }
  }
  return energy() / before;
}

/// A slow swing keeps its energy just at the passive bound: below it loses, above it gains.
TEST(StiffnessBounds, JustAtThePassiveOneAWallNeitherTakesNorGivesEnergy) {
  for (const double period : {1e-3, 0.5e-3}) {
    for (const int delay_periods : {0, 1, 3}) {
      const RenderingDynamics dynamics{
          .device_damping = 1, .hand_damping = 0, .period = period, .delay = delay_periods * period};
      const double bound = stiffness_bounds(dynamics).passive;
      EXPECT_LT(energy_left(0.8 * bound, 1, period, delay_periods), 0.8) << period << " " << delay_periods;
      EXPECT_NEAR(energy_left(bound, 1, period, delay_periods), 1, 0.15) << period << " " << delay_periods;
      EXPECT_GT(energy_left(1.2 * bound, 1, period, delay_periods), 1.25) << period << " " << delay_periods;
    }
  }
}

/// The hand's damping adds to the arm's. Friction takes up the energy 4 c A of a swing of A on steps D, which gives at
/// most 2 k D A.
TEST(StiffnessBounds, AreOfTheirOwnCause) {
  const RenderingDynamics dynamics{.device_damping = 0.3,
                                   .hand_damping = 1.7,
                                   .coulomb_friction = 0.06,
                                   .position_step = 2e-5,
                                   .period = 1e-3,
                                   .delay = 0.5e-3};
  const StiffnessBounds bounds = stiffness_bounds(dynamics, 3000, 0.5);
  RenderingDynamics stiff = dynamics;
  stiff.device_damping = 2;
  EXPECT_DOUBLE_EQ(bounds.held, stiffness_bounds(stiff).passive);
  EXPECT_DOUBLE_EQ(4 * 0.06 * 1e-3, 2 * bounds.near_rest * 2e-5 * 1e-3);
  EXPECT_TRUE(std::isinf(stiffness_bounds({.device_damping = 1, .coulomb_friction = 1}).near_rest));
}

/// Never above what is configured; else the passive bound, or a part of the lesser of the others if that is more.
TEST(StiffnessBounds, TheAdvisedOneIsHeldByEach) {
  RenderingDynamics dynamics{.device_damping = 0.1, .hand_damping = 3, .period = 1e-3};  // 200 and 6200 N/m
  EXPECT_NEAR(stiffness_bounds(dynamics, 1e9, 0.5).advised, 3100, 1e-6);
  EXPECT_EQ(stiffness_bounds(dynamics, 900, 0.5).advised, 900);
  dynamics.position_step = 1e-5;
  dynamics.coulomb_friction = 0.01;  // 2000 N/m
  EXPECT_NEAR(stiffness_bounds(dynamics, 1e9, 0.5).advised, 1000, 1e-6);
  dynamics.coulomb_friction = 0.001;  // 200 N/m
  EXPECT_NEAR(stiffness_bounds(dynamics, 1e9, 0.5).advised, 200, 1e-6);
}

}  // namespace
}  // namespace palpate::device
