#include "plugin/paraview/client/model/slow_work.h"

#include <gtest/gtest.h>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/model/session_state.h"

namespace palpate::plugin {
namespace {

using std::chrono::milliseconds;

const SlowWork::Time begin{};

TEST(SlowWork, IsTheSlowestOfThatWhichEndedJustNow) {
  SlowWork work;
  EXPECT_TRUE(work.in_words(begin).isEmpty());
  work.note("drawing", 0.4, begin);
  EXPECT_TRUE(work.in_words(begin).isEmpty()) << "too short to be why";
  work.note("loading", 0.5, begin);
  EXPECT_EQ(work.in_words(begin).toStdString(), "loading took 0.5 s");
  work.note("drawing", 2.31, begin);
  work.note("drawing", 0.6, begin + milliseconds(700));
  EXPECT_EQ(work.in_words(begin + milliseconds(800)).toStdString(), "drawing took 2.3 s");
  EXPECT_EQ(work.in_words(begin + milliseconds(3900)).toStdString(), "drawing took 2.3 s");
  EXPECT_TRUE(work.in_words(begin + milliseconds(4100)).isEmpty()) << "long ago";
  work.note("drawing", 0.7, begin + milliseconds(5000));
  EXPECT_EQ(work.in_words(begin + milliseconds(5100)).toStdString(), "drawing took 0.7 s");
}

/// The line of the state says why the force went, where the panel itself is why.
TEST(SlowWork, IsNamedWhereThePanelStoppedAnswering) {
  SessionStatus look;
  look.connected = look.fresh = true;
  look.tick.safety = pack_safety(device::State::active, device::Fault::commander_silent);
  const QString plain = state_line_of(look).words;
  EXPECT_TRUE(plain.startsWith("Stopped: The panel stopped answering"));
  look.held_up = "drawing took 2.3 s";
  EXPECT_EQ(state_line_of(look).words, plain + " (drawing took 2.3 s)");
  look.tick.safety = pack_safety(device::State::active, device::Fault::tick_late);
  EXPECT_FALSE(state_line_of(look).words.contains("2.3"));
}

}  // namespace
}  // namespace palpate::plugin
