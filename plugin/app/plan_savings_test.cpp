#include "plugin/app/plan_savings.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>

#include "modes/testing/test_rig.h"
#include "plugin/session/prepared_scene.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

/// What the slices that are left out would take is a brick's time for each of their bricks. The brick was computed
/// three times, and no longer than the whole measurement took.
TEST(PlanSavings, ABrickTakesNoLongerThanItsMeasurement) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(20), testdata::make_geometry({.size = {48, 48, 64}})));
  const modes::Scene scene = modes::testing::scene_of({modes::testing::surface(modes::TransferFunction(1.0))});
  modes::Plan plan = *plan_for(scene, *volume, glm::dvec3(0.1));
  constexpr double bricks = 3 * 3 * 2;  // of 16 voxels along each side
  plan.slices = {0, 31};
  plan.left_out = {{.what = "slices", .why = "", .saves = "", .slices = io::SliceRange{32, 63}}};
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Saving> savings = measure_savings(scene, plan, volume);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  ASSERT_EQ(savings.size(), 1U);
  ASSERT_TRUE(savings[0].ms);
  EXPECT_GT(*savings[0].ms, 0);
  EXPECT_LT(3 * *savings[0].ms / bricks, took.count());
}

}  // namespace
}  // namespace palpate::plugin
