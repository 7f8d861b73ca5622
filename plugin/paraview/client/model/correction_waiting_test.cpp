/// Corrections: each step waits until its files are read.

#include <gmock/gmock.h>

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "plugin/paraview/client/model/testing/correcting.h"

namespace palpate::plugin {
namespace {

using testing::Correcting;
using testing::CorrectingSlowly;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A step waits for what it needs to be read: what was pressed meanwhile is done after it, for the same structure.
TEST_F(Correcting, WhatIsPressedWhileAStepWaitsIsDoneAfterIt) {
  std::vector<std::pair<QString, SceneModel::Change>> waiting;
  model.set_press([&](const QString& what, const SceneModel::Change& change) { waiting.emplace_back(what, change); });
  model.begin(liver, {});
  EXPECT_THAT(asked, IsEmpty()) << "its outline is not read yet";
  stroke({{0, 0, 0}, {0, 1, 0}});
  stroke({{10, 0, 0}, {10, 1, 0}});
  model.end();
  for (const auto& [what, change] : waiting) scene.edit(what, change);
  EXPECT_THAT(kept_edits(), SizeIs(2));
  EXPECT_EQ(snap(), nullptr);
}

TEST_F(CorrectingSlowly, EachOfSeveralQuickRedosIsTheNext) {
  model.begin(liver, {});
  for (int n = 0; n < 3; ++n) stroke({{10.0 * n, 0, 0}, {10.0 * n, 1, 0}});
  all_is_read();
  const std::vector<io::Edit> all = model.edits();
  ASSERT_THAT(all, SizeIs(3));
  for (int n = 0; n < 3; ++n) model.undo();
  all_is_read();
  ASSERT_THAT(model.edits(), IsEmpty());
  model.redo();
  model.redo();
  all_is_read();
  EXPECT_EQ(model.edits(), std::vector<io::Edit>(all.begin(), all.begin() + 2));
  EXPECT_TRUE(model.can_redo()) << "the third is not lost";
  model.redo();
  model.redo();
  all_is_read();
  EXPECT_EQ(model.edits(), all) << "there is none after the last";
  model.undo();
  all_is_read();
  model.redo();
  model.end();
  all_is_read();
  EXPECT_EQ(kept_edits(), all) << "also where it ends at once";
}

/// They are known once the outline was drawn, which may be after its correction has begun.
TEST_F(CorrectingSlowly, TheScansEdgesMayBecomeKnownLater) {
  model.set_edges({.per_mm = 7});
  EXPECT_THAT(reading, IsEmpty()) << "nothing is corrected";
  model.begin(liver, {});
  model.set_edges({.per_mm = 120, .rise = 200, .middle = 40});
  all_is_read();
  ASSERT_NE(snap(), nullptr);
  EXPECT_EQ(snap()->side, modes::Side::entering);
  EXPECT_DOUBLE_EQ(snap()->strength_n(120), model.snap_n());
  EXPECT_DOUBLE_EQ(snap()->strength_n(20), 0);
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.hold_in(slice);
  model.set_snap_n(2.2);
  all_is_read();
  const std::size_t steps = kept.steps.size();
  model.set_edges({.per_mm = 30, .rise = -50, .middle = 10});
  all_is_read();
  EXPECT_EQ(snap()->side, modes::Side::leaving);
  EXPECT_DOUBLE_EQ(snap()->strength_n(30), 2.2);
  EXPECT_EQ(model.held_in(), slice);
  EXPECT_EQ(kept.steps.size(), steps) << "which is no step";
  EXPECT_EQ(kept.text("Scene"), modes::to_json(scene.scene())) << "and is kept";
  model.set_edges({.per_mm = 30, .rise = -50, .middle = 10});
  EXPECT_THAT(reading, IsEmpty()) << "they are the same";
}

TEST_F(CorrectingSlowly, ItIsHeldInASliceOnceTheSceneHasIt) {
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.begin(liver, {});
  all_is_read();
  int told = 0;
  QObject::connect(&model, &CorrectionModel::changed, [&] { ++told; });
  model.hold_in(slice);
  EXPECT_FALSE(model.held_in()) << "it is read for";
  model.set_snap_n(2.2);
  all_is_read();
  EXPECT_EQ(model.held_in(), slice);
  EXPECT_THAT(planes(), SizeIs(2)) << "whatever was asked for meanwhile";
  scene.set_commit([](const modes::Scene&, Pace) { throw std::runtime_error("it has too many modes"); });
  told = 0;
  model.hold_in(std::nullopt);
  all_is_read();
  EXPECT_EQ(model.held_in(), slice) << "it was refused";
  model.follow_slice({.point_mm = {1, 2, 31}, .normal = {0, 0, 1}});
  EXPECT_EQ(model.held_in(), slice);
  model.hold_in(slice);
  EXPECT_GT(told, 1) << "whoever asked for it shows what is so";
}

}  // namespace
}  // namespace palpate::plugin
