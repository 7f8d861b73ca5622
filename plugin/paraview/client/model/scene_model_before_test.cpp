/// The scene as it was before the last edit, while a key is held.

#include <gmock/gmock.h>

#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/model/testing/made_text.h"

namespace palpate::plugin {
namespace {

using ::testing::SizeIs;

struct SceneModelBefore : ::testing::Test {
  SceneModelBefore() {
    model.open(modes::load_scene("ct-bone"));
    model.edit(QStringLiteral("Force"), force(1.5));
    model.edit(QStringLiteral("Force"), force(2.5));
  }
  static SceneModel::Change force(double newton) {
    return [newton](modes::Scene& scene) { scene.limits.force_n = newton; };
  }
  static SceneModel::Change stiffness(double n_per_m) {
    return [n_per_m](modes::Scene& scene) { scene.stiffness_n_per_m = n_per_m; };
  }
  double now() const { return model.scene().limits.force_n; }
  double kept_force() const { return modes::scene_from_json(kept.text("Scene"), "kept").limits.force_n; }

  MadeText kept;
  SceneModel model{kept};
};

TEST_F(SceneModelBefore, ItIsShownAndOfferedAndThePipelineKeepsThePresentOne) {
  std::vector<double> offered;
  model.set_commit([&](const modes::Scene& scene, Pace) { offered.push_back(scene.limits.force_n); });
  model.show_before();
  EXPECT_EQ(now(), 1.5);
  EXPECT_EQ(kept_force(), 2.5);
  model.show_before();
  EXPECT_EQ(now(), 1.5) << "not the one before that";
  model.show_now();
  EXPECT_EQ(now(), 2.5);
  model.show_now();
  EXPECT_THAT(offered, ::testing::ElementsAre(1.5, 2.5));
  EXPECT_THAT(kept.steps, SizeIs(2));
  EXPECT_EQ(kept.at, 2U);
}

TEST_F(SceneModelBefore, TheModelIsNotSettledWhileItIsShown) {
  EXPECT_TRUE(model.is_settled());
  model.show_before();
  EXPECT_FALSE(model.is_waiting());
  EXPECT_FALSE(model.is_settled());
  model.show_now();
  EXPECT_TRUE(model.is_settled());
  model.drag(force(1));
  EXPECT_TRUE(model.is_settled()) << "it is felt";
}

TEST_F(SceneModelBefore, AnEditIsMadeOnThePresentScene) {
  model.edit(QStringLiteral("Stiffness"), stiffness(650));
  model.show_before();
  EXPECT_NE(model.scene().stiffness_n_per_m, 650);
  model.edit(QStringLiteral("Force"), force(2));
  EXPECT_EQ(model.scene().stiffness_n_per_m, 650);
  EXPECT_EQ(now(), 2);
  model.show_now();
  EXPECT_EQ(now(), 2);
  EXPECT_EQ(kept_force(), 2);
  model.undo();
  EXPECT_EQ(now(), 2.5);
  EXPECT_EQ(model.scene().stiffness_n_per_m, 650);
}

TEST_F(SceneModelBefore, AMarkTakesNothingAway) {
  MarksModel marks(kept);
  marks.set_scan("one");
  model.show_before();
  marks.add(FeltMark());
  EXPECT_EQ(now(), 1.5);
  model.show_now();
  EXPECT_EQ(now(), 2.5);
  EXPECT_EQ(kept_force(), 2.5);
  EXPECT_THAT(marks.marks().points, SizeIs(1));
  model.show_before();
  EXPECT_EQ(now(), 1.5) << "a mark is no edit of the scene";
}

TEST_F(SceneModelBefore, UndoMeanwhileStays) {
  model.show_before();
  model.undo();
  EXPECT_EQ(now(), 1.5);
  model.show_now();
  EXPECT_EQ(now(), 1.5);
  EXPECT_EQ(kept_force(), 1.5);
  const double first = modes::load_scene("ct-bone").limits.force_n;
  ASSERT_NE(first, 1.5);
  model.show_before();
  EXPECT_EQ(now(), first) << "the last edit that is not undone";
  model.show_now();
  model.redo();
  EXPECT_EQ(now(), 2.5);
  model.show_before();
  EXPECT_EQ(now(), 1.5);
}

/// Far more edits than are remembered: the scene before the last of them is always known.
TEST_F(SceneModelBefore, AfterAnyNumberOfEditsItIsTheOneBeforeTheLast) {
  for (int n = 0; n < 50; ++n) {
    const double before = now(), after = 1 + n / 64.0;
    model.edit(QStringLiteral("Force"), force(after));
    model.show_before();
    EXPECT_EQ(now(), before) << n;
    model.show_now();
    EXPECT_EQ(now(), after) << n;
  }
}

/// A filter takes long, and with another mapping the hand would be elsewhere.
TEST_F(SceneModelBefore, FilterAndMappingStay) {
  io::Filter filter;
  filter.type = io::find_filter_type("gaussian");
  ASSERT_NE(filter.type, nullptr);
  model.edit(QStringLiteral("Filter"), [&](modes::Scene& scene) { scene.filter = filter; });
  model.edit(QStringLiteral("Clutch"), [](modes::Scene& scene) { scene.workspace.center_mm = {1, 2, 3}; });
  model.show_before();
  EXPECT_EQ(now(), 1.5);
  EXPECT_EQ(model.scene().filter, filter);
  EXPECT_EQ(model.scene().workspace.center_mm, glm::dvec3(1, 2, 3));
}

TEST_F(SceneModelBefore, WithoutAnEditThereIsNone) {
  model.forget_steps();
  model.show_before();
  EXPECT_EQ(now(), 2.5);
}

TEST_F(SceneModelBefore, WhatWritesToThePipelineWritesThePresentScene) {
  model.show_before();
  model.put_back();
  EXPECT_EQ(kept_force(), 2.5);
  kept.take_away();
  model.reopen();
  EXPECT_EQ(kept_force(), 2.5);
}

TEST_F(SceneModelBefore, AnotherScanEndsIt) {
  model.show_before();
  model.drop_waiting();
  EXPECT_EQ(now(), 2.5);
  model.edit(QStringLiteral("Force"), force(2));
  model.show_before();
  model.propose(modes::load_scene("ct-chest"));
  model.show_now();
  EXPECT_EQ(model.scene().name, modes::load_scene("ct-chest").name);
}

/// The key was let go, but what is shown stays as long as the latest scene cannot be read: nobody waits for that.
TEST_F(SceneModelBefore, WhatStaysBecauseTheLatestCannotBeReadIsNotHeld) {
  std::function<void(const QString&)> done;
  bool is_read = false;
  model.set_read([&](const modes::Scene& scene, auto then) {
    if (is_read || scene.limits.force_n != 2.5) return false;
    done = std::move(then);
    return true;
  });
  model.show_before();
  EXPECT_FALSE(model.is_settled());
  for (int n = 0; n < 2; ++n) {
    model.show_now();
    ASSERT_TRUE(done);
    EXPECT_FALSE(model.is_settled()) << "it is on its way back";
    std::exchange(done, nullptr)(QStringLiteral("the segment is gone"));
    EXPECT_EQ(now(), 1.5);
    EXPECT_TRUE(model.shows_before());
    EXPECT_EQ(model.latest().limits.force_n, 2.5);
    EXPECT_TRUE(model.is_settled());
  }
  model.edit(QStringLiteral("Stiffness"), stiffness(650));
  ASSERT_TRUE(done);
  EXPECT_FALSE(model.is_settled());
  is_read = true;
  std::exchange(done, nullptr)({});
  EXPECT_EQ(now(), 2.5);
  EXPECT_EQ(model.scene().stiffness_n_per_m, 650);
  EXPECT_FALSE(model.shows_before());
  EXPECT_TRUE(model.is_settled());
}

/// The key is let go while the files of the earlier scene are being read.
TEST_F(SceneModelBefore, ItWaitsForFilesAndSoDoesWhatComesAfterIt) {
  std::function<void(const QString&)> done;
  bool is_read = false;
  model.set_read([&](const modes::Scene& scene, auto then) {
    if (is_read || scene.limits.force_n != 1.5) return false;
    done = std::move(then);
    return true;
  });
  model.show_before();
  EXPECT_EQ(now(), 2.5);
  model.edit(QStringLiteral("Stiffness"), stiffness(650));
  model.show_now();
  ASSERT_TRUE(done);
  is_read = true;
  done({});
  EXPECT_EQ(now(), 2.5);
  EXPECT_EQ(model.scene().stiffness_n_per_m, 650);
  EXPECT_FALSE(model.is_waiting());
  model.show_before();
  EXPECT_NE(model.scene().stiffness_n_per_m, 650);
}

}  // namespace
}  // namespace palpate::plugin
