#pragma once

/// A scan on a grid that is oblique, tilted, uneven and not square, and a scene with two boundaries by their values and
/// one by a structure: commands are tested on them.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "plugin/testing/command_rig.h"

namespace palpate::plugin::testing {

inline const glm::dvec3 odd_center(7, -12, 21);

inline testdata::Grid odd_grid() {
  testdata::Grid grid;
  grid.size = {40, 36, 28};
  grid.spacing = {0.9, 1.1, 1.5};
  grid.center = odd_center;
  grid.tilt_degrees = 8;
  grid.uneven_mm = 0.2;
  return testdata::rotated(grid, glm::normalize(glm::dvec3(1, -2, 3)), 20);
}

inline std::filesystem::path write_odd(const io::Volume& volume, const char* name) {
  const std::filesystem::path folder = fresh_path(name);
  testdata::write_series(volume, folder);
  return folder;
}

/// A ball of soft tissue about the middle of the odd grid, with a core of bone.
inline const std::filesystem::path& ball_scan() {
  static const std::filesystem::path folder = [] {
    const testdata::Phantom ball{.background = testdata::air_hu,
                                 .bodies = {{testdata::Ball{odd_center, 13}, testdata::soft_tissue_hu},
                                            {testdata::Ball{odd_center, 7}, testdata::bone_hu}}};
    return write_odd(testdata::scan(ball, testdata::make_geometry(odd_grid())), "odd_ball");
  }();
  return folder;
}

inline std::string typed(const glm::dvec3& v) {
  return fmt::format("{:.17g},{:.17g},{:.17g}", v.x, v.y, v.z);
}

inline nlohmann::json array_of(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

inline nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

/// Two boundaries by their values, one of them without a name, and one by a structure, in a reach of half a scale.
inline std::filesystem::path odd_scene() {
  const std::filesystem::path folder = fresh_path("odd_scene");
  std::filesystem::create_directories(folder);
  std::string labels;
  for (int n = 0; n < 24 * 24 * 24; ++n) {
    const glm::dvec3 at(n % 24 - 11.5, n / 24 % 24 - 11.5, n / 576 - 11.5);
    labels += glm::length(at) < 10 ? '\1' : '\0';
  }
  std::ofstream(folder / "labels.mha") << "NDims = 3\nDimSize = 24 24 24\nElementType = MET_UCHAR\nOffset = "
                                       << odd_center.x - 11.5 << ' ' << odd_center.y - 11.5 << ' '
                                       << odd_center.z - 11.5 << "\nElementDataFile = LOCAL\n"
                                       << labels;
  std::ofstream(folder / "scene.json") << R"({"version": 1, "name": "odd", "stiffness_n_per_m": 450,
    "workspace": {"scale": 0.5},
    "structures": [{"name": "unread", "file": "labels.mha", "segment": 1},
                   {"name": "pit", "file": "labels.mha", "segment": 1}],
    "modes": [{"type": "friction", "strength_n": 0.02},
      {"type": "surface", "name": "skin", "strength_n": {"of": "gradient_per_mm", "nodes": [[60, 0], [400, 0.7]]},
       "gates": [{"of": "value", "nodes": [[-600, 0], [-500, 1], [40, 1], [90, 0]]}]},
      {"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[60, 0], [240, 1.1]]},
       "gates": [{"of": "value", "nodes": [[250, 0], [300, 1]]}]},
      {"type": "surface", "name": "edge", "structure": "pit", "strength_n": 0.3}]})";
  return folder / "scene.json";
}

/// A path from outside through the ball's skin and core to its middle, mm.
inline const glm::dvec3 odd_inward = glm::normalize(glm::dvec3(0.5, 0.7, 0.4));
inline const glm::dvec3 odd_from = odd_center - 26.0 * odd_inward, odd_to = odd_center + 1.0 * odd_inward;

}  // namespace palpate::plugin::testing
