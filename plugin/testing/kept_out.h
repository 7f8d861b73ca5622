#pragma once

/// Checks for recordings of a stylus that is kept out of a structure.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "plugin/recording/recording.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin::testing {

struct KeptOut {
  double deepest_mm = -1e9;  ///< how far inside the structure the proxy was; below 0: outside
  double most_n = 0;
};

/// Expects that the recording names the structure and no path, and that nothing was felt outside of a margin of 3 mm.
inline KeptOut kept_out_of(const std::string& structure, const Recording& recording) {
  EXPECT_EQ(recording.scenes.at(0).structures, std::vector<std::string>{structure});
  EXPECT_EQ(recording.scenes.at(0).scene.find('/'), std::string::npos) << "no path goes into a recording";
  KeptOut found;
  for (const TickRecord& tick : recording.ticks) {
    const double force = glm::length(vector_of(tick.force_n));
    found.deepest_mm = std::max(found.deepest_mm, tick.distance_mm[0]);
    found.most_n = std::max(found.most_n, force);
    if (tick.distance_mm[0] < -3.2) {  // a step of the proxy beyond the margin
      EXPECT_LT(force, 1e-6) << tick.index;
    }
  }
  return found;
}

/// Moves the structure's file, and expects that the recording is refused without it and repeated to the last bit with
/// it. `options` are of the second replay.
inline void expect_repeated_with_moved(const std::filesystem::path& file, const std::string& structure,
                                       const std::filesystem::path& recording, const std::string& scan,
                                       const std::string& options = {}) {
  const std::filesystem::path moved = fresh_path("moved");
  std::filesystem::create_directories(moved);
  std::filesystem::rename(file, moved / ("renamed" + file.filename().string()));
  const std::string replay = "replay " + recording.string() + " " + scan;
  const Outcome without = palpate(replay);
  EXPECT_EQ(without.exit, 1);
  EXPECT_THAT(without.output,
              ::testing::HasSubstr("structure \"" + structure +
                                   "\": the file that it was felt from is not here: name it with --structures"));
  const Outcome same = palpate(replay + " --structures " + moved.string() + options);
  EXPECT_EQ(same.exit, 0) << same.output;
  EXPECT_THAT(same.output, ::testing::HasSubstr("the same to the last bit"));
}

}  // namespace palpate::plugin::testing
