#include "modes/scene/head_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

namespace palpate::modes::internal {
namespace {

using io::Vec3;

/// A value at each place of the patient, mm from the middle, on 3 mm; rows and columns turned about the z axis.
io::Volume scanned(const std::function<double(const Vec3&)>& value, const std::string& part = {}, double turned = 0) {
  constexpr int size = 90;
  constexpr double spacing_mm = 3;
  io::Volume volume;
  io::Geometry& g = volume.geometry;
  g.dimensions = glm::ivec3(size);
  g.spacing_i = g.spacing_j = spacing_mm;
  g.direction_i = {std::cos(turned), std::sin(turned), 0};
  g.direction_j = {-std::sin(turned), std::cos(turned), 0};
  g.step = {0, 0, spacing_mm};
  for (int k = 0; k < size; ++k) {
    const Vec3 middle(0.5 * (size - 1) * spacing_mm);
    g.slice_positions.push_back(static_cast<double>(k) * g.step - middle.x * g.direction_i - middle.y * g.direction_j -
                                Vec3(0, 0, middle.z));
  }
  std::vector<std::int16_t> voxels;
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i) voxels.push_back(static_cast<std::int16_t>(value(g.to_patient(Vec3(i, j, k)))));
    }
  }
  volume.voxels = std::move(voxels);
  volume.modality = "MR";
  volume.body_part = part;
  return volume;
}

/// Bright, within it a dark layer, within that bright again: how thick the two are, mm.
std::function<double(const Vec3&)> shells(const Vec3& radii, double bright_mm, double dark_mm) {
  return [=](const Vec3& at) {
    const double deep = (1 - glm::length(at / radii)) * radii.x;  // mm, at the sides
    return deep < 0 || (deep > bright_mm && deep < bright_mm + dark_mm) ? 0 : 100;
  };
}

constexpr double bright_from = 50;
const Vec3 head_mm(75, 95, 110), chest_mm(130, 125, 130), knee_mm(45, 45, 120);

TEST(HeadShape, is_a_dark_shell_beneath_a_thin_bright_one_in_every_orientation) {
  for (const double turned : {0.0, 0.4, 1.5}) {
    EXPECT_TRUE(is_built_like_a_head(scanned(shells(head_mm, 6, 8), {}, turned), bright_from)) << turned;
  }
  EXPECT_NEAR(shell_of(scanned(shells(head_mm, 6, 8)), bright_from).share, 1, 0.15);
}

TEST(HeadShape, is_no_bottle_whatever_its_header_says) {
  for (const char* const part : {"", "BRAIN", "HEAD"}) {
    EXPECT_FALSE(is_built_like_a_head(scanned(shells(head_mm, 200, 0), part), bright_from)) << part;
  }
  EXPECT_EQ(shell_of(scanned(shells(head_mm, 200, 0)), bright_from).share, 0);
}

TEST(HeadShape, is_no_other_part_of_the_body) {
  EXPECT_FALSE(is_built_like_a_head(scanned(shells(head_mm, 6, 8), "KNEE LSPINE"), bright_from)) << "it says so";
  EXPECT_FALSE(is_built_like_a_head(scanned(shells(chest_mm, 20, 60)), bright_from)) << "lungs are wider than a skull";
  EXPECT_FALSE(is_built_like_a_head(scanned(shells(chest_mm, 6, 8)), bright_from)) << "too wide";
  EXPECT_FALSE(is_built_like_a_head(scanned(shells(knee_mm, 6, 8)), bright_from)) << "too small";
}

/// Rays go from side to side and from front to back, and count alike: so a patient who lies on the side has the same
/// shell. And the values may be on any scale.
TEST(HeadShape, is_the_same_for_a_patient_on_the_side_and_in_any_unit) {
  const auto upright = shells({65, 105, 100}, 6, 8);
  const Shell shell = shell_of(scanned(upright), bright_from);
  const auto on_the_side = [&](const Vec3& at) { return upright({at.y, -at.x, at.z}); };
  const Shell same = shell_of(scanned(on_the_side), bright_from);
  EXPECT_NEAR(same.share, shell.share, 0.02);
  EXPECT_NEAR(same.width_mm, shell.width_mm, 1);
  const Shell brighter = shell_of(scanned([&](const Vec3& at) { return 200 * upright(at); }), 200 * bright_from);
  EXPECT_EQ(brighter.share, shell.share);
  EXPECT_EQ(brighter.width_mm, shell.width_mm);
}

/// A brain without fat, or cut at the skull in part, is still what its header says.
TEST(HeadShape, may_show_less_of_its_shell_where_the_header_says_that_it_is_one) {
  const auto half = [](const Vec3& at) { return shells(head_mm, at.y < 0 ? 6 : 200, at.y < 0 ? 8 : 0)(at); };
  EXPECT_TRUE(is_built_like_a_head(scanned(half, "BRAIN"), bright_from));
  EXPECT_GT(shell_of(scanned(half), bright_from).share, 0.2);
}

TEST(HeadShape, of_nothing_is_none) {
  EXPECT_EQ(shell_of(scanned([](const Vec3&) { return 0; }), bright_from).share, 0);
  EXPECT_FALSE(is_built_like_a_head(scanned([](const Vec3&) { return 100; }), bright_from));
}

/// Rays of a step of 1 mm through it would never end.
TEST(HeadShape, is_no_scan_of_many_meters) {
  for (const double spacing_mm : {30.0, 1e3, 1e9}) {
    io::Volume vast = scanned(shells(head_mm, 6, 8));
    vast.geometry.spacing_i = vast.geometry.spacing_j = spacing_mm;
    EXPECT_EQ(shell_of(vast, bright_from).share, 0) << spacing_mm;
  }
}

}  // namespace
}  // namespace palpate::modes::internal
