/// Corrections: the scan's edge is felt, and the stylus is held in a slice.

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <string>

#include "plugin/paraview/client/model/testing/application.h"
#include "plugin/paraview/client/model/testing/correcting.h"

namespace palpate::plugin {
namespace {

using testing::Correcting;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST_F(Correcting, TheScansEdgeIsFeltWhileItLasts) {
  EXPECT_EQ(snap(), nullptr);
  model.begin(liver, {.per_mm = 120});
  ASSERT_NE(snap(), nullptr);
  EXPECT_TRUE(snap()->structure.empty()) << "the scan's edge, not the outline";
  EXPECT_EQ(snap()->side, modes::Side::both);
  EXPECT_DOUBLE_EQ(snap()->strength_n(120), model.snap_n());
  EXPECT_DOUBLE_EQ(snap()->strength_n(20), 0);
  ASSERT_THAT(snap()->gates, SizeIs(1));
  EXPECT_DOUBLE_EQ(snap()->gates[0].factor(0), 1);
  EXPECT_DOUBLE_EQ(snap()->gates[0].factor(-7), 0);
  model.set_snap_n(2.2);
  EXPECT_DOUBLE_EQ(snap()->strength_n(120), 2.2);
  model.end();
  EXPECT_EQ(snap(), nullptr);
  EXPECT_EQ(model.structure(), nullptr);
}

/// Half-way of the value: entered from below where the structure is brighter, and from above where it is darker.
TEST_F(Correcting, TheScansEdgeIsFeltHalfWay) {
  for (const double rise : {200.0, -200.0}) {
    model.begin(liver, {.per_mm = 120, .rise = rise, .middle = 40});
    ASSERT_NE(snap(), nullptr);
    EXPECT_EQ(snap()->side, rise > 0 ? modes::Side::entering : modes::Side::leaving);
    ASSERT_THAT(snap()->gates, SizeIs(2));
    EXPECT_EQ(snap()->gates[1].of, modes::Datum::value);
    EXPECT_DOUBLE_EQ(snap()->gates[1].factor(40 + 0.1 * rise), 1) << "inside";
    EXPECT_DOUBLE_EQ(snap()->gates[1].factor(40 - 0.1 * rise), 0) << "outside";
    EXPECT_NEAR(snap()->gates[1].factor(40), 0.5, 1e-9);
  }
}

/// Two planes, one to each side: a step that can be undone, and nothing if no outline is near.
TEST_F(Correcting, TheStylusIsHeldInASlice) {
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.hold_in(slice);
  EXPECT_FALSE(model.held_in()) << "nothing is corrected";
  model.begin(liver, {});
  EXPECT_THAT(planes(), IsEmpty());
  model.hold_in(slice);
  ASSERT_THAT(planes(), SizeIs(2));
  EXPECT_EQ(planes()[0].direction, -planes()[1].direction);
  for (const modes::Mode& plane : planes()) {
    EXPECT_EQ(plane.position_mm, slice.point_mm);
    EXPECT_EQ(plane.shape, modes::Shape::plane);
    ASSERT_THAT(plane.gates, SizeIs(1));
    EXPECT_DOUBLE_EQ(plane.gates[0].factor(0), 1);
    EXPECT_DOUBLE_EQ(plane.gates[0].factor(7), 0);
  }
  EXPECT_EQ(kept.steps.back().what, "Hold in the slice");
  model.set_snap_n(2.2);
  stroke({{0, 0, 0}, {0, 1, 0}});
  EXPECT_THAT(planes(), SizeIs(2)) << "whatever else is changed";
  scene.undo();
  scene.undo();
  EXPECT_EQ(model.held_in(), slice);
  scene.undo();
  EXPECT_FALSE(model.held_in());
  EXPECT_THAT(planes(), IsEmpty());
  scene.redo();
  EXPECT_EQ(model.held_in(), slice) << "the scene's";
  model.hold_in(std::nullopt);
  EXPECT_THAT(planes(), IsEmpty());
  model.hold_in(slice);
  model.end();
  EXPECT_THAT(planes(), IsEmpty());
  EXPECT_FALSE(model.held_in());
}

/// Left, undone, or loaded with a state: what a correction adds is felt while it runs, and not afterwards.
TEST_F(Correcting, NothingThatHoldsTheStylusIsLeftBehind) {
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  const auto kept_modes = [&] { return modes::scene_from_json(kept.text("Scene"), "scene").modes.size(); };
  model.begin(liver, {});
  model.hold_in(slice);
  stroke({{0, 0, 0}, {0, 1, 0}});
  const std::string saved = kept.text("Scene");
  const std::size_t steps = kept.steps.size();
  EXPECT_EQ(kept_modes(), 3U);
  model.forget();  // the scan was left
  EXPECT_EQ(snap(), nullptr);
  EXPECT_THAT(planes(), IsEmpty());
  EXPECT_EQ(kept_modes(), 0U) << "a state that is saved now has none";
  EXPECT_EQ(kept.steps.size(), steps) << "which is no step";
  EXPECT_THAT(kept_edits(), SizeIs(1)) << "the edits stay";
  scene.undo();
  EXPECT_THAT(kept_edits(), IsEmpty());
  EXPECT_EQ(kept_modes(), 0U);
  EXPECT_EQ(snap(), nullptr);
  kept.put("Scene", saved);  // a state file that was saved while it ran
  EXPECT_THAT(kept_edits(), SizeIs(1));
  EXPECT_EQ(kept_modes(), 0U);
  EXPECT_EQ(snap(), nullptr);
  model.begin(liver, {});
  EXPECT_NE(snap(), nullptr) << "one can go on";
  model.end();
  EXPECT_EQ(kept_modes(), 0U);
  scene.undo();
  EXPECT_EQ(snap(), nullptr) << "there is no correction that it would belong to";
}

TEST_F(Correcting, TheStylusIsFreeWhileAKeyIsHeld) {
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.begin(liver, {});
  model.set_freed(true);
  EXPECT_FALSE(model.is_freed()) << "it is free";
  model.hold_in(slice);
  const std::size_t steps = kept.steps.size();
  model.set_freed(true);
  EXPECT_THAT(planes(), IsEmpty());
  EXPECT_EQ(model.held_in(), slice) << "and will be held again";
  model.set_freed(false);
  EXPECT_THAT(planes(), SizeIs(2));
  EXPECT_EQ(kept.steps.size(), steps) << "which is no step";
  model.set_freed(true);
  stroke({{0, 0, 0}, {0, 1, 0}});
  model.set_snap_n(2.2);
  EXPECT_TRUE(model.is_freed());
  EXPECT_THAT(planes(), IsEmpty());
  model.set_freed(false);
  EXPECT_THAT(planes(), SizeIs(2)) << "also after what was drawn meanwhile";
  EXPECT_THAT(kept_edits(), SizeIs(1));
}

/// The view may turn to other slices while the key is held. The stylus is held in the last of them.
TEST_F(Correcting, AfterTheKeyTheStylusIsHeldInTheSliceThatIsShown) {
  model.begin(liver, {});
  model.hold_in(HeldPlane{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}});
  const HeldPlane slices[] = {{.point_mm = {1, 2, 31}, .normal = {0, 0, 1}},
                              {.point_mm = {1, 5, 31}, .normal = {0, 1, 0}},
                              {.point_mm = {9, 5, 31}, .normal = {-1, 0, 0}}};
  for (std::size_t turns = 1; turns <= 3; ++turns) {
    SCOPED_TRACE(turns);
    model.set_freed(true);
    const HeldPlane* shown = nullptr;
    for (std::size_t n = 0; n < turns; ++n) {
      shown = &slices[(turns + n) % 3];
      model.follow_slice(*shown);
      EXPECT_THAT(planes(), IsEmpty()) << "it is free";
    }
    model.set_freed(false);
    EXPECT_EQ(model.held_in(), *shown);
    ASSERT_THAT(planes(), SizeIs(2));
    for (const modes::Mode& plane : planes()) {
      EXPECT_EQ(plane.position_mm, shown->point_mm);
      EXPECT_EQ(std::abs(glm::dot(plane.direction, shown->normal)), 1);
    }
  }
}

TEST_F(Correcting, ThePlanesFollowTheSlice) {
  HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.begin(liver, {});
  model.follow_slice(slice);
  EXPECT_THAT(planes(), IsEmpty()) << "it is free";
  model.hold_in(slice);
  const std::size_t steps = kept.steps.size();
  for (slice.point_mm.z = 31; slice.point_mm.z < 35; ++slice.point_mm.z) {
    model.follow_slice(slice);
    ASSERT_THAT(planes(), SizeIs(2));
    EXPECT_EQ(planes()[1].position_mm, slice.point_mm);
  }
  EXPECT_EQ(kept.steps.size(), steps) << "while the wheel turns";
  stroke({{0, 0, 0}, {0, 1, 0}});
  EXPECT_DOUBLE_EQ(held_plane(modes::scene_from_json(kept.text("Scene"), "scene"), liver)->point_mm.z, 34);
}

/// Slices that were passed are no steps; the one where the view stays becomes one by itself.
TEST_F(Correcting, ASliceBecomesAStepWhereTheViewStays) {
  testing::application();
  CorrectionModel with_timer{scene};  // made after the application, so that its timer runs
  with_timer.begin(liver, {});
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  with_timer.hold_in(slice);
  const std::size_t steps = kept.steps.size();
  HeldPlane next = slice;
  for (int n = 1; n <= 3; ++n) {
    next.point_mm.z += 1;
    with_timer.follow_slice(next);
  }
  EXPECT_EQ(kept.steps.size(), steps);
  ASSERT_TRUE(testing::comes([&] { return kept.steps.size() > steps; }));
  EXPECT_EQ(kept.steps.size(), steps + 1);
  EXPECT_EQ(with_timer.held_in(), next);
  with_timer.forget();
}

/// A scene from the pipeline is cleaned of a correction that does not run, as long as there is a model of corrections.
TEST(CorrectionModel, NothingIsCleanedWithoutIt) {
  MadeText kept;
  SceneModel scene(kept);
  auto model = std::make_unique<CorrectionModel>(scene);
  io::Structure liver;
  liver.file = "/study/liver.dcm";
  liver.number = 3;
  liver.name = "liver";
  scene.open(modes::Scene{});
  model->begin(liver, {.per_mm = 120});
  const std::string correcting = kept.text("Scene");
  model->end();
  const std::size_t modes = scene.scene().modes.size();
  kept.put("Scene", correcting);
  EXPECT_EQ(scene.scene().modes.size(), modes) << "it is not felt";
  model.reset();
  kept.put("Scene", correcting + " ");
  EXPECT_GT(scene.scene().modes.size(), modes);
}

}  // namespace
}  // namespace palpate::plugin
