/// All callers with the same edit of the same field share one field while any of them holds it.

#include "plugin/structures/shared_edits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "io/testing/made_labels.h"

namespace palpate::plugin {
namespace {

using Field = std::shared_ptr<const io::DistanceField>;

Field ball_of(double radius) {
  const auto inside = [=](const io::Vec3& at) { return glm::length(at) < radius; };
  return io::distance_of(io::made_labels(inside, 24, {}), {.reach_mm = 5});
}

/// 48 voxels of 1 mm along each axis, in which a ball about the origin is 200 HU brighter.
std::shared_ptr<const io::Volume> scan_of_a_ball(double radius) {
  constexpr int side = 48;
  auto scan = std::make_shared<io::Volume>();
  scan->geometry.dimensions = {side, side, side};
  scan->geometry.spacing_i = scan->geometry.spacing_j = 1;
  scan->geometry.step = {0, 0, 1};
  for (int k = 0; k < side; ++k) scan->geometry.slice_positions.emplace_back(-24, -24, k - 24);
  std::vector<float> values;
  for (int n = 0; n < side * side * side; ++n) {
    const io::Vec3 at(n % side - 24, n / side % side - 24, n / (side * side) - 24);
    const double noise = 3 * std::sin(12.9898 * n);
    values.push_back(static_cast<float>(noise + 100 * (1 + std::tanh(radius - glm::length(at)))));
  }
  scan->voxels = values;
  return scan;
}

const io::AddEdit hill{{.path_mm = {{12, 0, 0}}, .radius_mm = 4}};
const io::RemoveEdit hole{{.path_mm = {{12, 0, 0}}, .radius_mm = 4}};

TEST(SharedEdits, AreOneFieldForAllThatIsTheSame) {
  const Field before = ball_of(12), other = ball_of(12);
  const auto scan = scan_of_a_ball(13);
  const Field first = shared_edited(before, hill, scan);
  EXPECT_NE(first, before);
  EXPECT_EQ(shared_edited(before, hill, scan), first);
  EXPECT_EQ(shared_edited(before, hill, nullptr), first) << "it reads no scan";
  io::AddEdit larger = hill;
  larger.tube.radius_mm = 4.5;
  for (const Field& one :
       {shared_edited(other, hill, scan), shared_edited(before, hole, scan), shared_edited(before, larger, scan)}) {
    EXPECT_NE(one, first);
  }
  const auto chain = shared_edited(before, std::vector<io::Edit>{hill, hole}, scan);
  ASSERT_EQ(chain.size(), 3U);
  EXPECT_EQ(chain[0], before);
  EXPECT_EQ(chain[1], first);
  EXPECT_EQ(chain[2], shared_edited(first, hole, scan));
}

TEST(SharedEdits, GoWithTheirLastHolder) {
  const Field before = ball_of(12);
  Field held = shared_edited(before, hill, nullptr);
  const std::weak_ptr<const io::DistanceField> field = held;
  held.reset();
  EXPECT_TRUE(field.expired());
}

TEST(SharedEdits, ThatReadAScanAreThatScansOwn) {
  const Field before = ball_of(12);
  const auto scan = scan_of_a_ball(12.7), other = scan_of_a_ball(13.4);
  const io::ScanEdgeEdit to_the_edge{.center_mm = {12, 0, 0}, .radius_mm = 8, .most_mm = 3};
  const io::Vec3 pole(12, 0, 0);
  const Field here = shared_edited(before, to_the_edge, scan), there = shared_edited(before, to_the_edge, other);
  EXPECT_NEAR(here->sample(pole).mm, 0.7, 0.2);
  EXPECT_NEAR(there->sample(pole).mm, 1.4, 0.2);
  EXPECT_EQ(shared_edited(before, to_the_edge, scan), here);
  const std::shared_ptr<const io::Volume> not_owned(std::shared_ptr<void>(), other.get());
  const Field alone = shared_edited(before, to_the_edge, not_owned);
  EXPECT_NE(alone, there) << "another may come to its place";
  EXPECT_EQ(alone->sample(pole).mm, there->sample(pole).mm);
}

TEST(SharedEdits, OneThatCannotBeDoneIsRefusedByItsNumber) {
  const std::vector<io::Edit> edits{hill, io::TraceEdit{.points_mm = {{40, 0, 0}}, .known_to_mm = {}}};
  try {
    shared_edited(ball_of(12), edits, nullptr);
    FAIL() << "it lies too far away";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(std::string(error.what()).rfind("edit 2: trace: ", 0), 0U) << error.what();
  }
}

}  // namespace
}  // namespace palpate::plugin
