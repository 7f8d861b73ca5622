// The clutch of a session's hand, and the mapping that it changes: what is felt meanwhile and where it ends.

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/testing/controlled_session.h"
#include "plugin/paraview/client/words.h"
#include "plugin/session/session.h"

namespace palpate::plugin {
namespace {

using testing::comes;
using testing::ControlledSession;
using ::testing::IsEmpty;

/// The stylus stays at its place in the patient, however the hand goes and the workspace is turned meanwhile.
TEST_F(ControlledSession, AClutchedHandLeavesTheStylusWhereItIs) {
  const glm::dmat3 turned = glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))));
  for (const bool felt : {false, true}) {
    SCOPED_TRACE(felt);
    connect_simulated();
    ASSERT_TRUE(goes_to(outside));
    if (felt) session.feel();
    ASSERT_TRUE(comes([&] { return last().feels == felt; }));
    EXPECT_FALSE(session.is_clutched());
    session.clutch();
    EXPECT_TRUE(session.is_clutched());
    const glm::dvec3 stays = last().probe_mm;
    ASSERT_TRUE(comes([this] { return last().clutched && !last().feels; }));
    EXPECT_TRUE(session.may_remap());
    session.press_mark();
    session.move_hand(outside + glm::dvec3(15, 5, 0));
    const double before = last().tick.probe_m[0];
    ASSERT_TRUE(comes([&] { return std::abs(last().tick.probe_m[0] - before) > 0.0145; }));
    polls(15);  // until it rests
    EXPECT_EQ(last().probe_mm, stays);
    EXPECT_EQ(last().proxy_mm, stays);
    EXPECT_THAT(marks, IsEmpty());
    session.unclutch(turned);
    EXPECT_FALSE(session.is_clutched());
    polls(5);
    EXPECT_LT(glm::distance(last().probe_mm, stays), 1.5) << "the hand trembles";
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(glm::distance(last().workspace.rotation[axis], turned[axis]), 1e-6);
    }
    EXPECT_TRUE(comes([&] { return last().feels == felt; }));
    session.disconnect_stylus();
    model.open(modes::load_scene("ct-skin-and-bone"));
  }
}

TEST_F(ControlledSession, AClutchThatIsReleasedStaysWithoutAForce) {
  connect_simulated();
  ASSERT_TRUE(goes_to(outside));
  session.feel();
  ASSERT_TRUE(comes([this] { return last().feels; }));
  session.clutch();
  session.release();
  session.unclutch(last().workspace.rotation);
  polls(5);
  EXPECT_FALSE(last().feels);
  session.unclutch(last().workspace.rotation);  // nothing to end
  EXPECT_FALSE(session.is_clutched());
}

TEST_F(ControlledSession, TheMappingStaysWhileAForceIsFelt) {
  EXPECT_TRUE(session.may_remap());
  connect_simulated();
  ASSERT_TRUE(goes_to(outside));
  EXPECT_TRUE(session.may_remap());
  session.feel();
  session.move_hand(inside);
  ASSERT_TRUE(pushes());
  EXPECT_FALSE(session.may_remap());
  session.move_hand(outside);
  ASSERT_TRUE(comes([this] { return last().force_n == 0; }));
  EXPECT_FALSE(session.may_remap()) << "a surface may lie on the way";
  session.release();
  EXPECT_TRUE(comes([this] { return session.may_remap(); }));
}

/// The hand went through the ball to its other side. The stylus has not moved, so there is nothing to feel.
TEST_F(ControlledSession, NothingIsFeltWhereAClutchEnds) {
  connect_simulated();
  ASSERT_TRUE(goes_to(outside));
  session.feel();
  ASSERT_TRUE(comes([this] { return last().feels; }));
  session.clutch();
  ASSERT_TRUE(comes([this] { return !last().feels && last().force_n == 0; }));
  session.move_hand(-outside);
  ASSERT_TRUE(comes(
      [this] { return glm::distance(last().workspace.to_patient(vector_of(last().tick.probe_m)), -outside) < 2; }));
  polls(15);  // until it rests
  double strongest_n = 0, farthest_mm = 0;
  const auto watched = QObject::connect(&session, &SessionController::polled, [&](const SessionStatus& status) {
    strongest_n = std::max(strongest_n, status.peak_n);
    farthest_mm = std::max(farthest_mm, glm::distance(status.probe_mm, outside));
  });
  session.unclutch(last().workspace.rotation);
  ASSERT_TRUE(comes([this] { return last().feels; }));
  polls(30);  // longer than a scene's ramp
  QObject::disconnect(watched);
  EXPECT_LT(strongest_n, 0.05);
  EXPECT_LT(farthest_mm, 2);
}

/// By an edit, its undo, or any other scene: the stylus slides to its new place, and a surface on its way would push.
TEST_F(ControlledSession, AMappingThatChangesTakesTheForce) {
  connect_simulated();
  const auto shift = [scale = last().workspace.mm_per_m / 1e3](modes::Scene& scene) {
    scene.workspace.center_mm = {0, 8, 0};
    scene.workspace.scale = scale;
    scene.workspace.fit = false;
  };
  const std::pair<const char*, std::function<void()>> changes[] = {
      {"an edit", [&] { model.edit(QStringLiteral("Shift"), shift); }}, {"its undo", [&] { model.undo(); }}};
  for (const auto& [what, change] : changes) {
    SCOPED_TRACE(what);
    ASSERT_TRUE(goes_to(outside));
    session.feel();
    session.move_hand(inside);
    ASSERT_TRUE(pushes());
    polls(5);
    const double before_n = last().force_n;
    double strongest_n = 0;
    const auto watched = QObject::connect(&session, &SessionController::polled, [&](const SessionStatus& status) {
      strongest_n = std::max(strongest_n, status.peak_n);
    });
    change();
    ASSERT_TRUE(comes([this] { return !last().feels && last().force_n == 0; }));
    polls(20);
    QObject::disconnect(watched);
    EXPECT_LT(strongest_n, before_n + 0.1);
    EXPECT_EQ(last().force_n, 0);
  }
  // What leaves the mapping as it is leaves the force, too.
  ASSERT_TRUE(goes_to(outside));
  session.feel();
  ASSERT_TRUE(comes([this] { return last().feels; }));
  model.edit(QStringLiteral("Limit"), [](modes::Scene& scene) { scene.limits.force_n *= 0.9; });
  polls(5);
  EXPECT_TRUE(last().feels);
}

/// The next step of its scene waits for files, until done() is called.
struct ClutchOfASlowScene : ControlledSession {
  /// Whether the hand is parted from a patient that was felt.
  bool clutches() {
    connect_simulated();
    if (!goes_to(outside)) return false;
    session.feel();
    if (!comes([this] { return last().feels; })) return false;
    reads = true;
    done = nullptr;
    model.set_read([this](const modes::Scene&, auto then) {
      if (reads) done = then;
      return reads;
    });
    session.clutch();
    return comes([this] { return !last().feels; });
  }

  std::function<void(const QString&)> done;
  bool reads = true;
};

/// The clutch's own step waits for structures that are being read; so does the force.
TEST_F(ClutchOfASlowScene, AClutchEndsWhenItsStepDoes) {
  for (const bool refused : {false, true}) {
    SCOPED_TRACE(refused);
    ASSERT_TRUE(clutches());
    session.unclutch(last().workspace.rotation);
    polls(5);
    EXPECT_TRUE(session.is_clutched());
    EXPECT_FALSE(last().feels);
    told.clear();
    reads = false;
    done(refused ? QStringLiteral("it cannot be read") : QString());
    EXPECT_FALSE(session.is_clutched());
    if (refused) {
      polls(5);
      EXPECT_FALSE(last().feels);
      EXPECT_THAT(told, ::testing::ElementsAre(std::pair("it cannot be read", true)));
    } else {
      EXPECT_TRUE(comes([this] { return last().feels; }));
    }
    session.disconnect_stylus();
  }
}

/// The key is down again before the step of the first clutch is done: hand and patient stay apart until it is let go.
TEST_F(ClutchOfASlowScene, AClutchThatIsPressedAgainBeforeItEndsGoesOn) {
  for (const bool refused : {false, true}) {
    SCOPED_TRACE(refused);
    ASSERT_TRUE(clutches());
    const glm::dvec3 stays = last().probe_mm;
    session.unclutch(last().workspace.rotation);
    ASSERT_TRUE(done);
    session.clutch();
    reads = false;
    done(refused ? QStringLiteral("it cannot be read") : QString());
    EXPECT_TRUE(session.is_clutched());
    polls(5);
    EXPECT_TRUE(session.is_clutched());
    EXPECT_FALSE(last().feels);
    EXPECT_EQ(last().probe_mm, stays);
    session.unclutch(last().workspace.rotation);
    EXPECT_FALSE(session.is_clutched());
    EXPECT_TRUE(comes([this] { return last().feels; }));
    session.disconnect_stylus();
  }
}

TEST_F(ControlledSession, AnotherScanEndsTheClutch) {
  connect_simulated();
  ASSERT_TRUE(goes_to(outside));
  session.clutch();
  session.set_scan(igtl::testing::ball_of_tissue(), {});
  EXPECT_TRUE(session.is_clutched()) << "another frame of the same scan is where it was";
  session.expect_scan();
  session.set_scan(igtl::testing::ball_of_tissue(), {});
  EXPECT_FALSE(session.is_clutched());
}

TEST_F(ControlledSession, WhatKeepsTheForceOffEndsItAndRefusesTheNext) {
  connect_simulated();
  session.feel();
  ASSERT_TRUE(comes([this] { return last().feels; }));
  session.keep_off("a dialog is open");
  ASSERT_TRUE(comes([this] { return !last().feels; }));
  EXPECT_EQ(last().kept_off, QStringLiteral("a dialog is open"));
  told.clear();
  session.feel();
  polls(3);
  EXPECT_FALSE(last().feels);
  EXPECT_THAT(told, ::testing::ElementsAre(std::pair("a dialog is open", true)));
  session.keep_off({});
  polls(3);
  EXPECT_FALSE(last().feels) << "only a press turns it on";
  session.feel();
  EXPECT_TRUE(comes([this] { return last().feels && last().kept_off.isEmpty(); }));
  // The same reason again is no new reason to let go.
  session.keep_off({});
  polls(3);
  EXPECT_TRUE(last().feels);
  session.expect_scan();
  polls(2);
  EXPECT_EQ(last().kept_off, words(say("scan-is-still-being-read")));
}

}  // namespace
}  // namespace palpate::plugin
