#include "plugin/paraview/common/body_mask.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::plugin {
namespace {

constexpr glm::ivec3 voxels(100, 120, 40);
constexpr glm::dvec3 spacing(1.5, 1.5, 3);

/// A head of 50 mm with a cavity of 15 mm, an ear of 3 mm, on foam in a shell of 3 mm, which touches it along the
/// middle 4 mm; a table below.
double head_on_a_table(int i, int j, int k) {
  const double x = 1.5 * (i - 50), y = 1.5 * (j - 50), z = 3.0 * (k - 20);
  const double from_middle = std::hypot(x, y);
  constexpr double air = -1000, foam = -850, shell = -150, tissue = 40, lungs = -800;
  if (std::hypot(x, y, z) < 15) return lungs;
  if (from_middle < 50) return tissue;
  if (y > 0 && from_middle > 62 && from_middle < 65.5) return shell;
  if (std::abs(x) < 2 && y > 0 && from_middle < 66) return tissue;
  if (y > 0 && from_middle < 62) return foam;
  if (std::abs(y) < 1.6 && x > 0 && x < 58) return tissue;
  if (y > 80 && y < 95) return shell;
  return air;
}

bool holds(const BodyMask& mask, double x, double y, double z) {
  return mask.holds(static_cast<int>(std::lround(50 + x / 1.5)), static_cast<int>(std::lround(50 + y / 1.5)),
                    static_cast<int>(std::lround(20 + z / 3)));
}

TEST(BodyMask, IsTheBodyWithItsCavitiesAndItsEar) {
  const BodyMask mask = body_mask(head_on_a_table, voxels, spacing, Rim::one_voxel);
  for (const double z : {-50.0, 0.0, 50.0}) {
    EXPECT_TRUE(holds(mask, 0, 0, z));
    EXPECT_TRUE(holds(mask, -49, 0, z)) << "its skin";
    EXPECT_TRUE(holds(mask, 56, 0, z)) << "its ear";
    EXPECT_FALSE(holds(mask, -60, -20, z)) << "air";
  }
}

TEST(BodyMask, LeavesWhatItLiesOn) {
  const BodyMask mask = body_mask(head_on_a_table, voxels, spacing, Rim::one_voxel);
  EXPECT_TRUE(mask.left_something);
  for (const double z : {-50.0, 0.0, 50.0}) {
    EXPECT_FALSE(holds(mask, 0, 88, z)) << "the table";
    EXPECT_FALSE(holds(mask, 45, 45, z)) << "the shell";
    EXPECT_FALSE(holds(mask, -45, 45, z)) << "the shell";
    EXPECT_FALSE(holds(mask, 40, 40, z)) << "the foam";
  }
  const auto no_table = [](int i, int j, int k) { return j > 84 || j > 50 ? -1000.0 : head_on_a_table(i, j, k); };
  EXPECT_FALSE(body_mask(no_table, voxels, spacing, Rim::one_voxel).left_something);
}

TEST(BodyMask, CountsWhatIsLightWithinTheBodyAlone) {
  const BodyMask mask = body_mask(head_on_a_table, voxels, spacing, Rim::none);
  const double cavity = 4.0 / 3 * std::pow(15, 3), body = 50 * 50 * 120;  // over pi
  EXPECT_NEAR(light_part(mask, head_on_a_table), cavity / body, 0.004);
}

}  // namespace
}  // namespace palpate::plugin
