#pragma once

/// A scripted path of the simulated hand: the hand's target in patient space (LPS, mm), over time (s).

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace palpate::plugin {

struct PathPoint {
  double time_s = 0;
  glm::dvec3 position_mm{0};
  std::uint32_t buttons = 0;  ///< held from here to the next point, as a bit mask: 2 is the second, which marks
};

/// Reads a table with the header `time_s,x_mm,y_mm,z_mm` and one point a line; times ascend, from 0 or more. The header
/// may end with `,buttons`, which adds that column. Throws std::runtime_error that names the file, the line and what is
/// wrong.
std::vector<PathPoint> read_path_csv(const std::filesystem::path& file);

}  // namespace palpate::plugin
