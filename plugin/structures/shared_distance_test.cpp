/// All callers with the same arguments share one distance field while any of them holds it; different arguments give
/// another.

#include "plugin/structures/shared_distance.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

TEST(SharedDistance, IsOneFieldForAllThatIsTheSame) {
  const io::internal::TestFolder folder;
  testing::write_contours(folder / "rt.dcm", "1.1", "7", "Doe^Jane");
  std::filesystem::copy_file(folder / "rt.dcm", folder / "copy.dcm");
  const io::Structure structure = io::find_structures(std::array{folder / "rt.dcm"}).structures.at(0);
  io::Geometry scan = testing::registered_scan()->geometry;
  scan.dimensions = {10, 8, 5};
  scan.slice_positions = {{0, 0, 0}, {0, 0, 2}, {0, 0, 4}, {0, 0, 6}, {0, 0, 8}};
  auto first = shared_distance(structure, scan, 5);
  EXPECT_EQ(first->reach_mm(), 5);
  EXPECT_EQ(shared_distance(structure, scan, 5), first);
  EXPECT_EQ(shared_distance(structure, scan), first) << "for drawing any reach will do";
  const auto other_reach = shared_distance(structure, scan, 8);
  EXPECT_NE(other_reach, first);
  EXPECT_EQ(other_reach->reach_mm(), 8);
  EXPECT_EQ(shared_distance(structure, scan, 5), first) << "both are kept";
  EXPECT_EQ(shared_distance(structure, scan, 8), other_reach);

  std::vector<std::pair<io::Structure, io::Geometry>> others(8, {structure, scan});
  others[0].first.motion.shift.y = 0.5;
  others[1].first.file = folder / "copy.dcm";
  others[2].second.dimensions.y = 9;
  others[3].second.direction_i = {0, 0, 1};
  others[4].second.direction_j = {0, 0, 1};
  others[5].second.spacing_i = 2.5;
  others[6].second.spacing_j = 2.5;
  others[7].second.slice_positions[2].z += 0.01;
  std::vector<std::shared_ptr<const io::DistanceField>> made{first, other_reach};
  for (const auto& [of, on] : others) {
    made.push_back(shared_distance(of, on, 5));
    EXPECT_EQ(shared_distance(of, on, 5), made.back());
    EXPECT_EQ(shared_distance(of, on), made.back());
  }
  for (std::size_t n = 0; n < made.size(); ++n) {
    for (std::size_t other = 0; other < n; ++other) EXPECT_NE(made[n], made[other]) << n << " " << other;
  }

  // A file that was written meanwhile is another one.
  std::filesystem::last_write_time(structure.file,
                                   std::filesystem::last_write_time(structure.file) + std::chrono::hours(1));
  EXPECT_NE(shared_distance(structure, scan, 5), first);
}

TEST(SharedDistance, GoesWithItsLastHolder) {
  const io::internal::TestFolder folder;
  testing::write_contours(folder / "rt.dcm", "1.1", "7", "Doe^Jane");
  const io::Structure structure = io::find_structures(std::array{folder / "rt.dcm"}).structures.at(0);
  const io::Geometry scan = testing::registered_scan()->geometry;
  auto held = shared_distance(structure, scan, 12);
  const std::weak_ptr<const io::DistanceField> field = held;
  held.reset();
  EXPECT_TRUE(field.expired());
  EXPECT_EQ(shared_distance(structure, scan)->reach_mm(), 3) << "by itself as near as it goes";
}

}  // namespace
}  // namespace palpate::plugin
