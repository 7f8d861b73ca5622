// The simulated hand of a session and its marks, in the patient.

#include <gmock/gmock.h>

#include <chrono>
#include <functional>
#include <thread>
#include <variant>

#include "device/safety/safety_filter.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/testing/controlled_session.h"
#include "plugin/paraview/client/words.h"
#include "plugin/session/session.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

using testing::comes;
using testing::ControlledSession;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST_F(ControlledSession, TheHandIsWhereItIsMovedAndFeelsWhatIsThere) {
  EXPECT_FALSE(session.has_simulated());
  EXPECT_FALSE(session.takes_mouse());
  EXPECT_FALSE(last().is_seen());
  connect_simulated();
  EXPECT_TRUE(session.has_simulated());
  EXPECT_TRUE(session.takes_mouse());
  EXPECT_TRUE(last().is_seen());
  ASSERT_TRUE(goes_to(outside));
  EXPECT_EQ(session.hand_mm(), outside);
  EXPECT_FALSE(last().feels);
  ASSERT_TRUE(goes_to(inside));
  EXPECT_EQ(last().force_n, 0) << "forces are not on yet";
  ASSERT_TRUE(goes_to(outside));
  session.feel();
  ASSERT_TRUE(comes([this] { return last().feels; }));
  session.move_hand(inside);
  ASSERT_TRUE(pushes());
  EXPECT_LT(glm::length(last().probe_mm), glm::length(last().proxy_mm)) << "held at the skin";
  EXPECT_NEAR(glm::length(last().proxy_mm), 25, 1);
  EXPECT_GE(last().peak_n, last().force_n);
  EXPECT_GT(last().tick_us, 0);
  EXPECT_THAT(last().held, ::testing::HasSubstr("kin"));
  EXPECT_EQ(last().tissue, "between tissues");
  session.let_go();
  EXPECT_NE(session.hand_mm(), inside);
  EXPECT_TRUE(comes([this] { return last().force_n < 0.02; })) << "the simulated hand relaxes";
  EXPECT_TRUE(last().feels) << "the forces stay on";
  // A hand that has relaxed stays where it is until it is moved.
  polls(3);
  ASSERT_TRUE(goes_to(outside));
  polls(3);
  EXPECT_TRUE(is_near(outside));
}

TEST_F(ControlledSession, TheMouseIsTheHandsOnlyWhereNothingElseWantsIt) {
  session.keep_mouse_off(true);
  connect_simulated();
  EXPECT_FALSE(session.takes_mouse());
  session.keep_mouse_off(false);
  EXPECT_TRUE(session.takes_mouse());
  session.disconnect_stylus();
  EXPECT_FALSE(session.takes_mouse());
  EXPECT_FALSE(session.has_simulated());
}

TEST_F(ControlledSession, ASimulatedStylusBeginsAtTheStartUnlessItIsFelt) {
  glm::dvec3 start = outside;
  session.set_start([&start](const device::Specification& of) {
    EXPECT_GT(of.maximum_force, 0);
    return start;
  });
  connect_simulated();
  EXPECT_TRUE(comes([&] { return is_near(outside); }));
  const glm::dvec3 elsewhere{30, 0, 0};
  ASSERT_TRUE(goes_to(elsewhere));
  session.begin_outside();
  EXPECT_TRUE(comes([&] { return is_near(outside); }));
  // Where another scan is expected it waits for it.
  ASSERT_TRUE(goes_to(elsewhere));
  start = {0, 0, 32};
  session.expect_scan();
  session.begin_outside();
  polls(3);
  EXPECT_TRUE(is_near(elsewhere));
  session.set_scan(igtl::testing::ball_of_tissue(), {});
  EXPECT_TRUE(comes([&] { return is_near(start); }));
  // Once alone: a scan that was not announced leaves the hand where it is.
  ASSERT_TRUE(goes_to(elsewhere));
  session.set_scan(igtl::testing::ball_of_tissue(), {});
  polls(5);
  EXPECT_TRUE(is_near(elsewhere));
  // And no hand that feels is moved.
  session.feel();
  ASSERT_TRUE(comes([this] { return last().feels; }));
  session.begin_outside();
  polls(5);
  EXPECT_TRUE(is_near(elsewhere));
}

/// Another scan lies elsewhere in the patient, and so does the stylus then.
TEST_F(ControlledSession, TheHandIsMappedIntoTheScanThatIsFelt) {
  connect_simulated();
  ASSERT_TRUE(goes_to(outside));
  const glm::dvec3 center{400, -300, 200};
  session.set_scan(std::make_shared<const io::Volume>(testdata::scan(
                       testdata::make_sphere(25), testdata::make_geometry({.size = glm::ivec3(60), .center = center}))),
                   {});
  ASSERT_TRUE(
      comes([this] { return last().tick.scene_epoch == session.live().epoch() && last().tick.change_part == 1; }));
  EXPECT_EQ(last().workspace, session.live().plan()->workspace);
  EXPECT_LT(glm::distance(last().workspace.center_mm, center), 100);
}

/// The keys move the hand from where the stylus is now, which is not where the hand was under the mapping before.
TEST_F(ControlledSession, AfterAnotherMappingTheHandIsWhereTheStylusIs) {
  connect_simulated();
  const auto shift = [now = last().workspace](modes::Scene& scene) {
    scene.workspace.center_mm = now.center_mm + glm::dvec3(0, 8, 0);
    scene.workspace.scale = now.mm_per_m / 1e3;
    scene.workspace.rotation = now.rotation;
    scene.workspace.fit = false;
  };
  const std::pair<const char*, std::function<void()>> changes[] = {
      {"an edit", [&] { model.edit(QStringLiteral("Shift"), shift); }},
      {"its undo", [&] { model.undo(); }},
      {"its redo", [&] { model.redo(); }}};
  for (const auto& [what, change] : changes) {
    SCOPED_TRACE(what);
    ASSERT_TRUE(goes_to(outside));
    EXPECT_EQ(session.hand_mm(), outside);
    change();
    ASSERT_TRUE(
        comes([this] { return last().tick.scene_epoch == session.live().epoch() && last().tick.change_part == 1; }));
    const glm::dvec3 stylus = last().probe_mm;
    EXPECT_GT(glm::distance(stylus, outside), 5);
    EXPECT_EQ(session.hand_mm(), stylus);
    session.move_hand(session.hand_mm() + glm::dvec3(1, 0, 0));
    polls(15);
    EXPECT_LT(glm::distance(last().probe_mm, stylus), 3) << "a step of 1 mm, and the hand trembles";
  }
}

/// The work that the force was taken for is named until the fault is cleared, and not with the next.
TEST_F(ControlledSession, TheWorkThatHeldThePanelUpIsNamed) {
  session.set_clock([](double period_s) {
    return std::make_unique<testing::UnhurriedClock>(period_s, testing::UnhurriedClock::WithoutHeartbeat::goes_on);
  });
  connect_simulated();
  // No event is handled, so no heartbeat comes, until the servo has noticed.
  const auto falls_silent = [this] {
    session.feel();
    if (!comes([this] { return last().feels; })) return false;
    for (int n = 0; n < 60000; ++n) {
      TickRecord tick;
      const TickRing& ring = *session.live().ticks();
      if (ring.read(ring.written() - 1, tick) && fault_of(tick) == device::Fault::commander_silent) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  };
  const auto is_told = [this] {
    return comes([this] { return fault_of(last().tick) == device::Fault::commander_silent; });
  };
  ASSERT_TRUE(falls_silent());
  session.note_work("drawing", 2.6);
  ASSERT_TRUE(is_told());
  EXPECT_EQ(last().held_up.toStdString(), "drawing took 2.6 s");
  std::this_thread::sleep_for(std::chrono::milliseconds(4200));
  polls(2);
  EXPECT_EQ(last().held_up.toStdString(), "drawing took 2.6 s") << "as long as the fault is said";
  session.clear_fault();
  ASSERT_TRUE(comes([this] { return fault_of(last().tick) == device::Fault::none; }));
  EXPECT_TRUE(last().held_up.isEmpty());
  ASSERT_TRUE(falls_silent() && is_told());
  EXPECT_TRUE(last().held_up.isEmpty()) << "it is not known what held it up";
}

/// The panel's button and a place that is pressed at once.
TEST_F(ControlledSession, APressOfThePanelsButtonIsAMarkOfWhatIsFelt) {
  session.press_mark();  // nothing: there is no stylus
  connect_simulated();
  ASSERT_TRUE(goes_to(outside));
  session.feel();
  session.move_hand(inside);
  ASSERT_TRUE(pushes());
  EXPECT_THAT(marks, IsEmpty());
  const FeltMark here = session.mark_here();
  EXPECT_LT(glm::distance(here.position_mm, last().proxy_mm), 1e-9);
  EXPECT_THAT(here.boundary, ::testing::HasSubstr("kin"));
  EXPECT_GT(here.force_n, 0.1);
  session.press_mark();
  session.let_go_mark();
  ASSERT_TRUE(comes([this] { return !marks.empty(); }));
  ASSERT_TRUE(std::holds_alternative<FeltMark>(marks[0]));
  const auto& mark = std::get<FeltMark>(marks[0]);
  EXPECT_NEAR(glm::length(mark.position_mm), 25, 1);
  EXPECT_EQ(mark.boundary, here.boundary);
  polls(5);
  EXPECT_THAT(marks, SizeIs(1)) << "one press, one mark";
}

TEST_F(ControlledSession, AButtonThatIsHeldWhileTheHandGoesMakesAPath) {
  connect_simulated();
  ASSERT_TRUE(goes_to(outside));
  session.press_mark();
  ASSERT_TRUE(goes_to({20, -32, 0}));
  polls(10);  // more than a quarter of a second
  EXPECT_THAT(marks, IsEmpty()) << "it is still held";
  session.let_go_mark();
  ASSERT_TRUE(comes([this] { return !marks.empty(); }));
  ASSERT_TRUE(std::holds_alternative<MarkedPath>(marks[0]));
  const auto& path = std::get<MarkedPath>(marks[0]);
  EXPECT_GT(path.length_mm, 19) << "and the hand trembles";
  EXPECT_LT(glm::distance(path.points_mm.front(), outside), 2);
  EXPECT_LT(glm::distance(path.points_mm.back(), glm::dvec3(20, -32, 0)), 2);
}

/// A press that begins on one stylus, scan or session and would end on another is none.
TEST_F(ControlledSession, APressThatIsCutOffMakesNoMark) {
  const std::string file = testing::fresh_path("cut-off-press.h5").string();
  const std::pair<const char*, std::function<void()>> cuts[] = {
      {"another stylus", [this] { session.disconnect_stylus(), session.connect_stylus({.device = "simulated"}); }},
      {"connected again", [this] { session.connect_stylus({.device = "simulated"}); }},
      {"another scan", [this] { session.set_scan(igtl::testing::ball_of_tissue(), {}); }},
      {"a recording", [this, &file] { session.record(file); }},
      {"the clutch", [this] { session.clutch(), session.unclutch(session.last().workspace.rotation); }}};
  for (const auto& [what, cut] : cuts) {
    SCOPED_TRACE(what);
    connect_simulated();
    session.press_mark();
    ASSERT_TRUE(comes([this] { return (last().tick.buttons & mark_button) != 0; }));
    cut();
    ASSERT_TRUE(comes([this] { return (last().tick.buttons & mark_button) == 0; }));
    session.let_go_mark();
    polls(3);
    EXPECT_THAT(marks, IsEmpty());
    session.disconnect_stylus();
  }
}

TEST_F(ControlledSession, WithoutAScanNoStylusIsConnected) {
  session.set_no_scan("there is no scan");
  EXPECT_EQ(session.why_no_scan(), QStringLiteral("there is no scan"));
  session.connect_stylus({.device = "simulated"});
  EXPECT_FALSE(session.live().is_connected());
  EXPECT_THAT(told, ::testing::ElementsAre(std::pair("there is no scan", true)));
  session.feel();
  EXPECT_THAT(told, SizeIs(1)) << "there is nothing to feel with";
  session.expect_scan();
  session.connect_stylus({.device = "simulated"});
  EXPECT_EQ(told.back(), std::pair(words(say("scan-is-still-being-read")).toStdString(), true));
  session.set_scan(igtl::testing::ball_of_tissue(), {});
  EXPECT_TRUE(session.why_no_scan().isEmpty());
  session.connect_stylus({.device = "no such stylus"});
  EXPECT_FALSE(session.live().is_connected());
  EXPECT_FALSE(session.has_simulated());
  EXPECT_THAT(told.back().first, ::testing::HasSubstr("no such stylus"));
  EXPECT_TRUE(told.back().second);
}

/// A recording's status is shown while no stylus is connected.
TEST_F(ControlledSession, ARecordingIsShownUntilAStylusIsConnected) {
  SessionStatus recorded;
  recorded.fresh = recorded.replayed = true;
  recorded.probe_mm = {1, 2, 3};
  session.show_instead([&recorded] { return recorded; });
  polls(2);
  EXPECT_EQ(last().probe_mm, recorded.probe_mm);
  EXPECT_TRUE(last().is_seen());
  connect_simulated();
  EXPECT_FALSE(last().replayed);
  session.disconnect_stylus();
  EXPECT_TRUE(last().replayed);
  session.show_instead({});
  polls(2);
  EXPECT_FALSE(last().is_seen());
}

}  // namespace
}  // namespace palpate::plugin
