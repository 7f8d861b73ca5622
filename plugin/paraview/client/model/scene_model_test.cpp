#include "plugin/paraview/client/model/scene_model.h"

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/testing/made_text.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct SceneModelFollowed : ::testing::Test {
  SceneModelFollowed() {
    model.open(modes::load_scene("ct-bone"));
    QObject::connect(&model, &SceneModel::refused,
                     [this](const QString& why) { refused.push_back(why.toStdString()); });
    QObject::connect(&model, &SceneModel::changed, [this](Pace pace) { paces.push_back(pace); });
  }
  static SceneModel::Change force(double newton) {
    return [newton](modes::Scene& scene) { scene.limits.force_n = newton; };
  }
  double kept_force() const { return modes::scene_from_json(kept.text("Scene"), "kept").limits.force_n; }

  MadeText kept;
  SceneModel model{kept};
  std::vector<std::string> refused;
  std::vector<Pace> paces;
};

TEST_F(SceneModelFollowed, AnEditIsOneStep) {
  model.edit(QStringLiteral("Force"), force(1.5));
  model.edit(QStringLiteral("Force"), force(2.5));
  EXPECT_EQ(kept.steps.size(), 2U);
  EXPECT_EQ(kept_force(), 2.5);
  EXPECT_TRUE(model.is_edited());
  model.undo();
  EXPECT_EQ(model.scene().limits.force_n, 1.5);
  model.redo();
  EXPECT_EQ(model.scene().limits.force_n, 2.5);
}

TEST_F(SceneModelFollowed, ADragIsFeltAtOnceAndOneStepInTheEnd) {
  for (const double newton : {1.0, 1.1, 1.2}) model.drag(force(newton));
  EXPECT_THAT(paces, ElementsAre(Pace::dragged, Pace::dragged, Pace::dragged));
  EXPECT_EQ(model.scene().limits.force_n, 1.2);
  EXPECT_THAT(kept.steps, IsEmpty());
  model.finish_drag(QStringLiteral("Drag"));
  ASSERT_EQ(kept.steps.size(), 1U);
  EXPECT_EQ(kept_force(), 1.2);
  model.finish_drag(QStringLiteral("Drag"));
  EXPECT_EQ(kept.steps.size(), 1U) << "nothing has changed since";
}

TEST_F(SceneModelFollowed, WhatIsRefusedChangesNothingAndSaysWhyToTheOneWhoAsked) {
  const std::string before = kept.text("Scene");
  std::vector<QString> told;
  const auto tell = [&told](const QString& why) { told.push_back(why); };
  model.edit(QStringLiteral("Force"), force(-1), tell);
  model.drag(force(-1), tell);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_FALSE(told[0].isEmpty());
  EXPECT_EQ(told[0], told[1]);
  EXPECT_THAT(refused, IsEmpty()) << "it stands beside what was pressed, and nowhere else";
  EXPECT_EQ(kept.text("Scene"), before);
  EXPECT_THAT(paces, IsEmpty());
  model.edit(QStringLiteral("Force"), force(2), tell);
  EXPECT_TRUE(told.back().isEmpty()) << "what was said before is no longer true";
  model.edit(QStringLiteral("Force"), force(-1));
  EXPECT_EQ(refused.size(), 1U) << "nobody else shows it";
}

TEST_F(SceneModelFollowed, ACommitThatThrowsRefusesForPanelAndPipelineAlike) {
  const std::string before = kept.text("Scene");
  model.set_commit([](const modes::Scene&, Pace) { throw std::runtime_error("it cannot be felt here"); });
  EXPECT_FALSE(model.propose(modes::load_scene("ct-chest")));
  kept.put("Scene", modes::to_json(modes::load_scene("ct-chest")));  // somebody else
  EXPECT_THAT(refused, ElementsAre("it cannot be felt here", "it cannot be felt here"));
  EXPECT_EQ(kept.text("Scene"), before) << "what is refused does not stay in the pipeline";
}

TEST_F(SceneModelFollowed, AProposalIsNoStepAndNoEdit) {
  EXPECT_FALSE(model.is_edited());
  EXPECT_TRUE(model.propose(modes::load_scene("ct-chest")));
  EXPECT_THAT(kept.steps, IsEmpty());
  EXPECT_FALSE(model.is_edited());
  EXPECT_EQ(modes::scene_from_json(kept.text("Scene"), "kept").name, model.scene().name);
}

TEST_F(SceneModelFollowed, WhatIsNotReadyComesLaterOrNeverWhereAnotherCame) {
  std::vector<std::function<void()>> ready;
  model.set_make_ready([&](const modes::Scene&, std::function<void()> done) {
    ready.push_back(std::move(done));
    return true;
  });
  const std::string chest = modes::to_json(modes::load_scene("ct-chest"));
  const std::string bone = modes::to_json(modes::load_scene("ct-skin-and-bone"));
  const std::string before = model.scene().name;
  kept.put("Scene", chest);
  kept.put("Scene", bone);
  EXPECT_EQ(model.scene().name, before);
  EXPECT_FALSE(model.is_settled());
  ASSERT_EQ(ready.size(), 2U);
  ready[0]();
  EXPECT_EQ(model.scene().name, before) << "another came meanwhile";
  EXPECT_FALSE(model.is_settled());
  ready[1]();
  EXPECT_EQ(modes::to_json(model.scene()), bone);
  EXPECT_TRUE(model.is_settled());
}

TEST_F(SceneModelFollowed, TextThatIsNoSceneIsPutBack) {
  const std::string before = kept.text("Scene");
  for (const char* const text : {"{", "{\"version\": 99}", "no scene of that name", "{}"}) {
    kept.put("Scene", text);
    EXPECT_EQ(kept.text("Scene"), before) << text;
  }
  EXPECT_EQ(refused.size(), 4U);
}

MarkMade mark_at(double x) {
  FeltMark mark;
  mark.position_mm = {x, 0, 0};
  return mark;
}

TEST(MarksModel, MarksAreOfTheScanThatIsShown) {
  MadeText kept;
  MarksModel marks(kept);
  marks.set_scan("one");
  marks.add(mark_at(1));
  EXPECT_TRUE(marks.marks().points.empty()) << "there is no place that keeps it";
  kept.open("{}");
  marks.add(mark_at(1));
  marks.add(mark_at(2));
  ASSERT_EQ(marks.marks().points.size(), 2U);
  EXPECT_NE(marks.marks().points[0].name, marks.marks().points[1].name);
  marks.set_scan("other");
  EXPECT_TRUE(marks.marks().points.empty());
  marks.set_scan({});
  marks.add(mark_at(3));
  marks.set_scan("one");
  EXPECT_EQ(marks.marks().points.size(), 2U);
  marks.undo();
  EXPECT_EQ(marks.marks().points.size(), 1U);
}

/// Its source was deleted in the Pipeline Browser.
TEST(MarksModel, AnotherPlaceInThePipelineGetsSceneAndMarks) {
  MadeText kept;
  SceneModel scene(kept);
  MarksModel marks(kept);
  scene.open(modes::load_scene("ct-bone"));
  scene.edit(QStringLiteral("Force"), [](modes::Scene& now) { now.limits.force_n = 1.5; });
  marks.set_scan("one");
  marks.add(mark_at(1));
  const auto texts = kept.texts;
  kept.take_away();
  scene.reopen();
  EXPECT_EQ(kept.texts, texts);
  EXPECT_FALSE(scene.can_undo()) << "it would bring the former place back beside this one";
  EXPECT_TRUE(scene.is_edited());
  marks.add(mark_at(2));
  EXPECT_EQ(marks.marks().points.size(), 2U);
  EXPECT_NE(kept.texts, texts);
}

TEST(MarksModel, ATextThatStaysTheSameIsNoChange) {
  MadeText kept;
  MarksModel marks(kept);
  kept.open("{}");
  marks.set_scan("1");
  marks.edit(QStringLiteral("Mark"), [](Marks& now) { now.points.push_back({.name = "Mark 1"}); });
  int changes = 0;
  QObject::connect(&marks, &MarksModel::changed, [&changes] { ++changes; });
  kept.put("Scene", "{}");
  EXPECT_EQ(changes, 0);
  marks.edit(QStringLiteral("Nothing"), [](Marks&) {});
  EXPECT_EQ(kept.steps.size(), 1U) << "what changes nothing is no step";
  EXPECT_EQ(changes, 0);
  kept.undo();
  EXPECT_EQ(changes, 1);
  EXPECT_TRUE(marks.marks().points.empty());
  kept.put("Scene", "{ }");
  EXPECT_EQ(changes, 1);
}

TEST(MarksModel, ANewPlaceInThePipelineGetsThemToo) {
  MadeText kept;
  MarksModel marks(kept);
  kept.open("{}");
  marks.set_scan("one");
  marks.add(mark_at(1));
  const std::string text = kept.text("Marks");
  kept.open("{}");  // the pipeline was emptied
  EXPECT_EQ(kept.text("Marks"), text);
  EXPECT_EQ(marks.marks().points.size(), 1U);
}

TEST(MarksModel, TextThatCannotBeReadIsPutBackAndSaysWhy) {
  MadeText kept;
  MarksModel marks(kept);
  kept.open("{}");
  marks.set_scan("one");
  marks.add(mark_at(1));
  const std::string text = kept.text("Marks");
  QString why;
  QObject::connect(&marks, &MarksModel::refused, [&why](const QString& told) { why = told; });
  kept.put("Marks", "no marks at all");
  EXPECT_FALSE(why.isEmpty());
  EXPECT_EQ(kept.text("Marks"), text);
  EXPECT_EQ(marks.marks().points.size(), 1U);
}

}  // namespace
}  // namespace palpate::plugin
