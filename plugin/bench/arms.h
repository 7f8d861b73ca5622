#pragma once

/// Commercial arms and hands that hold them, as simulated devices: for `palpate-bench stability`.

#include <string>
#include <vector>

#include "device/simulated/simulated_stylus.h"

namespace palpate::plugin {

struct SimulatedArm {
  std::string name;
  device::SimulatedDevice device;  ///< with the default hand
  std::string source;              ///< which figures are published, and which assumed
};

/// The default simulated device; 3D Systems Touch; Force Dimension omega.3; Haply Inverse3.
std::vector<SimulatedArm> simulated_arms();

struct SimulatedHand {
  std::string name;
  device::HandModel model;
};

/// A loose, a usual and a firm grip. Published measurements of fingers and hands lie between them: stiffness 100 to
/// 1500 N/m, damping 2 to 8 N s/m (A. Z. Hajian and R. D. Howe, "Identification of the mechanical impedance at the
/// human finger tip", 1997).
std::vector<SimulatedHand> simulated_hands();

}  // namespace palpate::plugin
