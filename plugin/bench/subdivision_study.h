#pragma once

/// A probe that slides along a wall at increasing speeds, with different numbers of sub-steps a tick
/// (modes/tick/haptic_step.h). The walls have Gaussian edges, with exact value and gradient, so the movement is
/// measured and not the voxels.

#include "plugin/bench/wall_slide.h"

namespace palpate::plugin {

struct SubdivisionRow {
  Wall wall = Wall::convex;
  double speed_mm_per_s = 0;
  int most_sub_steps = 0;
  double sub_steps = 0;      ///< of a tick, mean
  double worst_deg = 0;      ///< angle of the force from the wall's normal at the probe
  double worst_force_n = 0;  ///< difference of the force from k times the probe's depth along that normal
  double drift_mm = 0;       ///< distance of the proxy from the iso-surface at which it was held, at the end
  double tick_us = 0;        ///< median, on the voxels of the same body
};

/// Two rounds of a great circle, 1 ms a tick, 1.5 mm deep, at k = 400 N/m.
SubdivisionRow study_subdivision(Wall wall, double speed_mm_per_s, int most_sub_steps);

}  // namespace palpate::plugin
