#pragma once

/// A hand on a sphere of 5 cm with a soft edge, for which the right answer is known: `palpate-bench tick --sphere`.

#include <string>

namespace palpate::plugin {

struct SphereFigures {
  int voxels = 0;  ///< along an edge
  double felt_radius_mm = 0;
  double direction_median_deg = 0;  ///< of the force against the radius at the proxy, while sliding
  double direction_worst_deg = 0;   ///< in excess of v dt / R
  double rest_jump_p99_n = 0;       ///< change of the force in a tick of 1 ms, probe at rest
  double tick_median_us = 0, tick_p999_us = 0;
};

/// k = 400 N/m; the probe slides at 50 mm/s along great circles, 2 mm below the felt surface, then rests.
SphereFigures study_sphere(int voxels);

/// Prints the table, with CHAI3D's figures, and returns it as CSV.
std::string run_sphere_study();

}  // namespace palpate::plugin
