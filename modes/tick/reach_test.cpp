#include "modes/tick/reach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <set>
#include <vector>

#include "modes/testing/test_rig.h"

namespace palpate::modes {
namespace {

using io::SliceRange;

io::Geometry stack(int slices) {
  io::Geometry geometry;
  geometry.dimensions = {101, 101, slices};
  geometry.step = {0, 0, 2};
  for (int k = 0; k < slices; ++k) {
    geometry.slice_positions.emplace_back(-50, -50, 2.0 * k);
  }
  return geometry;
}

bool none(const SliceRange& slices) {
  return slices.last < slices.first;
}

TEST(Reach, is_the_slices_that_places_in_the_box_lie_between) {
  Workspace workspace;
  workspace.center_mm = {0, 0, 101};
  // The device's y axis points to the head: 40 mm reach from 61 to 141 mm, of slices every 2 mm.
  EXPECT_EQ(slices_within_reach(stack(101), workspace, {0.08, 0.04, 0.06}), (SliceRange{30, 71}));
  EXPECT_EQ(slices_within_reach(stack(101), workspace, {0.08, 0.11, 0.06}), (SliceRange{0, 100}));
  EXPECT_EQ(slices_within_reach(stack(101), workspace, {0.08, 1e-4, 0.06}), (SliceRange{50, 51})) << "between two";
  workspace.mm_per_m = 2000;
  EXPECT_EQ(slices_within_reach(stack(101), workspace, {0.08, 0.04, 0.06}), (SliceRange{10, 91}));
  workspace.center_mm = {500, 0, 100};
  EXPECT_TRUE(none(slices_within_reach(stack(5), workspace, {0.08, 0.04, 0.06}))) << "beside the scan";
  for (const Vec3& beside : {Vec3(500, 0, 4), Vec3(-500, 0, 4), Vec3(0, 500, 4), Vec3(0, -500, 4)}) {
    workspace.center_mm = beside;
    EXPECT_TRUE(none(slices_within_reach(stack(5), workspace, {0.08, 0.04, 0.06}))) << beside.x << ' ' << beside.y;
  }
  workspace.center_mm = {0, 0, 0};
  EXPECT_EQ(slices_within_reach(stack(1), workspace, {0.08, 0.04, 0.06}), (SliceRange{0, 0}));
}

/// Whatever way the scan lies and the device is turned.
TEST(Reach, holds_the_slices_around_every_place) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> part(-1, 1);
  int some = 0;
  for (int n = 0; n < 200; ++n) {
    io::Geometry geometry = stack(60);
    const auto turn = [&] {
      const double x = part(random), y = part(random), z = part(random), angle = 3 * part(random);
      return glm::dmat3(glm::rotate(glm::dmat4(1), angle, Vec3(x, y, z)));
    };
    const glm::dmat3 turned = turn();
    const double shear = 0.5 * part(random);  // gantry tilt
    for (Vec3& position : geometry.slice_positions) {
      position = turned * (position + Vec3(0, shear * position.z, 0) - Vec3(0, 0, 59));
    }
    geometry.direction_i = turned[0];
    geometry.direction_j = turned[1];
    geometry.step = turned * Vec3(0, 2 * shear, 2);
    Workspace workspace;
    workspace.rotation = turn();
    for (int axis = 0; axis < 3; ++axis) workspace.center_mm[axis] = 60 * part(random);
    const Vec3 half_extent_m(0.02, 0.015, 0.01);
    const SliceRange kept = slices_within_reach(geometry, workspace, half_extent_m);
    SliceRange needed{60, -1};
    for (int place = 0; place < 20000; ++place) {
      const double x = part(random), y = part(random), z = part(random);
      const Vec3 index = geometry.to_index(workspace.to_patient(Vec3(x, y, z) * half_extent_m));
      if (geometry.contains(index)) {
        needed.first = std::min(needed.first, static_cast<int>(std::floor(index.z)));
        needed.last = std::max(needed.last, static_cast<int>(std::ceil(index.z)));
      }
    }
    if (none(needed)) continue;
    ++some;
    EXPECT_LE(kept.first, needed.first) << n;
    EXPECT_GE(kept.last, needed.last) << n;
  }
  EXPECT_GT(some, 100);
}

/// A box beside the scan that just reaches over one of its four sides: its voxels there are felt as all others are.
TEST(Reach, holds_the_slices_at_the_scans_sides) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> part(0.02, 0.9);
  const io::Geometry geometry = stack(60);
  const Vec3 half_extent_m(0.02, 0.02, 0.02);
  for (int n = 0; n < 200; ++n) {
    const int axis = n % 2;
    const bool is_low = n % 4 < 2;
    const double reached = part(random);  // voxels
    Vec3 index(50, 50, 59 * part(random));
    index[axis] = is_low ? reached : 100 - reached;
    Workspace workspace;
    workspace.center_mm = geometry.to_patient(index);
    workspace.center_mm[axis] += is_low ? -20 : 20;
    const SliceRange kept = slices_within_reach(geometry, workspace, half_extent_m);
    ASSERT_FALSE(none(kept)) << "axis " << axis << ", " << reached;
    EXPECT_LE(kept.first, std::floor(std::max(index.z - 10, 0.0)));
    EXPECT_GE(kept.last, std::ceil(std::min(index.z + 10, 59.0)));
    workspace.center_mm[axis] += is_low ? -2 * reached : 2 * reached;
    EXPECT_TRUE(none(slices_within_reach(geometry, workspace, half_extent_m))) << "beside it, axis " << axis;
  }
}

TEST(Reach, leaves_slices_out_of_a_plan_and_says_so) {
  const auto plan_of = [](double strength_n) {
    Plan plan = make_plan(testing::scene_of({testing::surface(TransferFunction(strength_n), Datum::value)}),
                          io::FieldSet::value | io::FieldSet::gradient, {});
    plan.workspace.center_mm = {0, 0, 101};
    leave_out_slices(stack(101), {0.08, 0.02, 0.06}, plan);
    return plan;
  };
  // 20 mm, and 10 mm more for a proxy that 2 N hold up to 5 mm away from the probe.
  const Plan plan = plan_of(2);
  EXPECT_EQ(plan.slices, (SliceRange{35, 66}));
  ASSERT_GE(plan.left_out.size(), 2U);
  const LeftOut& below = plan.left_out[plan.left_out.size() - 2];
  EXPECT_EQ(below.what, "slices 0-34");
  EXPECT_EQ(below.why, "outside the workspace");
  EXPECT_EQ(below.slices, (SliceRange{0, 34}));
  EXPECT_EQ(plan.left_out.back().what, "slices 67-100");
  EXPECT_EQ(plan_of(3.9).slices, plan.slices) << "a strength that is edited takes nothing away";
  EXPECT_EQ(plan_of(4.1).slices, (SliceRange{30, 71}));
}

/// Wherever the workspace lies: no range is empty, and a slice is kept, or left out by one range.
TEST(Reach, keeps_each_slice_or_names_it_once_as_left_out) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> center(-150, 350);
  constexpr int count = 101;
  std::set<std::size_t> ranges;
  for (int n = 0; n < 200; ++n) {
    Plan plan = make_plan(testing::scene_of({testing::surface(TransferFunction(2.0), Datum::value)}),
                          io::FieldSet::value | io::FieldSet::gradient, {});
    const std::size_t before = plan.left_out.size();
    plan.workspace.center_mm = {0, 0, center(random)};
    leave_out_slices(stack(count), {0.08, 0.02, 0.06}, plan);
    std::vector<int> named(count, 0);
    const auto name = [&named](const SliceRange& range) {
      for (int slice = range.first; slice <= range.last; ++slice) ++named.at(static_cast<std::size_t>(slice));
    };
    if (!none(plan.slices)) name(plan.slices);
    for (std::size_t m = before; m < plan.left_out.size(); ++m) {
      ASSERT_TRUE(plan.left_out[m].slices);
      EXPECT_LE(plan.left_out[m].slices->first, plan.left_out[m].slices->last) << plan.left_out[m].what;
      name(*plan.left_out[m].slices);
    }
    ranges.insert(plan.left_out.size() - before);
    EXPECT_EQ(std::count(named.begin(), named.end(), 1), count) << plan.workspace.center_mm.z;
  }
  EXPECT_TRUE(ranges.contains(1) && ranges.contains(2)) << "each shape is among them";
}

/// The proxy is nowhere farther from the probe than strength / stiffness. Slices that it can reach are kept, and none
/// that are more than a centimeter farther away.
TEST(Reach, is_as_far_beyond_the_box_as_the_coupling_lets_the_proxy_be) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> strength(0.1, 3), logarithm(std::log(100), std::log(2000));
  for (int n = 0; n < 200; ++n) {
    const double most_n = strength(random), k = std::exp(logarithm(random));
    Scene scene = testing::scene_of({testing::surface(TransferFunction(most_n), Datum::value)});
    scene.stiffness_n_per_m = k;
    Workspace workspace;
    workspace.center_mm = {0, 0, 201};
    Plan plan = make_plan(scene, io::FieldSet::value | io::FieldSet::gradient, workspace);
    leave_out_slices(stack(201), {0.08, 0.02, 0.06}, plan);
    const double reach_mm = 20 + 1000 * most_n / k;  // up and down from the center, of slices every 2 mm
    const auto slice_at = [](double z) { return std::clamp(static_cast<int>(std::floor(z / 2)), 0, 200); };
    EXPECT_LE(plan.slices.first, slice_at(201 - reach_mm)) << most_n << " N, " << k << " N/m";
    EXPECT_GE(plan.slices.first, slice_at(201 - reach_mm - 10)) << most_n << " N, " << k << " N/m";
    EXPECT_GE(plan.slices.last, slice_at(201 + reach_mm)) << most_n << " N, " << k << " N/m";
    EXPECT_LE(plan.slices.last, slice_at(201 + reach_mm + 10) + 1) << most_n << " N, " << k << " N/m";
  }
}

}  // namespace
}  // namespace palpate::modes
