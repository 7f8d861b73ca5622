/// Changes of the scene that need files to be read first.

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/model/shown_mode.h"
#include "plugin/paraview/client/model/testing/made_text.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct SceneModelReading : ::testing::Test {
  SceneModelReading() {
    model.open(modes::Scene{});
    model.set_read([this](const modes::Scene& scene, auto done) {
      if (std::exchange(is_read, false) || scene.structures.empty()) return false;
      read_for.push_back(scene.structures.size());
      reading.push_back(std::move(done));
      return true;
    });
    QObject::connect(&model, &SceneModel::refused,
                     [this](const QString& why) { refused.push_back(why.toStdString()); });
  }

  static SceneModel::Change adding(const std::string& structure) {
    return [structure](modes::Scene& scene) {
      scene.structures.push_back({.name = structure, .file = structure + ".dcm", .segment = "1"});
    };
  }
  static SceneModel::Change force(double newton) {
    return [newton](modes::Scene& scene) { scene.limits.force_n = newton; };
  }
  /// As a button of a row: what is chosen is the structure then.
  void press(const std::string& structure) {
    model.edit(QString::fromStdString(structure), adding(structure),
               [this](const QString& why) { told.push_back(why.toStdString()); });
  }
  void answer(std::size_t which) {
    is_read = true;
    reading.at(which)({});
    is_read = false;
  }
  void answer() { answer(reading.size() - 1); }
  std::vector<std::string> named() const {
    std::vector<std::string> names;
    for (const modes::SceneStructure& one : model.scene().structures) names.push_back(one.name);
    return names;
  }

  MadeText kept;
  SceneModel model{kept};
  bool is_read = false;  // what the change that is asked about next needs
  std::vector<std::function<void(const QString&)>> reading;
  std::vector<std::size_t> read_for;  // so many structures
  std::vector<std::string> told, refused;
};

TEST_F(SceneModelReading, EachPressIsDoneForWhatWasChosenThen) {
  press("liver");
  press("ORANGE");
  press("spleen");
  ASSERT_EQ(reading.size(), 1U) << "one after the other";
  EXPECT_TRUE(model.is_waiting());
  EXPECT_FALSE(model.is_settled());
  EXPECT_THAT(named(), IsEmpty());
  for (int n = 0; n < 3; ++n) answer();
  EXPECT_THAT(named(), ElementsAre("liver", "ORANGE", "spleen"));
  EXPECT_THAT(read_for, ElementsAre(1U, 2U, 3U)) << "each with those before it";
  EXPECT_EQ(kept.steps.size(), 3U);
  EXPECT_FALSE(model.is_waiting());
  EXPECT_TRUE(model.is_settled());
  EXPECT_THAT(told, ElementsAre("", "", ""));
}

TEST_F(SceneModelReading, OneThatCannotBeReadDoesNotKeepTheNextFromBeingDone) {
  press("liver");
  press("ORANGE");
  reading.back()(QStringLiteral("liver.dcm is no structure"));
  EXPECT_THAT(told, ElementsAre("liver.dcm is no structure"));
  answer();
  EXPECT_THAT(named(), ElementsAre("ORANGE"));
}

TEST_F(SceneModelReading, OneThatIsRefusedSaysWhyBesideTheButton) {
  model.set_commit([](const modes::Scene&, Pace) { throw std::runtime_error("it cannot be felt"); });
  press("liver");
  answer();
  EXPECT_THAT(named(), IsEmpty());
  EXPECT_THAT(told, ElementsAre("it cannot be felt"));
  EXPECT_THAT(refused, IsEmpty());
}

/// A press on a row is for the boundary that it showed, wherever that is when its turn comes.
TEST_F(SceneModelReading, AChangeOfABoundaryIsOfTheOneThatWasShown) {
  modes::Scene scene = modes::load_scene("ct-bone");
  scene.modes.resize(1);
  const modes::Mode one = scene.modes.front();
  scene.modes.assign(4, one);
  const char* const names[] = {"skin", "bone", "lung", "air"};
  for (std::size_t n = 0; n < 4; ++n) scene.modes[n].name = names[n];
  model.open(scene);
  const auto remove = [this](std::size_t n) {
    model.edit(
        QStringLiteral("Remove"),
        [shown = ShownMode(model, n)](modes::Scene& now) {
          now.modes.erase(now.modes.begin() + static_cast<std::ptrdiff_t>(shown.in(now)));
        },
        [this](const QString& why) { told.push_back(why.toStdString()); });
  };
  const auto switch_off = [this](std::size_t n) {
    model.edit_mode(
        QStringLiteral("Switch off"), n, [](modes::Mode& mode) { mode.enabled = false; },
        [this](const QString& why) { told.push_back(why.toStdString()); });
  };
  press("liver");
  remove(1);
  remove(1);      // it still stands in its row
  switch_off(2);  // lung
  switch_off(1);
  while (model.is_waiting()) answer();
  std::vector<std::pair<std::string, bool>> left;
  for (const modes::Mode& mode : model.scene().modes) left.emplace_back(mode.name, mode.enabled);
  EXPECT_THAT(left, ElementsAre(std::pair("skin", true), std::pair("lung", false), std::pair("air", true)));
  const std::string gone = say("boundary-is-another-one", "bone");
  EXPECT_THAT(told, ElementsAre("", "", gone, "", gone));
}

/// The scan became another frame meanwhile: what was read is of the one before.
TEST_F(SceneModelReading, WhatIsNotReadyWhenItWasReadIsReadAgain) {
  press("liver");
  reading.back()({});
  EXPECT_THAT(named(), IsEmpty());
  ASSERT_EQ(reading.size(), 2U);
  answer();
  EXPECT_THAT(named(), ElementsAre("liver"));
}

TEST_F(SceneModelReading, WhatWasPressedForAnotherScanIsNotDone) {
  press("liver");
  press("ORANGE");
  model.drop_waiting();
  EXPECT_FALSE(model.is_waiting());
  answer(0);
  EXPECT_THAT(named(), IsEmpty());
  press("spleen");
  answer(0);
  EXPECT_THAT(named(), IsEmpty()) << "that was the answer to the first";
  answer(1);
  EXPECT_THAT(named(), ElementsAre("spleen"));
}

/// A mouse moves faster than files are read: only where it is now counts, and the step is its last place.
/// A scene from the pipeline is no press: it is taken, whatever was dropped before it.
TEST_F(SceneModelReading, ASceneOfThePipelineIsTakenWhereThePressBeforeItIsDropped) {
  press("liver");
  modes::Scene scene;
  scene.name = "from a script";
  kept.put("Scene", modes::to_json(scene));
  ASSERT_NE(model.scene().name, "from a script") << "it waits";
  model.drop_waiting();
  EXPECT_EQ(model.scene().name, "from a script");
  EXPECT_THAT(named(), IsEmpty());
}

TEST_F(SceneModelReading, OfADragThatWaitsOnlyTheNewestPlaceIsDone) {
  press("liver");
  std::vector<Pace> paces;
  QObject::connect(&model, &SceneModel::changed, [&](Pace pace) { paces.push_back(pace); });
  int asked = 0;
  for (const double newton : {1.0, 1.1, 1.2}) {
    model.drag([&, newton](modes::Scene& scene) {
      ++asked;
      scene.limits.force_n = newton;
    });
  }
  model.finish_drag(QStringLiteral("Drag"));
  EXPECT_EQ(asked, 0);
  is_read = true;
  reading.back()({});
  is_read = true;  // the drag's scene has the structure, too
  if (model.is_waiting()) reading.back()({});
  EXPECT_EQ(model.scene().limits.force_n, 1.2);
  EXPECT_THAT(paces, ElementsAre(Pace::stepped, Pace::dragged));
  ASSERT_EQ(kept.steps.size(), 2U);
  EXPECT_EQ(modes::scene_from_json(kept.text("Scene"), "kept").limits.force_n, 1.2);
}

/// Undo and Redo bring back scenes that name structures: these wait like the rest, and stay the pipeline's own steps.
TEST_F(SceneModelReading, ASceneOfThePipelineWaitsToo) {
  press("liver");
  answer();
  model.undo();
  EXPECT_THAT(named(), IsEmpty()) << "nothing is to be read for it";
  model.redo();
  EXPECT_THAT(named(), IsEmpty());
  model.edit(QStringLiteral("Force"), force(2));
  EXPECT_NE(model.scene().limits.force_n, 2) << "it is done after the scene that waits";
  answer();
  if (model.is_waiting()) answer();
  EXPECT_THAT(named(), ElementsAre("liver"));
  EXPECT_EQ(model.scene().limits.force_n, 2);
}

TEST_F(SceneModelReading, AnotherScanDropsPressesAndKeepsThePipelinesScene) {
  press("liver");
  answer();
  model.undo();
  model.redo();
  press("spleen");
  model.drop_waiting();
  answer();
  EXPECT_THAT(named(), ElementsAre("liver"));
}

TEST_F(SceneModelReading, AScenesTextThatCannotBeReadIsPutBack) {
  press("liver");
  answer();
  model.undo();
  const std::string before = kept.text("Scene");
  model.redo();
  reading.back()(QStringLiteral("liver.dcm is gone"));
  EXPECT_THAT(refused, ElementsAre("liver.dcm is gone"));
  EXPECT_THAT(named(), IsEmpty());
  EXPECT_EQ(kept.text("Scene"), before);
}

}  // namespace
}  // namespace palpate::plugin
