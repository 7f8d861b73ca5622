// Requests of clients and the mapping between hand and patient: nothing moves the stylus through the patient under a
// force.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/requests.h"
#include "plugin/openigtlink/testing/asked_session.h"

namespace palpate::plugin::igtl {
namespace {

using testing::sent_n;
using testing::SharedSession;
using testing::TestClient;
using testing::text_of_status;

/// The ball of the session, in a scan whose middle lies this much higher.
LoadedScan ball_in_scan_at(double z_mm) {
  const io::Geometry geometry = testdata::make_geometry({.size = glm::ivec3(60), .center = {0, 0, z_mm}});
  return {.volume = std::make_shared<const io::Volume>(testdata::scan(testdata::make_sphere(25), geometry)),
          .frame = {}};
}

/// Each folder that a client sends holds that ball.
void load_ball_at(SharedSession& shared, double z_mm) {
  shared.load = [z_mm](const std::string&) { return ball_in_scan_at(z_mm); };
}

/// Whether the hand feels the ball in the end.
bool presses(SharedSession& shared) {
  return shared.comes([&] { return sent_n(shared) > 0.3; });
}

/// Whether the scan of a folder is taken.
bool sends_folder(SharedSession& shared, TestClient& client) {
  const auto before = shared.session.scan();
  client.send_text(folder_name, "/scans/other");
  return shared.comes([&] { return shared.session.scan() != before; });
}

/// Whether it is taken and the change to it ends; a while later.
bool changes_to_folder(SharedSession& shared, TestClient& client) {
  if (!sends_folder(shared, client)) return false;
  const std::uint32_t epoch = shared.session.epoch();
  const bool over =
      shared.comes([&] { return shared.last_tick().scene_epoch == epoch && shared.last_tick().change_part >= 1; });
  shared.look_for(std::chrono::milliseconds(200));
  return over;
}

TEST(OpenIgtRequests, ASceneKeepsTheWorkspaceOfTheSession) {
  SharedSession shared;
  TestClient client(shared.server.port());
  ASSERT_TRUE(presses(shared));
  const modes::Workspace before = shared.session.plan()->workspace;
  modes::Scene scene = shared.session.scene();
  scene.name = "moved";
  scene.workspace = {.center_mm = glm::dvec3(0, 0, 30), .rotation = glm::dmat3(1), .scale = 2, .fit = false};
  client.send_text(scene_name, modes::to_json(scene));
  EXPECT_EQ(text_of_status(shared, client, "workspace stays"),
            "the scene's workspace is not taken: the session keeps its own");
  ASSERT_TRUE(shared.comes([&] { return shared.session.scene().name == "moved"; }));
  EXPECT_EQ(shared.session.plan()->workspace, before);
  EXPECT_FALSE(shared.session.scene().workspace.center_mm);
  EXPECT_EQ(shared.session.start(), LiveSession::Start::feeling);
}

TEST(OpenIgtRequests, AScanElsewhereUnderTheHandComesWithoutAForce) {
  SharedSession shared;
  load_ball_at(shared, -5);
  TestClient client(shared.server.port());
  ASSERT_TRUE(presses(shared));
  ASSERT_TRUE(changes_to_folder(shared, client));
  ASSERT_TRUE(shared.comes([&] { return state_of(shared.last_tick()) == device::State::active; })) << "it comes back";
  EXPECT_EQ(shared.session.start(), LiveSession::Start::feeling);
  TickRecord tick, before;
  int steps = 0;
  for (std::uint64_t n = shared.session.ticks()->oldest() + 1; n < shared.session.ticks()->written(); ++n) {
    if (!shared.session.ticks()->read(n - 1, before) || !shared.session.ticks()->read(n, tick)) continue;
    EXPECT_EQ(tick.change_part, 1) << "between two places";
    if (tick.scene_epoch == before.scene_epoch) continue;
    EXPECT_EQ(glm::length(vector_of(before.sent_n)), 0);
    EXPECT_EQ(glm::length(vector_of(tick.sent_n)), 0);
    ++steps;
  }
  EXPECT_EQ(steps, 1);
}

TEST(OpenIgtRequests, AScanInTheSamePlaceKeepsTheForce) {
  SharedSession shared;
  load_ball_at(shared, 0);
  TestClient client(shared.server.port());
  ASSERT_TRUE(presses(shared));
  ASSERT_TRUE(sends_folder(shared, client));
  EXPECT_EQ(shared.session.start(), LiveSession::Start::feeling);
}

TEST(OpenIgtRequests, AScanElsewhereTurnsNoForceOn) {
  SharedSession shared(LiveSession::Start::released);
  load_ball_at(shared, -5);
  TestClient client(shared.server.port());
  ASSERT_TRUE(changes_to_folder(shared, client));
  EXPECT_EQ(shared.session.start(), LiveSession::Start::released);
}

/// A fault meanwhile is the owner's to clear.
TEST(OpenIgtRequests, AFaultWhileAScanComesStays) {
  SharedSession shared;
  load_ball_at(shared, -5);
  TestClient client(shared.server.port());
  ASSERT_TRUE(presses(shared));
  shared.stylus->inject(device::SimulatedFault::not_a_number);
  ASSERT_TRUE(shared.comes([&] { return fault_of(shared.last_tick()) != device::Fault::none; }));
  shared.stylus->inject(device::SimulatedFault::none);
  ASSERT_TRUE(changes_to_folder(shared, client));
  EXPECT_NE(fault_of(shared.last_tick()), device::Fault::none);
  EXPECT_EQ(sent_n(shared), 0);
}

}  // namespace
}  // namespace palpate::plugin::igtl
