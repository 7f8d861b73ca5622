#pragma once

/// A probe that slides along a wall with a known position: the errors of the force.

#include <vector>

#include "io/fields/field_source.h"
#include "modes/scene/scene.h"
#include "testdata/phantom.h"

namespace palpate::plugin {

enum class Wall {
  convex,  ///< a ball of 25 mm, from outside
  concave  ///< a cavity of 12 mm, from inside
};

testdata::Phantom phantom_of(Wall wall);

/// One surface, felt at the value half-way between air and soft tissue.
modes::Scene wall_scene();

struct Slide {
  double sub_steps = 0;  ///< of a tick, mean; includes halts
  double worst_deg = 0;  ///< angle of the force from the wall's normal at the probe
  double worst_force_n =
      0;  ///< difference of the force from k times the depth below the held iso-surface, along that normal
  double rms_true_n = 0;  ///< difference of the force from k times the depth below the wall itself, along that normal
  double drift_mm = 0;    ///< distance of the proxy from the iso-surface at which it was held, at the end
  int capped = 0;         ///< sub-steps in which a solver gave up
  std::vector<double> ticks_us;
};

/// Two rounds of a great circle, 1 ms a tick, 1.5 mm deep.
Slide slide_on(Wall wall, const io::FieldSource& source, const modes::Scene& scene, double speed_mm_per_s);

}  // namespace palpate::plugin
