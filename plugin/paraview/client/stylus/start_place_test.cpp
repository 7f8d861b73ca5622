#include "plugin/paraview/client/stylus/start_place.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {
namespace {

constexpr double radius = 25, cavity = 12;

/// A ball of soft tissue around the origin, with air inside and around it: 64 mm across.
std::shared_ptr<const io::Volume> hollow_ball() {
  constexpr int size = 64;
  auto volume = std::make_shared<io::Volume>();
  volume->geometry.dimensions = {size, size, size};
  volume->geometry.slice_positions.clear();
  for (int k = 0; k < size; ++k) volume->geometry.slice_positions.push_back({-31.5, -31.5, k - 31.5});
  volume->geometry.step = {0, 0, 1};
  volume->unit = "HU";
  volume->modality = "CT";
  std::vector<std::int16_t> values;
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i) {
        const double from_middle = glm::length(glm::dvec3(i, j, k) - 31.5);
        values.push_back(from_middle < radius && from_middle > cavity ? 40 : -1000);
      }
    }
  }
  volume->voxels = std::move(values);
  return volume;
}

bool everywhere(const glm::dvec3&) {
  return true;
}

StartPlace start_with(const std::function<bool(const glm::dvec3&)>& in_reach,
                      const std::function<bool(const glm::dvec3&)>& in_sight) {
  const auto volume = hollow_ball();
  const auto plan = plan_for(modes::load_scene("ct-skin-and-bone"), *volume, glm::dvec3(0.08));
  return find_start_place(volume, *plan, 1, in_reach, in_sight);
}

TEST(StartPlace, LiesInFrontInTheAirAroundThePatient) {
  const StartPlace start = start_with(everywhere, everywhere);
  EXPECT_TRUE(start.outside);
  EXPECT_TRUE(start.seen);
  EXPECT_GT(glm::length(start.place_mm), radius + 1);
  EXPECT_LT(start.place_mm.y, -radius);
}

TEST(StartPlace, IsWhereItIsSeen) {
  const StartPlace start = start_with(everywhere, [](const glm::dvec3& place) { return place.x > 10; });
  EXPECT_TRUE(start.outside);
  EXPECT_TRUE(start.seen);
  EXPECT_GT(start.place_mm.x, 10);
  EXPECT_GT(glm::length(start.place_mm), radius + 1);
}

TEST(StartPlace, IsInReach) {
  const StartPlace start = start_with([](const glm::dvec3& place) { return place.y > 0; }, everywhere);
  EXPECT_TRUE(start.outside);
  EXPECT_GT(start.place_mm.y, 0);
}

TEST(StartPlace, TheAirInsideThePatientIsNotOutside) {
  const StartPlace start =
      start_with([](const glm::dvec3& place) { return glm::length(place) < cavity - 2; }, everywhere);
  EXPECT_FALSE(start.outside);
  EXPECT_LT(glm::length(start.place_mm), cavity) << "but it is in reach";
}

}  // namespace
}  // namespace palpate::plugin
