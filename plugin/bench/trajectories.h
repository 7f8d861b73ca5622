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

/// What is read where nothing else is said.
inline constexpr const char* usual_columns = "t,x,y,z,fx,fy,fz";

/// Numbers stand between blanks, tabs, commas or semicolons. Lines that begin with # or % are comments; empty lines do
/// not count. `columns`: a name each, in the file's order; "-" leaves one out. Throws InputRefused that names the file
/// and the line, or WrongUsage for the columns.
std::vector<MeasuredSample> read_trajectory(const std::filesystem::path& file, const std::string& columns);

/// The measured force against the felt one. The hand's probe lies in the object by force / stiffness, as the
/// repository's own in-trajectories do, so that a perfect rendering gives the measured force. One tick a sample; the
/// scene's stiffness is `stiffness_n_per_mm`. Throws Refusal if a balance is not solved.
ForceErrors compare_with_measured(std::span<const MeasuredSample> samples, const FeltScene& felt,
                                  double stiffness_n_per_mm);

}  // namespace palpate::plugin
