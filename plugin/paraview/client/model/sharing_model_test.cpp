// The panel's session beside 3D Slicer: clients go through the models, and can neither turn the force on nor raise a
// limit.

#include "plugin/paraview/client/model/sharing_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "modes/scene/scene_json.h"
#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/testing/shared_session.h"
#include "plugin/openigtlink/testing/stepped_server.h"
#include "plugin/paraview/client/model/testing/sharing_rig.h"

namespace palpate::plugin {
namespace {

using igtl::testing::ball_of_labels;
using igtl::testing::TestClient;
using testing::comes;
using testing::SharingTest;

TEST_F(SharingTest, AClientSeesTheSceneAndThatNoStylusIsConnected) {
  open_scan();
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  EXPECT_EQ(next_status(client, "off"), "Off: no stylus is connected");
  const auto surface = next(client, "POLYDATA", "skin");
  ASSERT_TRUE(surface) << "what would be felt is seen before";
  ASSERT_TRUE(comes([&] { return sharing.clients() == 1; }));
  // What is tuned in the panel is sent.
  model.edit(QStringLiteral("Name"), [](modes::Scene& scene) { scene.name = "tuned"; });
  std::string sent;
  EXPECT_TRUE(comes([&] {
    if (const auto scene = next(client, "STRING", igtl::scene_name)) sent = igtl::string_of(scene->content);
    return sent.find("\"tuned\"") != std::string::npos;
  })) << sent;
}

TEST_F(SharingTest, WhatAClientAsksForIsAStepThatCanBeUndone) {
  open_scan();
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  client.send(ball_of_labels("liver", glm::dvec3(0), 20));
  ASSERT_TRUE(comes([&] { return model.scene().structures.size() == 1; }));
  EXPECT_EQ(model.scene().structures[0].name, "liver");
  EXPECT_EQ(session.live().scene().structures.size(), 1U) << "what is shown is what is felt";
  EXPECT_EQ(kept.steps.back().what.toStdString(), "Scene from 3D Slicer");
  // The next map of that name, undone: the first is felt again.
  const std::string first = model.scene().structures[0].file;
  client.send(ball_of_labels("liver", glm::dvec3(0, 0, 9), 10));
  ASSERT_TRUE(comes([&] { return model.scene().structures.at(0).file != first; }));
  model.undo();
  EXPECT_TRUE(comes([&] { return session.live().scene().structures.at(0).file == first; })) << "once it is read";
  EXPECT_EQ(session.live().felt().structures.size(), 1U);
  model.undo();
  EXPECT_TRUE(model.scene().structures.empty());
  client.send_text(igtl::folder_name, "/scans/chest");
  ASSERT_TRUE(comes([&] { return !folder.isEmpty(); }));
  EXPECT_EQ(folder.toStdString(), "/scans/chest");
}

TEST_F(SharingTest, NeitherForceNorLimitIsTheNetworks) {
  open_scan();
  model.edit(QStringLiteral("Force"), [](modes::Scene& scene) { scene.limits.force_n = 2; });
  session.connect_stylus({.device = "simulated"});
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  // Tightened here after it was turned on: that holds, too.
  model.edit(QStringLiteral("Force"), [](modes::Scene& scene) { scene.limits.force_n = 1.5; });
  TestClient client(sharing.port());
  ASSERT_TRUE(comes([&] { return sharing.clients() == 1; })) << "what was edited is known to the clients";
  modes::Scene wild = model.scene();
  wild.name = "wild";
  wild.limits.force_n = 3;
  wild.stiffness_n_per_m *= 2;
  client.send_text(igtl::scene_name, modes::to_json(wild));
  ASSERT_TRUE(comes([&] { return model.scene().name == "wild"; }));
  EXPECT_EQ(model.scene().limits.force_n, 1.5);
  EXPECT_EQ(model.scene().stiffness_n_per_m, modes::load_scene("ct-skin-and-bone").stiffness_n_per_m);
  EXPECT_NE(next_status(client, "drawn down"), "");
  client.send_text("PalpateFeel", "feel");
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
  comes([&] { return std::chrono::steady_clock::now() > end; });
  EXPECT_EQ(session.live().start(), LiveSession::Start::released);
  TickRecord tick;
  ASSERT_TRUE(session.live().ticks() && session.live().ticks()->written() > 0);
  ASSERT_TRUE(session.live().ticks()->read(session.live().ticks()->written() - 1, tick));
  EXPECT_EQ(glm::length(vector_of(tick.sent_n)), 0);
}

constexpr const char* too_old = "refused: the scene was changed at the stylus while this one was being prepared";

/// A limit that is lowered waits for files: a request that comes meanwhile neither undoes it nor raises it again.
TEST_F(SharingTest, AStepThatWaitsForItsFilesStays) {
  open_scan();
  std::function<void(const QString&)> read;
  bool is_read = false;
  model.set_read([&](const modes::Scene& scene, auto done) {
    if (is_read || scene.limits.force_n != 1) return false;
    read = std::move(done);
    return true;
  });
  model.edit(QStringLiteral("Force"), [](modes::Scene& scene) { scene.limits.force_n = 1; });
  ASSERT_TRUE(model.is_waiting());
  const auto client = a_client();
  send_and_wait(*client, theirs());
  client->send(ball_of_labels("liver", glm::dvec3(0), 20));
  EXPECT_EQ(model.scene().limits.force_n, 3) << "nothing is done before it";
  is_read = true;
  read({});
  EXPECT_EQ(model.scene().limits.force_n, 1);
  EXPECT_EQ(next_status(*client, "refused"), too_old);
  ASSERT_TRUE(comes([&] { return model.scene().structures.size() == 1; })) << "that goes on from the user's scene";
  EXPECT_NE(model.scene().name, "theirs");
  EXPECT_EQ(model.scene().limits.force_n, 1);
  EXPECT_EQ(session.live().scene().limits.force_n, 1);
}

/// Undo and scripts write scenes into the pipeline, whose filters take their time.
TEST_F(SharingTest, ASceneOfThePipelineThatIsBeingPreparedStays) {
  open_scan();
  std::function<void()> ready;
  model.set_make_ready([&](const modes::Scene&, std::function<void()> done) {
    ready = std::move(done);
    return true;
  });
  const auto client = a_client();
  modes::Scene own = model.scene();
  own.limits.force_n = 1;
  kept.put("Scene", modes::to_json(own));
  ASSERT_TRUE(ready);
  send_and_wait(*client, theirs());
  EXPECT_NE(model.scene().name, "theirs");
  ready();
  EXPECT_EQ(next_status(*client, "refused"), too_old);
  EXPECT_EQ(model.scene().limits.force_n, 1);
  EXPECT_EQ(session.live().scene().limits.force_n, 1);
}

/// The scene before the last edit is shown as long as a key is held: its limits are not the user's own.
TEST_F(SharingTest, TheSceneBeforeTheLastEditRaisesNoLimit) {
  open_scan();
  model.edit(QStringLiteral("Force"), [](modes::Scene& scene) { scene.limits.force_n = 1; });
  model.show_before();
  ASSERT_EQ(session.live().scene().limits.force_n, 3);
  const auto client = a_client();
  send_and_wait(*client, theirs());
  EXPECT_NE(model.scene().name, "theirs");
  model.show_now();
  EXPECT_EQ(next_status(*client, "refused"), too_old);
  EXPECT_EQ(model.scene().limits.force_n, 1);
  client->send_text(igtl::scene_name, modes::to_json(theirs()));
  ASSERT_TRUE(comes([&] { return model.scene().name == "theirs"; }));
  EXPECT_EQ(model.scene().limits.force_n, 1);
}

/// A key that was let go holds no request up, even if the scene that belongs there cannot be read. That scene's limits
/// hold.
TEST_F(SharingTest, NoRequestWaitsForASceneThatCannotBeReadAgain) {
  open_scan();
  model.edit(QStringLiteral("Force"), [](modes::Scene& scene) {
    scene.name = "unreadable";
    scene.limits.force_n = 1;
  });
  model.show_before();
  std::function<void(const QString&)> read;
  model.set_read([&](const modes::Scene& scene, auto done) {
    if (scene.name != "unreadable") return false;
    read = std::move(done);
    return true;
  });
  const auto client = a_client();
  model.show_now();
  ASSERT_TRUE(read);
  std::exchange(read, nullptr)(QStringLiteral("the segment is gone"));
  ASSERT_EQ(session.live().scene().limits.force_n, 3);
  client->send(ball_of_labels("liver", glm::dvec3(0), 20));
  ASSERT_TRUE(comes([&] { return read != nullptr; })) << "each change tries again";
  std::exchange(read, nullptr)(QStringLiteral("the segment is gone"));
  EXPECT_EQ(model.scene().structures.size(), 1U);
  EXPECT_EQ(model.scene().limits.force_n, 1);
  EXPECT_EQ(session.live().scene().limits.force_n, 1);
}

/// Only what takes effect waits for the user.
TEST_F(SharingTest, WhatCannotBePreparedIsRefusedWhileAnEarlierSceneIsHeld) {
  open_scan();
  model.edit(QStringLiteral("Force"), [](modes::Scene& scene) { scene.limits.force_n = 1; });
  model.show_before();
  const auto client = a_client();
  for (const char* const name : {"nothing", "no more"}) {
    client->send(ball_of_labels(name, glm::dvec3(0), -1));
    EXPECT_EQ(next_status(*client, "refused"),
              std::string("refused: ") + name + ": there are no labels or structures in it");
  }
  EXPECT_FALSE(model.is_settled()) << "the key is still held";
}

/// What the panel itself proposes does not wait behind it.
TEST_F(SharingTest, ARequestThatWaitsForFilesRaisesNoLimitThatIsLoweredMeanwhile) {
  open_scan();
  std::function<void(const QString&)> read;
  bool is_read = false;
  model.set_read([&](const modes::Scene& scene, auto done) {
    if (is_read || scene.name != "theirs") return false;
    read = std::move(done);
    return true;
  });
  const auto client = a_client();
  client->send_text(igtl::scene_name, modes::to_json(theirs()));
  ASSERT_TRUE(comes([&] { return model.is_waiting(); }));
  modes::Scene proposed = model.scene();
  proposed.limits.force_n = 1;
  proposed.stiffness_n_per_m = 200;
  ASSERT_TRUE(model.propose(proposed));
  is_read = true;
  read({});
  EXPECT_EQ(model.scene().name, "theirs");
  EXPECT_EQ(model.scene().limits.force_n, 1);
  EXPECT_EQ(model.scene().stiffness_n_per_m, 200);
}

/// Such as one of flow, on a scan of one value: nothing changes, and the client learns why.
TEST_F(SharingTest, ASceneThatCannotBeFeltIsRefused) {
  open_scan();
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  const std::string before = modes::to_json(model.scene());
  modes::Scene other = modes::load_scene("flow");
  other.limits = model.scene().limits;
  client.send_text(igtl::scene_name, modes::to_json(other));
  EXPECT_NE(next_status(client, "refused"), "");
  EXPECT_EQ(modes::to_json(model.scene()), before);
}

/// It was made for the scan before.
TEST_F(SharingTest, NoSceneIsTakenWhileAnotherScanComes) {
  open_scan();
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  session.expect_scan();
  const std::string before = modes::to_json(model.scene());
  modes::Scene other = model.scene();
  other.modes.front().enabled = !other.modes.front().enabled;
  client.send_text(igtl::scene_name, modes::to_json(other));
  EXPECT_NE(next_status(client, "refused").find("still being read"), std::string::npos);
  EXPECT_EQ(modes::to_json(model.scene()), before);
}

TEST_F(SharingTest, WithoutAScanAClientIsToldSo) {
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  client.send(ball_of_labels("liver", glm::dvec3(0), 20));
  EXPECT_NE(next_status(client, "refused").find("no scan is open yet"), std::string::npos);
}

/// What shows the number of clients is told when it is another, and not at each look.
TEST_F(SharingTest, EachClientThatComesOrGoesIsToldOnce) {
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  int changes = 0;
  QObject::connect(&sharing, &SharingModel::changed, [&changes] { ++changes; });
  std::optional<TestClient> client(std::in_place, sharing.port());
  ASSERT_TRUE(comes([&] { return sharing.clients() == 1; }));
  EXPECT_EQ(changes, 1);
  client.reset();
  ASSERT_TRUE(comes([&] { return sharing.clients() == 0; }));
  EXPECT_EQ(changes, 2);
}

TEST_F(SharingTest, ATakenPortIsSaidAndTurningOffLetsClientsGo) {
  const igtl::Server other({.port = 0});
  EXPECT_NE(sharing.turn_on(other.port()).toStdString().find("cannot listen on 127.0.0.1"), std::string::npos);
  EXPECT_FALSE(sharing.is_on());
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  ASSERT_TRUE(comes([&] { return sharing.clients() == 1; }));
  sharing.turn_off();
  EXPECT_TRUE(client.is_closed_soon());
  EXPECT_EQ(sharing.port(), 0);
  EXPECT_EQ(sharing.clients(), 0U);
}

/// The stylus comes and goes while it is shared: frames are sent of the session that runs.
TEST_F(SharingTest, FollowsTheStylus) {
  open_scan();
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  ASSERT_NE(next_status(client, "off"), "");
  for (int n = 0; n < 2; ++n) {
    session.connect_stylus({.device = "simulated"});
    EXPECT_TRUE(next(client, "TRANSFORM", igtl::proxy_name)) << n;
    EXPECT_NE(next_status(client, "ready"), "") << n;
    session.disconnect_stylus();
    EXPECT_NE(next_status(client, "off"), "") << n;
  }
}

}  // namespace
}  // namespace palpate::plugin
