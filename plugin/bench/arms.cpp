#include "plugin/bench/arms.h"

namespace palpate::plugin {

std::vector<SimulatedArm> simulated_arms() {
  using device::SimulatedDevice;
  return {
      {"simulated", SimulatedDevice{}, "a Desktop PHANTOM's data sheet: 45 g, friction 0.06 N, steps of 0.02 mm"},
      {"Touch",
       SimulatedDevice{.arm = {.mass = 0.045, .coulomb_friction = 0.26},
                       .position_step = 0.055e-3,
                       .maximum_force = 3.3,
                       .continuous_force = 0.88},
       "the maker's data sheet: 45 g at the tip, friction 0.26 N, steps of 0.055 mm, 3.3 N, 1 kHz"},
      {"omega.3",
       SimulatedDevice{.arm = {.mass = 0.2, .coulomb_friction = 0.1},
                       .position_step = 0.01e-3,
                       .maximum_force = 12,
                       .continuous_force = 12},
       "the maker's data sheet: steps of 0.01 mm, 12 N; assumed: 200 g, friction 0.1 N"},
      {"Inverse3",
       SimulatedDevice{.arm = {.mass = 0.15, .coulomb_friction = 0.1},
                       .position_step = 0.01e-3,
                       .delay = 1.5e-3,
                       .maximum_force = 10,
                       .continuous_force = 5},
       "assumed: 150 g, friction 0.1 N, steps of 0.01 mm, 10 N, and a tick more of delay for the maker's service"},
  };
}

std::vector<SimulatedHand> simulated_hands() {
  return {{"loose", {.mass = 0.03, .stiffness = 150, .damping = 2}},
          {"usual", {}},
          {"firm", {.mass = 0.08, .stiffness = 1500, .damping = 8}}};
}

}  // namespace palpate::plugin
