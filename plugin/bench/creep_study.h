#pragma once

/// The accumulation of a solver's errors over many ticks. The probe itself is moved (no device, no hand), and the proxy
/// follows.

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
  std::string ideal;  ///< the result of an exact solver in exact arithmetic, in words
};

/// creep: fraction of the force lost in `seconds` at rest with noise in a cavity of 10 mm. drift: distance of a proxy
/// from the surface after sliding along a flat slab. hysteresis: largest difference of force between pressing and
/// releasing. pop-through: largest force before a wall of 1 N yields. rest chatter: peak to peak of the force while the
/// probe is perfectly still.
std::vector<CreepStudyRow> study_creep(double seconds, const std::function<void(double)>& progress);

}  // namespace palpate::plugin
