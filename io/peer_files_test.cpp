// Scans written by other programs: nibabel (every type of number of NIfTI-1 and NIfTI-2, in both byte orders, frames,
// both forms, colors) and pydicom (32-bit doses, unsigned slices among signed ones, a stack acquired in passes). Each
// voxel is at that program's position, with its value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

void expect_as_written_by(const std::string& module) {
  const std::string python = "/usr/bin/python3 ";
  if (std::system((python + "-c 'import numpy, " + module + "' 2>/dev/null").c_str()) != 0) {  // NOLINT
    GTEST_SKIP() << module << " is not installed: apt-get install python3-" << module;
  }
  const TestFolder folder;
  const std::filesystem::path told = folder / "told.json";
  const std::string command = python + PALPATE_SOURCES + "/io/peers/write_scans.py " + module + " '" +
                              folder.path().string() + "' > '" + told.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT: of a test
  const nlohmann::json scans = nlohmann::json::parse(std::ifstream(told));
  ASSERT_GE(scans.size(), 20U);
  for (const auto& scan : scans) {
    const std::filesystem::path path = scan.at("path").get<std::string>();
    SCOPED_TRACE(path.filename().string() + ", frame " + scan.at("frame").dump());
    const Catalogue found = find_series(std::array{path});
    ASSERT_THAT(found.series, ::testing::SizeIs(1)) << (found.skipped.empty() ? Text() : found.skipped[0].reason);
    EXPECT_TRUE(found.series[0].usable);
    const Volume volume = load(found.series[0], {.frame = scan.at("frame").get<int>()});
    ASSERT_EQ(scan.at("voxels").size(), 8U);
    for (const auto& voxel : scan.at("voxels")) {
      const Vec3 index =
          volume.geometry.to_index({voxel[0].get<double>(), voxel[1].get<double>(), voxel[2].get<double>()});
      const Vec3 nearest = glm::round(index);
      ASSERT_LT(glm::distance(index, nearest), 1e-3) << voxel;
      const double value = voxel[3];
      const glm::ivec3 at(nearest);
      EXPECT_NEAR(volume.value_at(at.x, at.y, at.z), value, 1e-5 * std::max(1.0, std::abs(value))) << voxel;
    }
  }
}

TEST(PeerFiles, OfNibabelAreReadAsItReadsThem) {
  expect_as_written_by("nibabel");
}

TEST(PeerFiles, OfPydicomAreReadAsItWroteThem) {
  expect_as_written_by("pydicom");
}

}  // namespace
}  // namespace palpate::io::internal
