#pragma once

/// A scripted path of the hand: where the simulated hand wants to be, in patient space (LPS, mm) over time (s).

#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace palpate::plugin {

struct PathPoint {
  double time_s = 0;
  glm::dvec3 position_mm{0};
};

/// Reads `time_s,x_mm,y_mm,z_mm`, a header line and one point a line, times ascending from 0 or more. Throws
/// std::runtime_error naming the file, the line and what is wrong.
std::vector<PathPoint> read_path_csv(const std::filesystem::path& file);

}  // namespace palpate::plugin
