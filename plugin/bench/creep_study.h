#pragma once

/// How a solver's errors add up over many ticks. The probe itself is moved (no device, no hand), and the proxy follows.

#include <functional>
#include <string>
#include <vector>

namespace palpate::plugin {

struct CreepStudyRow {
  std::string solver;
  std::string what;  ///< "creep", "drift", "hysteresis", "pop-through" or "rest chatter"
  std::string how;   ///< in words: the phantom and the motion
  double value = 0;
  std::string unit;
  std::string ideal;  ///< what an exact solver in exact arithmetic would give, in words
};

/// creep: share of the force lost in `seconds` at rest with noise in a cavity of 10 mm; drift: how far a proxy leaves
/// the surface while it slides along a flat slab; hysteresis: largest difference of force between pressing and
/// releasing; pop-through: largest force before a wall of 1 N yields; rest chatter: peak to peak of the force while the
/// probe is perfectly still.
std::vector<CreepStudyRow> study_creep(double seconds, const std::function<void(double)>& progress);

}  // namespace palpate::plugin
