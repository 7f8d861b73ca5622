#include "palpate/modes/reach.h"

#include <gtest/gtest.h>

namespace palpate::modes {
namespace {

io::Geometry stack(int slices) {
  io::Geometry geometry;
  geometry.dimensions = {101, 101, slices};
  geometry.step = {0, 0, 2};
  for (int k = 0; k < slices; ++k) {
    geometry.slice_positions.emplace_back(-50, -50, 2.0 * k);
  }
  return geometry;
}

using Runs = std::vector<std::pair<int, int>>;

TEST(Reach, slices_that_no_pose_of_the_device_meets_are_listed) {
  Workspace workspace;
  workspace.center_mm = {0, 0, 100};
  // The device's y axis points to the head: 40 mm reach slices 30 to 70 of every 2 mm.
  EXPECT_EQ(slices_out_of_reach(stack(101), workspace, {0.08, 0.04, 0.06}), (Runs{{0, 29}, {71, 100}}));
  EXPECT_EQ(slices_out_of_reach(stack(101), workspace, {0.08, 0.1, 0.06}), Runs{});
  workspace.mm_per_m = 2000;
  EXPECT_EQ(slices_out_of_reach(stack(101), workspace, {0.08, 0.04, 0.06}), (Runs{{0, 9}, {91, 100}}));
  workspace.center_mm = {500, 0, 100};
  EXPECT_EQ(slices_out_of_reach(stack(5), workspace, {0.08, 0.04, 0.06}), (Runs{{0, 4}}));
}

}  // namespace
}  // namespace palpate::modes
