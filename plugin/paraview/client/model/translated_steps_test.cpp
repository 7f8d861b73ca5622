// Whatever a model calls a step or a state is in the user's language.

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/model/session_state.h"
#include "plugin/paraview/client/model/testing/controlled_session.h"
#include "plugin/paraview/client/model/testing/correcting.h"
#include "plugin/paraview/client/model/testing/marking_translator.h"
#include "plugin/session/session.h"

namespace palpate::plugin {
namespace {

using testing::is_translated;

struct TranslatedCorrection : testing::Correcting {
  testing::MarkingTranslator translator;
};

TEST_F(TranslatedCorrection, EachStepIsNamedInTheUsersLanguage) {
  look_beside();
  model.begin(liver, {.per_mm = 120});
  stroke({{0, 0, 0}, {1, 0, 0}});
  model.draw_felt({{0, 0, 0}, {1, 0, 0}});
  beside.back().done({std::nullopt, std::nullopt});
  model.press({0, 0, 0}, CorrectionModel::Over::outline);
  model.move({1, 0, 0});
  model.let_go();
  beside.back().done({EdgeBeside{{0, 3, 0}, 3, 0.2}, std::nullopt});
  model.set_tool(CorrectionModel::Tool::add);
  model.draw_felt({{0, 0, 0}});
  model.set_tool(CorrectionModel::Tool::remove);
  model.draw_felt({{0, 0, 0}});
  model.take_scan_edge({0, 0, 0});
  model.undo();
  model.redo();
  const HeldPlane slice{.point_mm = {1, 2, 30}, .normal = {0, 0, 1}};
  model.hold_in(slice);
  model.set_freed(true);
  model.follow_slice({.point_mm = {1, 2, 31}, .normal = {0, 0, 1}});
  model.set_freed(false);
  model.hold_in(std::nullopt);
  model.set_snap_n(2);
  model.end();
  EXPECT_GE(kept.steps.size(), 13U);
  for (const MadeText::Step& step : kept.steps) EXPECT_TRUE(is_translated(step.what)) << step.what.toStdString();
}

struct TranslatedSession : testing::ControlledSession {
  testing::MarkingTranslator translator;
};

TEST_F(TranslatedSession, MarksAndTheClutchAreToo) {
  MarksModel made{kept};
  made.set_scan("a scan");
  made.add(FeltMark{});
  made.add(MarkedPath{});
  connect_simulated();
  session.clutch();
  session.unclutch(glm::dmat3{0, 1, 0, 0, 0, 1, 1, 0, 0});
  ASSERT_EQ(kept.steps.size(), 3U);
  for (const MadeText::Step& step : kept.steps) EXPECT_TRUE(is_translated(step.what)) << step.what.toStdString();
  session.note_work("drawing", 2);
  SlowWork work;
  work.note("drawing", 2);
  EXPECT_EQ(work.in_words().toStdString(), "#drawing took 2.0 s");
}

TEST(TranslatedState, EachLineIs) {
  const testing::MarkingTranslator translator;
  for (const bool connected : {false, true}) {
    for (const bool fresh : {false, true}) {
      for (const bool feels : {false, true}) {
        for (const bool clutched : {false, true}) {
          for (int state = 0; state <= static_cast<int>(device::State::fault); ++state) {
            for (const device::Fault fault : {device::Fault::none, device::Fault::tick_late}) {
              for (const char* const text : {"", "words"}) {
                SessionStatus look;
                look.connected = connected;
                look.fresh = fresh;
                look.feels = feels;
                look.clutched = clutched;
                look.kept_off = look.homing = QString::fromUtf8(text);
                look.tick.safety = pack_safety(static_cast<device::State>(state), fault);
                for (const bool may_push : {false, true}) {
                  look.may_push = may_push;
                  // Once as a stylus that is lost, which has no more to tell.
                  for (const auto stylus : {device::State::disconnected, static_cast<device::State>(state)}) {
                    look.tick.stylus_state = static_cast<std::uint32_t>(stylus);
                    EXPECT_TRUE(is_translated(state_line_of(look).words)) << state_line_of(look).words.toStdString();
                  }
                }
              }
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
