#include "plugin/paraview/client/model/correction_model.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <variant>
#include <vector>

#include "plugin/paraview/client/model/testing/correcting.h"

namespace palpate::plugin {
namespace {

using testing::Correcting;
using testing::CorrectingSlowly;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Tool = CorrectionModel::Tool;

TEST_F(Correcting, AStrokeIsOneEditOfTheScene) {
  model.begin(liver, {});
  stroke({{0, 0, 0}, {1, 0, 0}, {1.1, 0, 0}, {2, 1, 0}});
  EXPECT_THAT(kinds(), ElementsAre("trace"));
  const auto& trace = std::get<io::TraceEdit>(model.edits().front());
  EXPECT_THAT(trace.points_mm, ElementsAre(io::Vec3(0, 0, 0), io::Vec3(1, 0, 0), io::Vec3(2, 1, 0)));
  EXPECT_EQ(kept_edits(), model.edits()) << "what is kept is what was drawn";
  EXPECT_TRUE(model.stroke().empty());
  EXPECT_EQ(kept.steps.back().what, "Trace");
  EXPECT_EQ(scene.scene().structures.front().file, "/study/liver.dcm");

  model.set_tool(Tool::add);
  model.set_radius_mm(4.5);
  stroke({{5, 0, 0}, {6, 0, 0}});
  model.set_tool(Tool::remove);
  stroke({{7, 0, 0}});
  EXPECT_THAT(kinds(), ElementsAre("trace", "add", "remove"));
  EXPECT_EQ(std::get<io::AddEdit>(model.edits()[1]).tube, (io::Tube{{{5, 0, 0}, {6, 0, 0}}, 4.5}));
  EXPECT_EQ(std::get<io::RemoveEdit>(model.edits()[2]).tube, (io::Tube{{{7, 0, 0}}, 4.5}));
  model.draw_felt({{8, 0, 0}, {9, 0, 0}});
  EXPECT_THAT(kinds(), SizeIs(4)) << "the stylus' path";
  model.set_tool(Tool::trace);
  stroke({{0, 9, 0}});
  EXPECT_THAT(kinds(), SizeIs(4)) << "a click";
}

TEST_F(Correcting, NothingIsDrawnWhereNothingIsCorrected) {
  stroke({{0, 0, 0}, {1, 0, 0}});
  model.draw_felt({{0, 0, 0}});
  model.undo();
  model.redo();
  model.take_scan_edge({0, 0, 0});
  EXPECT_TRUE(scene.scene().structures.empty());
  EXPECT_THAT(kept.steps, IsEmpty());
}

TEST_F(Correcting, EditsAreUndoneAndRedoneOneByOne) {
  model.begin(liver, {});
  for (int n = 0; n < 3; ++n) stroke({{10.0 * n, 0, 0}, {10.0 * n, 1, 0}});
  const std::vector<io::Edit> all = model.edits();
  EXPECT_FALSE(model.can_redo());
  for (std::size_t left = 3; left-- > 0;) {
    model.undo();
    EXPECT_THAT(model.edits(), SizeIs(left));
    EXPECT_EQ(kept_edits(), model.edits());
  }
  EXPECT_FALSE(model.can_undo());
  model.undo();
  EXPECT_THAT(model.edits(), IsEmpty());
  for (std::size_t done = 1; done <= 3; ++done) {
    model.redo();
    EXPECT_EQ(model.edits(), std::vector<io::Edit>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(done)));
  }
  EXPECT_FALSE(model.can_redo());
  model.undo();
  model.undo();
  stroke({{77, 0, 0}, {78, 0, 0}});
  EXPECT_FALSE(model.can_redo()) << "another edit has taken their place";
  EXPECT_THAT(model.edits(), SizeIs(2));
}

TEST_F(Correcting, WhatParaViewTakesBackCanBeRedoneHere) {
  model.begin(liver, {});
  stroke({{0, 0, 0}, {0, 1, 0}});
  stroke({{10, 0, 0}, {10, 1, 0}});
  const std::vector<io::Edit> all = model.edits();
  scene.undo();
  EXPECT_THAT(model.edits(), SizeIs(1));
  EXPECT_TRUE(model.can_redo());
  model.redo();
  EXPECT_EQ(model.edits(), all);
  scene.undo();  // the redo
  scene.redo();
  EXPECT_EQ(model.edits(), all);
  EXPECT_FALSE(model.can_redo());
}

TEST_F(Correcting, EditsOfARestoredSceneCanBeTakenBack) {
  modes::Scene restored;
  restored.structures.push_back({.name = "liver", .file = liver.file, .segment = "liver"});
  restored.structures.front().edits = {io::AddEdit{{.path_mm = {{1, 2, 3}}, .radius_mm = 2}}};
  scene.open(restored);
  model.begin(liver, {});
  EXPECT_THAT(kinds(), ElementsAre("add"));
  model.undo();
  EXPECT_THAT(kept_edits(), IsEmpty());
}

/// A structure that the scene's contours make: they stay, whatever is taken back.
TEST_F(Correcting, ContoursThatMakeAStructureAreNoCorrection) {
  modes::SceneStructure drawn;
  drawn.name = "drawn";
  io::ContoursEdit contours;
  for (const double z : {0.0, 2.0, 4.0}) contours.loops_mm.push_back({{0, 0, z}, {9, 0, z}, {9, 9, z}, {0, 9, z}});
  drawn.edits = {contours};
  scene.edit(QStringLiteral("Draw"), [&](modes::Scene& now) { now.structures = {drawn}; });
  model.begin(drawn_structure(drawn), {});
  EXPECT_FALSE(model.can_undo());
  model.undo();
  EXPECT_THAT(kinds(), ElementsAre("contours"));
  EXPECT_EQ(scene.scene().structures.size(), 1U);
  model.set_tool(Tool::add);
  stroke({{5, 5, 2}, {6, 5, 2}});
  EXPECT_THAT(kinds(), ElementsAre("contours", "add"));
  EXPECT_TRUE(model.can_undo());
  model.undo();
  EXPECT_THAT(kinds(), ElementsAre("contours"));
  EXPECT_FALSE(model.can_undo());
  EXPECT_TRUE(model.can_redo());
}

TEST_F(Correcting, TheEditsStayWhereItEndsAndComeBack) {
  model.begin(liver, {});
  stroke({{0, 0, 0}, {0, 1, 0}});
  model.end();
  EXPECT_THAT(model.edits(), IsEmpty());
  EXPECT_THAT(kept_edits(), SizeIs(1));
  model.begin(liver, {});
  EXPECT_THAT(kinds(), ElementsAre("trace"));
}

TEST_F(Correcting, AnotherScanEndsItWithoutAStep) {
  model.begin(liver, {});
  asked.back()(three());
  model.press({0, 0, 0});
  const std::size_t steps = kept.steps.size();
  const int before = not_wanted;
  model.forget();
  EXPECT_EQ(kept.steps.size(), steps);
  EXPECT_GT(not_wanted, before);
  EXPECT_FALSE(model.doubtful().places());
  EXPECT_TRUE(model.stroke().empty());
  model.let_go();
  EXPECT_THAT(kept_edits(), IsEmpty());
}

/// A correction may end while the key that shows the outline before the last stroke is down. The next one shows its
/// own outline.
TEST_F(Correcting, EachCorrectionBeginsWithItsOutlineAsItIs) {
  const std::pair<const char*, std::function<void()>> ends[] = {
      {"its end", [this] { model.end(); }}, {"another scan", [this] { model.forget(); }}, {"the next one", [] {}}};
  for (const auto& [what, end] : ends) {
    SCOPED_TRACE(what);
    model.begin(liver, {});
    stroke({{0, 0, 0}, {0, 1, 0}});
    model.show_before(true);
    ASSERT_TRUE(model.shows_before());
    end();
    model.begin(liver, {});
    EXPECT_FALSE(model.shows_before());
  }
}

TEST_F(Correcting, ARadiusStaysWithinWhatAnEditMayHave) {
  EXPECT_EQ(model.radius_mm(), 3);
  for (const double wanted : {0.0, 1e-3, 7.0, 1e9}) {
    model.set_radius_mm(wanted);
    EXPECT_EQ(model.radius_mm(), std::clamp(wanted, io::edit_limits::least_mm, io::edit_limits::most_mm));
  }
  model.set_tool(Tool::add);
  model.begin(liver, {});
  model.draw_felt({{1, 2, 3}});
  ASSERT_THAT(kinds(), ElementsAre("add")) << "and so it is taken";
}

/// Where nothing looks for the scan's edge a stroke is an edit at once.
TEST_F(Correcting, WithoutASearchAFeltTraceIsAnEditAtOnce) {
  model.begin(liver, {});
  model.draw_felt({{0, 0, 0}, {1, 0, 0}});
  EXPECT_THAT(kinds(), ElementsAre("trace"));
  EXPECT_FALSE(model.is_tracing());
  model.undo();
  EXPECT_THAT(kinds(), ::testing::IsEmpty());
}

/// The contours that define a structure are no correction: Undo leaves them, however often it is pressed.
TEST_F(CorrectingSlowly, UndoLeavesTheContoursThatDefineAStructure) {
  modes::SceneStructure drawn{.name = "Lesion"};
  io::ContoursEdit contours;
  contours.loops_mm = {{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}}};
  drawn.edits.emplace_back(contours);
  scene.edit(QStringLiteral("Draw"), [&drawn](modes::Scene& now) { now.structures.push_back(drawn); });
  all_is_read();
  const io::Structure lesion = drawn_structure(drawn);
  ASSERT_EQ(making_edits(lesion), 1U);
  model.begin(lesion, {});
  all_is_read();
  stroke({{0, 0, 5}, {0, 1, 5}});
  all_is_read();
  ASSERT_THAT(model.edits(), ::testing::SizeIs(2));
  for (int n = 0; n < 3; ++n) model.undo();
  all_is_read();
  EXPECT_THAT(model.edits(), ::testing::SizeIs(1));
}

/// What shows the model is told of what changes, and of nothing else.
TEST_F(Correcting, EachChangeOfAToolIsToldOnce) {
  model.begin(liver, {});
  int changes = 0;
  QObject::connect(&model, &CorrectionModel::changed, [&changes] { ++changes; });
  const auto count = [&changes](const auto& change) {
    changes = 0;
    change();
    return changes;
  };
  for (const bool before : {true, false}) {
    EXPECT_EQ(count([&] { model.show_before(before); }), 1);
    EXPECT_EQ(model.shows_before(), before);
    EXPECT_EQ(count([&] { model.show_before(before); }), 0);
  }
  for (const Tool tool : {Tool::add, Tool::remove, Tool::trace}) {
    EXPECT_EQ(count([&] { model.set_tool(tool); }), 1);
    EXPECT_EQ(count([&] { model.set_tool(tool); }), 0);
  }
  EXPECT_EQ(count([&] { model.set_radius_mm(7); }), 1);
  EXPECT_EQ(count([&] { model.set_radius_mm(7); }), 0);
}

}  // namespace
}  // namespace palpate::plugin
