// The distances that a session's record tells, on balls whose distances are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/scene_json.h"
#include "plugin/session/session.h"

namespace palpate::plugin {
namespace {

const glm::dvec3 liver_mm(3, -2, 1), aorta_mm(-12, 5, 4);
constexpr double liver_radius_mm = 12, aorta_radius_mm = 7;

double distance_mm(const glm::dvec3& middle, double radius_mm, const glm::dvec3& at) {
  return radius_mm - glm::distance(at, middle);
}

/// Two balls, in the order in which the plan reads them.
class TwoBalls final : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override { return io::FieldSet::value | io::FieldSet::distance; }
  io::Sample sample(const io::Vec3& at, io::FieldSet) const noexcept override {
    io::Sample sample;
    sample.inside = true;
    sample.distance[0] = {.mm = distance_mm(liver_mm, liver_radius_mm, at), .gradient = glm::normalize(liver_mm - at)};
    sample.distance[1] = {.mm = distance_mm(aorta_mm, aorta_radius_mm, at), .gradient = glm::normalize(aorta_mm - at)};
    return sample;
  }
};

TEST(SessionStructures, EveryTickTellsTheDistancesOfItsProxy) {
  // The one that no mode reads has no number, and those after it move up.
  const modes::Scene scene = modes::scene_from_json(R"({"version": 1, "structures": [
    {"name": "liver", "file": "a", "segment": 1}, {"name": "unread", "file": "a", "segment": 2},
    {"name": "aorta", "file": "a", "segment": 3, "margin_mm": 3}],
    "modes": [{"type": "surface", "structure": "liver", "strength_n": 3}]})",
                                                    "test");
  const auto source = std::make_shared<TwoBalls>();
  const auto plan =
      std::make_shared<const modes::Plan>(modes::make_plan(scene, source->available(), modes::Workspace{}));
  ASSERT_EQ(plan->structures, (std::vector<std::size_t>{0, 2}));
  device::SimulatedStylus stylus;
  const std::vector<device::Waypoint> way{{.time = 0, .position = {0, 0.03, 0}},
                                          {.time = 3, .position = {0, -0.002, 0}}};
  stylus.follow(way);
  Session session(plan, source, stylus, limits_for(modes::Limits{}, stylus.specification()));
  double deepest_mm = -1e9, apart_mm = 0;
  for (int n = 0; n < 3000; ++n) {
    const TickRecord tick = session.tick();
    const glm::dvec3 proxy = plan->workspace.to_patient(vector_of(tick.proxy_m));
    ASSERT_NEAR(tick.distance_mm[0], distance_mm(liver_mm, liver_radius_mm, proxy), 1e-9) << n;
    ASSERT_NEAR(tick.distance_mm[1], distance_mm(aorta_mm, aorta_radius_mm, proxy), 1e-9) << n;
    for (std::size_t other = 2; other < distance_count; ++other) ASSERT_TRUE(std::isnan(tick.distance_mm[other]));
    deepest_mm = std::max(deepest_mm, tick.distance_mm[0]);
    apart_mm = std::max(apart_mm, glm::distance(vector_of(tick.proxy_m), vector_of(tick.probe_m)) * 1e3);
  }
  EXPECT_NEAR(deepest_mm, 0, 0.2) << "the wall held";
  EXPECT_GT(apart_mm, 2) << "of the proxy, not of the hand";
}

}  // namespace
}  // namespace palpate::plugin
