#pragma once

/// Strokes over real objects, measured with a tracked force sensor: text, one sample a line, as in the data repository
/// of Ruffaldi et al., "Standardized evaluation of haptic rendering systems", Haptics Symposium 2006 (its .traj files:
/// a stream of positions and forces).

#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "plugin/bench/force_errors.h"

namespace palpate::plugin {

struct MeasuredSample {
  double time_s = 0;          ///< 0 if the file has no times
  glm::dvec3 position_mm{0};  ///< of the tip on the object
  glm::dvec3 force_n{0};      ///< of the object on the tip
};

/// The default columns.
inline constexpr const char* usual_columns = "t,x,y,z,fx,fy,fz";

/// Numbers are separated by blanks, tabs, commas or semicolons. Lines that begin with # or % are comments; empty lines
/// are ignored. `columns`: a name for each column, in order; "-" ignores it. Throws InputRefused that names the file
/// and the line, or WrongUsage for the columns.
std::vector<MeasuredSample> read_trajectory(const std::filesystem::path& file, const std::string& columns);

/// Compares the measured force with the felt one. The probe is inside the object by force / stiffness, as in the
/// repository's own in-trajectories, so a perfect rendering gives the measured force. One tick a sample; the scene's
/// stiffness is `stiffness_n_per_mm`. Throws Refusal if a balance is not solved.
ForceErrors compare_with_measured(std::span<const MeasuredSample> samples, const FeltScene& felt,
                                  double stiffness_n_per_mm);

}  // namespace palpate::plugin
