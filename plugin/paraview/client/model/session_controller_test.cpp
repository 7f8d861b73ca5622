#include "plugin/paraview/client/model/session_controller.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/openigtlink/testing/shared_session.h"
#include "plugin/paraview/client/model/testing/application.h"
#include "plugin/paraview/client/model/testing/made_text.h"
#include "plugin/testing/test_clocks.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

using testing::comes;

struct RecordingOfAController : testing::WithApplication, ::testing::Test {
  RecordingOfAController() {
    session.set_clock([](double period_s) { return std::make_unique<testing::UnhurriedClock>(period_s); });
    model.open(modes::load_scene("ct-skin-and-bone"));
    QObject::connect(&session, &SessionController::told, [this](const QString& text, bool problem) {
      if (!text.isEmpty()) told.emplace_back(text.toStdString(), problem);
    });
    QObject::connect(&session, &SessionController::recorded,
                     [this](const QString& name) { written.push_back(name.toStdString()); });
  }
  /// Until some ticks are recorded.
  bool records() {
    session.set_scan(igtl::testing::ball_of_tissue(), {});
    session.connect_stylus({.device = "simulated"});
    session.record(file);
    told.clear();
    return comes([&] { return session.last().fresh && session.last().tick.index > 100; });
  }

  testing::DrivenTime time;
  MadeText kept;
  SceneModel model{kept};
  SessionController session{model};
  std::string file = testing::fresh_path("controller.h5").string();
  std::vector<std::pair<std::string, bool>> told;
  std::vector<std::string> written;
};

/// Whatever ends it: it is told how much was recorded, and the file can be looked at.
TEST_F(RecordingOfAController, ItIsToldHowItEndedWhateverEndsIt) {
  const std::pair<const char*, std::function<void()>> ends[] = {
      {"the user", [this] { session.stop_recording(); }},
      {"no stylus", [this] { session.disconnect_stylus(); }},
      {"no scan", [this] { session.set_no_scan({}); }},
      {"another scan that the scene cannot be felt on",
       [this] {
         const modes::Scene flow = modes::load_scene("flow");
         session.expect_scan();
         model.open(flow);
         session.set_scan(igtl::testing::ball_of_tissue(), {});
       }},
  };
  for (const auto& [what, end] : ends) {
    SCOPED_TRACE(what);
    written.clear();
    ASSERT_TRUE(records());
    end();
    ASSERT_FALSE(told.empty());
    EXPECT_THAT(told.front().first, ::testing::HasSubstr("ticks"));
    EXPECT_FALSE(told.front().second);
    EXPECT_THAT(written, ::testing::ElementsAre(file));
    EXPECT_GT(std::filesystem::file_size(file), 0U);
    session.disconnect_stylus();
  }
}

/// The stylus goes on without a recording, and the panel reads its ticks from the first one on.
TEST_F(RecordingOfAController, WhereTheFileCannotBeWrittenTheNewSessionIsFollowedAtOnce) {
  session.set_clock([this](double) { return time.clock(); });
  session.set_scan(igtl::testing::ball_of_tissue(), {});
  session.connect_stylus({.device = "simulated"});
  constexpr std::uint64_t before = 200;
  time.advance(before);
  ASSERT_TRUE(comes([&] { return session.last().fresh && session.last().tick.index + 1 == before; }));
  told.clear();
  session.record((testing::fresh_path("no_such_folder") / "x.h5").string());
  ASSERT_FALSE(told.empty());
  EXPECT_THAT(told.back().first, ::testing::HasSubstr("x.h5"));
  EXPECT_TRUE(told.back().second);
  EXPECT_FALSE(session.live().recording());
  ASSERT_TRUE(session.has_simulated());
  const glm::dvec3 place_mm = session.last().probe_mm + glm::dvec3(5, 0, 0);
  session.move_hand(place_mm);
  time.advance(before / 2);
  EXPECT_TRUE(comes([&] { return session.last().tick.index + 1 == before / 2; }));
  EXPECT_LT(glm::distance(session.last().probe_mm, place_mm), 4) << "the hand has moved";
  session.disconnect_stylus();
}

}  // namespace
}  // namespace palpate::plugin
