#include "plugin/paraview/client/model/unsaved_work.h"

#include <gmock/gmock.h>

#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/correction_model.h"
#include "plugin/paraview/client/model/testing/made_text.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Unsaving : ::testing::Test {
  Unsaving() {
    scene.open(modes::load_scene("ct-bone"));
    marks.set_scan("one");
    liver.file = "/study/liver.dcm";
    liver.number = 3;
    liver.name = "liver";
  }

  void set_strength(double newtons) {
    scene.edit(QStringLiteral("Strength"),
               [newtons](modes::Scene& now) { now.modes.front().strength_n = modes::TransferFunction(newtons); });
  }
  void set_hand(double number) {
    scene.edit(QStringLiteral("Hand"), [number](modes::Scene& now) {
      now.workspace.scale = number;
      now.limits.force_n = number;
      now.stiffness_n_per_m = 500 + number;
    });
  }
  void mark(double x) {
    FeltMark made;
    made.position_mm = {x, 0, 0};
    marks.add(made);
  }
  void add_ball(double x) {
    correction.set_tool(CorrectionModel::Tool::add);
    correction.draw_felt({{x, 0, 0}, {x + 5, 0, 0}});
  }

  MadeText kept;
  SceneModel scene{kept};
  MarksModel marks{kept};
  CorrectionModel correction{scene};
  UnsavedWork unsaved{scene, marks};
  io::Structure liver;
};

TEST_F(Unsaving, WhatNobodyEditedIsNotAskedAbout) {
  EXPECT_FALSE(unsaved.of_program().any());
  scene.propose(modes::load_scene("ct-chest"));
  EXPECT_FALSE(unsaved.of_program().any()) << "the panel's own proposal";
  set_hand(1.5);
  EXPECT_FALSE(unsaved.of_program().any()) << "how the hand reaches the scan is no work";
  correction.begin(liver, {});
  correction.hold_in(HeldPlane{});
  EXPECT_FALSE(unsaved.of_program().any()) << "a correction that has changed nothing yet";
}

TEST_F(Unsaving, AnEditIsUnsavedUntilItIsUndone) {
  set_strength(0.7);
  EXPECT_TRUE(unsaved.of_scan().scene);
  EXPECT_TRUE(unsaved.of_program().scene);
  set_hand(1.5);
  set_strength(0.6);
  for (int n = 0; n < 3; ++n) scene.undo();
  EXPECT_FALSE(unsaved.of_program().any());
  scene.redo();
  EXPECT_TRUE(unsaved.of_program().scene);
}

TEST_F(Unsaving, ASceneThatStandsElsewhereIsSaved) {
  set_strength(0.7);
  unsaved.note_scene_saved();
  EXPECT_FALSE(unsaved.of_program().any());
  set_strength(0.6);
  EXPECT_TRUE(unsaved.of_program().scene);
  scene.undo();
  EXPECT_FALSE(unsaved.of_program().any()) << "it is the saved one again";
  correction.begin(liver, {});
  add_ball(0);
  unsaved.note_scene_saved();
  EXPECT_FALSE(unsaved.of_program().any()) << "a scene's file has the edits of its outlines";
}

TEST_F(Unsaving, AStateFileHasAllThatThePipelineHas) {
  set_strength(0.7);
  correction.begin(liver, {});
  add_ball(0);
  mark(1);
  const Unsaved before = unsaved.of_program();
  EXPECT_TRUE(before.scene);
  EXPECT_THAT(before.outlines, ElementsAre("liver"));
  EXPECT_EQ(before.marks, 1U);
  unsaved.note_state_saved();
  EXPECT_FALSE(unsaved.of_program().any());
  add_ball(20);
  EXPECT_THAT(unsaved.of_program().outlines, ElementsAre("liver"));
  EXPECT_FALSE(unsaved.of_program().scene);
}

TEST_F(Unsaving, WhatIsBeingDraggedIsInNoStateFile) {
  scene.drag([](modes::Scene& now) { now.modes.front().strength_n = modes::TransferFunction(0.4); });
  unsaved.note_state_saved();
  EXPECT_TRUE(unsaved.of_program().scene);
}

TEST_F(Unsaving, AStateThatWasLoadedIsSaved) {
  modes::Scene loaded = modes::load_scene("ct-chest");
  loaded.modes.front().strength_n = modes::TransferFunction(0.33);
  kept.put("Scene", modes::to_json(loaded));
  unsaved.note_state_saved();
  EXPECT_FALSE(unsaved.of_program().any());
  set_strength(0.6);
  EXPECT_TRUE(unsaved.of_program().scene);
}

TEST_F(Unsaving, AStateIsSavedWhoseSceneIsReadyLater) {
  std::function<void()> ready;
  scene.set_make_ready([&ready](const modes::Scene&, std::function<void()> then) {
    ready = std::move(then);
    return true;
  });
  modes::Scene loaded = modes::load_scene("ct-chest");
  loaded.modes.front().strength_n = modes::TransferFunction(0.33);
  kept.put("Scene", modes::to_json(loaded));
  unsaved.note_state_saved();
  ASSERT_TRUE(ready);
  ready();
  ASSERT_EQ(modes::to_json(scene.scene()), modes::to_json(loaded));
  EXPECT_FALSE(unsaved.of_program().any());
  set_strength(0.6);
  EXPECT_TRUE(unsaved.of_program().scene);
}

TEST_F(Unsaving, AnOutlineIsSavedWithTheEditsThatWereWritten) {
  correction.begin(liver, {});
  add_ball(0);
  const auto written = correction.edits();
  EXPECT_THAT(unsaved.of_scan().outlines, ElementsAre("liver"));
  EXPECT_FALSE(unsaved.of_scan().scene) << "the outline is named, and nothing else";
  add_ball(20);  // while it is written
  unsaved.note_outline_saved(liver, written);
  EXPECT_THAT(unsaved.of_scan().outlines, ElementsAre("liver"));
  correction.undo();
  EXPECT_FALSE(unsaved.of_scan().any()) << "it is the written one";
  correction.undo();
  EXPECT_FALSE(unsaved.of_scan().any()) << "it is the file's";
  correction.redo();
  correction.end();
  EXPECT_FALSE(unsaved.of_scan().any());
}

TEST_F(Unsaving, MarksAreCountedAndWaitForTheirScan) {
  mark(1);
  mark(2);
  marks.edit(QStringLiteral("Keep"), [](Marks& now) { now.distances.push_back({.from = 0, .to = 1}); });
  EXPECT_EQ(unsaved.of_program().marks, 3U);
  EXPECT_FALSE(unsaved.of_scan().any()) << "another scan takes none away";
  unsaved.note_marks_saved("one", marks.marks());
  EXPECT_FALSE(unsaved.of_program().any());
  mark(3);
  marks.set_scan("two");
  mark(1);  // at the same place, of another scan
  EXPECT_EQ(unsaved.of_program().marks, 2U);
  marks.set_scan("one");
  marks.edit(QStringLiteral("Rename"), [](Marks& now) { now.points[0].name = "edge"; });
  EXPECT_EQ(unsaved.of_program().marks, 4U) << "a mark with another name, and the distance from it";
  marks.forget();
  EXPECT_FALSE(unsaved.of_program().any());
}

/// A distance or an angle is another one as soon as one of its marks is.
TEST_F(Unsaving, ADistanceOrAnAngleIsSavedWithAllOfItsMarks) {
  for (int n = 0; n < 4; ++n) mark(n * n);
  marks.edit(QStringLiteral("Keep"), [](Marks& now) {
    now.points[2].position_mm.y = 5;
    now.distances = {{.from = 0, .to = 1}};
    now.angles = {{.from = 0, .at = 1, .to = 2}};
  });
  unsaved.note_marks_saved("one", marks.marks());
  ASSERT_EQ(unsaved.of_program().marks, 0U);
  const std::size_t changed[] = {3, 3, 2, 1};  // the mark itself, the distance and the angle
  for (std::size_t n = 0; n < std::size(changed); ++n) {
    const auto move = [&](double by_mm) {
      marks.edit(QStringLiteral("Move"), [&](Marks& now) { now.points[n].position_mm.z = by_mm; });
    };
    move(8);
    EXPECT_EQ(unsaved.of_program().marks, changed[n]) << n;
    move(0);
    EXPECT_EQ(unsaved.of_program().marks, 0U) << n;
  }
  std::size_t more = 0;
  for (const MarkedDistance& one : {MarkedDistance{.from = 0, .to = 2}, MarkedDistance{.from = 3, .to = 1}}) {
    marks.edit(QStringLiteral("Measure"), [&](Marks& now) { now.distances.push_back(one); });
    EXPECT_EQ(unsaved.of_program().marks, ++more);
  }
  for (const MarkedAngle& one : {MarkedAngle{.from = 3, .at = 1, .to = 2}, MarkedAngle{.from = 0, .at = 3, .to = 2},
                                 MarkedAngle{.from = 0, .at = 1, .to = 3}}) {
    marks.edit(QStringLiteral("Measure"), [&](Marks& now) { now.angles.push_back(one); });
    EXPECT_EQ(unsaved.of_program().marks, ++more);
  }
}

/// The user is warned at that margin, also where no mode reads the structure.
TEST_F(Unsaving, AMarginIsWork) {
  const auto set_margin = [this](std::optional<double> mm) {
    scene.edit(QStringLiteral("Margin"), [mm](modes::Scene& now) {
      now.structures = {{.name = "liver", .file = "/study/liver.dcm", .segment = "liver"}};
      now.structures[0].margin_mm = mm;
    });
  };
  set_margin(std::nullopt);
  EXPECT_FALSE(unsaved.of_program().any()) << "it is named, and nothing else";
  set_margin(4);
  EXPECT_TRUE(unsaved.of_scan().scene);
  EXPECT_TRUE(unsaved.of_program().scene);
  unsaved.note_scene_saved();
  EXPECT_FALSE(unsaved.of_program().any());
  set_margin(5);
  EXPECT_TRUE(unsaved.of_program().scene);
  set_margin(4);
  EXPECT_FALSE(unsaved.of_program().any());
}

TEST_F(Unsaving, WhatTheUserLetGoIsNotAskedAboutAgain) {
  set_strength(0.7);
  mark(1);
  unsaved.let_scene_go();
  EXPECT_FALSE(unsaved.of_scan().any());
  EXPECT_TRUE(unsaved.of_program().scene) << "it is still here, and the program may end before another scan comes";
  unsaved.keep_scene();
  EXPECT_TRUE(unsaved.of_scan().scene) << "the other scan did not come";
  unsaved.let_all_go();
  EXPECT_FALSE(unsaved.of_program().any());
  unsaved.keep_all();
  EXPECT_TRUE(unsaved.of_program().scene) << "no state was chosen";
  EXPECT_EQ(unsaved.of_program().marks, 1U);
  unsaved.let_all_go();
  set_strength(0.6);
  EXPECT_TRUE(unsaved.of_scan().scene);
  EXPECT_TRUE(unsaved.of_program().scene);
  EXPECT_EQ(unsaved.of_program().marks, 1U);
}

}  // namespace
}  // namespace palpate::plugin
