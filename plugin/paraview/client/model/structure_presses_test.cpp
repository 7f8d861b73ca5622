#include "plugin/paraview/client/model/structure_presses.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/testing/made_text.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct StructuresPressed : ::testing::Test {
  StructuresPressed() { model.open(modes::Scene{}); }

  /// As a button of a row: what is chosen is the structure then.
  void press(const std::string& structure) {
    presses.press(QString::fromStdString(structure),
                  [structure](modes::Scene& scene) {
                    scene.structures.push_back({.name = structure, .file = structure + ".dcm", .segment = "1"});
                  },
                  {});
  }
  std::vector<std::string> named() const {
    std::vector<std::string> names;
    for (const modes::SceneStructure& one : model.scene().structures) names.push_back(one.name);
    return names;
  }

  MadeText kept;
  SceneModel model{kept};
  std::vector<std::function<void(const QString&)>> reading;
  std::vector<std::size_t> read_for;  // so many structures
  std::vector<std::string> told;
  StructurePresses presses{model,
                           [this](const modes::Scene& edited, auto done) {
                             read_for.push_back(edited.structures.size());
                             reading.push_back(std::move(done));
                           },
                           [this](const QString& text, bool) { told.push_back(text.toStdString()); }};
};

TEST_F(StructuresPressed, EachPressIsDoneForWhatWasChosenThen) {
  press("liver");
  press("ORANGE");
  press("spleen");
  ASSERT_EQ(reading.size(), 1U) << "one after the other";
  EXPECT_THAT(named(), IsEmpty());
  for (int n = 0; n < 3; ++n) reading.back()({});
  EXPECT_THAT(named(), ElementsAre("liver", "ORANGE", "spleen"));
  EXPECT_THAT(read_for, ElementsAre(1U, 2U, 3U)) << "each with those before it";
  EXPECT_EQ(kept.steps.size(), 3U);
  EXPECT_FALSE(presses.is_busy());
  model.undo();
  EXPECT_THAT(named(), ElementsAre("liver", "ORANGE"));
}

TEST_F(StructuresPressed, OneThatCannotBeReadDoesNotKeepTheNextFromBeingDone) {
  press("liver");
  press("ORANGE");
  reading.back()(QStringLiteral("liver.dcm is no structure"));
  EXPECT_THAT(told, ElementsAre("liver.dcm is no structure"));
  reading.back()({});
  EXPECT_THAT(named(), ElementsAre("ORANGE"));
}

TEST_F(StructuresPressed, OneThatIsRefusedSaysWhyBesideTheButton) {
  QString elsewhere;
  QObject::connect(&model, &SceneModel::refused, [&](const QString& why) { elsewhere = why; });
  model.set_commit([](const modes::Scene&, Pace) { throw std::runtime_error("it cannot be felt"); });
  press("liver");
  reading.back()({});
  EXPECT_THAT(named(), IsEmpty());
  EXPECT_THAT(told, ElementsAre("it cannot be felt"));
  EXPECT_TRUE(elsewhere.isEmpty());
}

TEST_F(StructuresPressed, WhatWasPressedForAnotherScanIsNotDone) {
  press("liver");
  press("ORANGE");
  presses.drop();
  reading.front()({});
  EXPECT_THAT(named(), IsEmpty());
  press("spleen");
  reading.front()({});
  EXPECT_THAT(named(), IsEmpty()) << "that was the answer to the first";
  reading.back()({});
  EXPECT_THAT(named(), ElementsAre("spleen"));
}

}  // namespace
}  // namespace palpate::plugin
