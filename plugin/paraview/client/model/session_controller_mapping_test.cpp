// The mapping between hand and patient changes while a force is felt: by the clutch, an edit or another frame, and
// whatever is asked at once after it.

#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/model/testing/controlled_session.h"
#include "plugin/session/session.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using testing::comes;

struct MappedSession : testing::ControlledSession {
  /// The ticks of the session that runs.
  std::vector<TickRecord> ticks() const {
    const TickRing& ring = *session.live().ticks();
    std::vector<TickRecord> all;
    TickRecord tick;
    for (std::uint64_t n = ring.oldest(); n < ring.written(); ++n) {
      if (ring.read(n, tick)) all.push_back(tick);
    }
    return all;
  }
  /// A ball in a scan whose middle lies elsewhere, so that the hand is mapped elsewhere.
  static std::shared_ptr<const io::Volume> ball_elsewhere() {
    const io::Geometry geometry = testdata::make_geometry({.size = glm::ivec3(60), .center = {0, 6, -5}});
    return std::make_shared<const io::Volume>(testdata::scan(testdata::make_sphere(25), geometry));
  }
};

/// Against every tick: at the step of the mapping, and as long as it goes on, there is no force.
TEST_F(MappedSession, ItChangesWithoutAForceWhateverIsAskedNext) {
  const glm::dmat3 turned = glm::mat3_cast(glm::angleAxis(0.9, glm::normalize(glm::dvec3(1, 2, 3))));
  const auto shift = [&] {
    model.edit(QStringLiteral("Shift"), [](modes::Scene& scene) {
      scene.workspace.center_mm = {0, 8, 0};
      scene.workspace.fit = false;
    });
  };
  const std::pair<const char*, std::function<void()>> changes[] = {
      {"the clutch, tapped", [&] { session.clutch(), session.unclutch(turned); }},
      {"the clutch, tapped twice",
       [&] { session.clutch(), session.unclutch(turned), session.clutch(), session.unclutch(glm::dmat3(1)); }},
      {"an edit", shift},
      {"an edit, felt at once", [&] { shift(), session.feel(); }},
      {"another frame", [&] { session.set_scan(ball_elsewhere(), {}); }},
      {"another frame, felt at once", [&] { session.set_scan(ball_elsewhere(), {}), session.feel(); }}};
  for (const auto& [what, change] : changes) {
    SCOPED_TRACE(what);
    connect_simulated();
    ASSERT_TRUE(goes_to(outside));
    session.feel();
    session.move_hand(inside);
    ASSERT_TRUE(pushes());
    const std::uint32_t before = session.live().epoch();
    change();
    const std::uint32_t after = session.live().epoch();
    ASSERT_GT(after, before);
    ASSERT_TRUE(comes([&] { return last().tick.scene_epoch == after && last().tick.change_part == 1; }));
    polls(10);
    const std::vector<TickRecord> felt = ticks();
    int steps = 0;
    for (std::size_t n = 1; n < felt.size(); ++n) {
      const bool is_step = felt[n].scene_epoch != felt[n - 1].scene_epoch && felt[n].scene_epoch > before;
      if (!is_step && felt[n].change_part == 1) continue;
      ASSERT_EQ(glm::length(vector_of(felt[n].sent_n)), 0) << felt[n].change_part;
      ++steps;
    }
    EXPECT_GE(steps, 1);
    session.disconnect_stylus();
    model.open(modes::load_scene("ct-skin-and-bone"));
    session.set_scan(igtl::testing::ball_of_tissue(), {});
  }
}

/// What is shown is where the hand is mapped, in each poll.
TEST_F(MappedSession, AnotherFrameTakesTheForceAndShowsWhereTheStylusIs) {
  connect_simulated();
  ASSERT_TRUE(goes_to(outside));
  session.feel();
  session.move_hand(inside);
  ASSERT_TRUE(pushes());
  std::map<std::uint32_t, modes::Workspace> of_epoch{{session.live().epoch(), session.live().plan()->workspace}};
  session.set_scan(ball_elsewhere(), {});
  of_epoch[session.live().epoch()] = session.live().plan()->workspace;
  ASSERT_NE(of_epoch.begin()->second, of_epoch.rbegin()->second);
  const auto watched = QObject::connect(&session, &SessionController::polled, [&](const SessionStatus& status) {
    const auto mapped = of_epoch.find(status.tick.scene_epoch);
    if (mapped == of_epoch.end()) return;
    EXPECT_EQ(status.workspace, mapped->second);
    EXPECT_EQ(status.probe_mm, mapped->second.to_patient(vector_of(status.tick.probe_m)));
  });
  ASSERT_TRUE(comes([this] { return last().tick.scene_epoch == session.live().epoch(); }));
  polls(5);
  QObject::disconnect(watched);
  EXPECT_FALSE(last().feels);
  EXPECT_EQ(last().force_n, 0);
}

}  // namespace
}  // namespace palpate::plugin
