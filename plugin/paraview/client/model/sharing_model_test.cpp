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
#include "plugin/paraview/client/model/testing/application.h"
#include "plugin/paraview/client/model/testing/made_text.h"

namespace palpate::plugin {
namespace {

using igtl::testing::ball_of_labels;
using igtl::testing::TestClient;

using testing::comes;

struct SharingTest : testing::WithApplication, ::testing::Test {
  SharingTest() {
    session.set_clock([](double period_s) { return std::make_unique<plugin::testing::UnhurriedClock>(period_s); });
    model.open(modes::load_scene("ct-skin-and-bone"));
    QObject::connect(&sharing, &SharingModel::folder_wanted, [this](const QString& name) { folder = name; });
  }
  ~SharingTest() override {
    sharing.turn_off();
    session.disconnect_stylus();
  }
  void open_scan() {
    session.set_scan(igtl::testing::ball_of_tissue(), {});
    marks.set_scan("a scan");
  }
  /// The next message of that type and device, while events are handled.
  std::optional<igtl::Message> next(TestClient& client, std::string_view type, std::string_view device) {
    std::optional<igtl::Message> found;
    comes([&] {
      const auto message = client.next(2);
      if (message && message->type == type && message->device == device) found = message;
      return found.has_value();
    });
    return found;
  }
  /// Turned on, with what every client gets first behind it.
  std::unique_ptr<TestClient> a_client() {
    EXPECT_EQ(sharing.turn_on(0).toStdString(), "");
    auto client = std::make_unique<TestClient>(sharing.port());
    EXPECT_TRUE(next(*client, "POINT", igtl::marks_name));
    return client;
  }
  /// A scene of a client's, of the usual limits.
  modes::Scene theirs() const {
    modes::Scene scene = modes::load_scene("ct-skin-and-bone");
    scene.name = "theirs";
    return scene;
  }
  /// Returns when it is long ago that the scene came.
  void send_and_wait(TestClient& client, const modes::Scene& scene) {
    client.send_text(igtl::scene_name, modes::to_json(scene));
    client.send({.type = "GET_POINT", .device = igtl::marks_name, .content = {}});
    EXPECT_TRUE(next(client, "POINT", igtl::marks_name)) << "the answer to what was sent after the scene";
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
    comes([&] { return std::chrono::steady_clock::now() > end; });
  }
  std::string next_status(TestClient& client, const std::string& name) {
    std::string text;
    comes([&] {
      const auto message = next(client, "STATUS", igtl::program_name);
      if (!message) return true;
      const igtl::Status status = igtl::status_of(message->content);
      if (status.name == name) text = status.text;
      return !text.empty();
    });
    return text;
  }

  MadeText kept;
  SceneModel model{kept};
  MarksModel marks{kept};
  SessionController session{model};
  SharingModel sharing{session, model, marks};
  QString folder;
};

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

/// A list of marks may be older than the last press here: what it leaves out stays.
TEST_F(SharingTest, MarksGoBothWaysAndNoneIsLost) {
  open_scan();
  FeltMark felt;
  felt.name = "Mark 1";
  felt.boundary = "skin";
  felt.position_mm = {1, 2, 3};
  felt.value = 40;
  marks.edit(QStringLiteral("Mark"), [&](Marks& now) { now.points.push_back(felt); });
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  std::vector<igtl::Point> points;
  ASSERT_TRUE(comes([&] {
    if (const auto sent = next(client, "POINT", igtl::marks_name)) points = igtl::points_of(sent->content);
    return points.size() == 1;
  }));
  EXPECT_EQ(points[0].name, "Mark 1");
  EXPECT_EQ(points[0].group, "skin");
  EXPECT_LT(glm::distance(points[0].position, glm::dvec3(-1, -2, 3)), 1e-4) << "RAS";
  client.send(
      {.type = "POINT",
       .device = igtl::marks_name,
       .content = igtl::content_of(std::vector<igtl::Point>{{.name = "from Slicer", .position = {-4, -5, 6}}})});
  ASSERT_TRUE(comes([&] { return marks.marks().points.size() == 2; }));
  EXPECT_EQ(marks.marks().points[0].boundary, "skin");
  EXPECT_EQ(marks.marks().points[0].value, 40);
  EXPECT_EQ(marks.marks().points[1].name, "from Slicer");
  EXPECT_TRUE(std::isnan(marks.marks().points[1].value)) << "nobody felt there: 0 HU would be water";
  EXPECT_LT(glm::distance(marks.marks().points[1].position_mm, glm::dvec3(4, 5, 6)), 1e-4);
  // One that is moved there is no longer where it was felt.
  points[0].position.x += 1;
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(points)});
  ASSERT_TRUE(comes([&] { return marks.marks().points[0].position_mm.x < 0.5; }));
  EXPECT_EQ(marks.marks().points[0].boundary, "");
  EXPECT_TRUE(std::isnan(marks.marks().points[0].value));
  EXPECT_EQ(marks.marks().points.size(), 2U);
  for (const FeltMark& one : marks_of_text(kept.text("Marks")).at("a scan").points) {
    EXPECT_TRUE(std::isnan(one.value)) << one.name << ": so it is kept, too";
  }
}

/// Two may have one name, and a long name comes back cut: each keeps what was felt there.
TEST_F(SharingTest, MarksThatAreOnlySentBackStayAsTheyWereFelt) {
  open_scan();
  const std::string long_name = std::string(63, 'n') + "\u00e4 and more";
  marks.edit(QStringLiteral("Mark"), [&](Marks& now) {
    for (const std::string& name : {std::string("edge"), std::string("edge"), long_name}) {
      const auto n = static_cast<double>(now.points.size());
      FeltMark felt;
      felt.name = name;
      felt.boundary = "skin";
      felt.position_mm = {n, 0, 0};
      felt.value = 40 + n;
      felt.force_n = 1 + n;
      now.points.push_back(felt);
    }
  });
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  std::vector<igtl::Point> points;
  ASSERT_TRUE(comes([&] {
    if (const auto sent = next(client, "POINT", igtl::marks_name)) points = igtl::points_of(sent->content);
    return points.size() == 3;
  }));
  std::vector<igtl::Point> back(points.rbegin(), points.rend());
  back.push_back({.name = "last", .position = {0, 1, 0}});
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(back)});
  ASSERT_TRUE(comes([&] { return marks.marks().points.size() == 4; }));
  for (std::size_t n = 0; n < 3; ++n) {
    const FeltMark& felt = marks.marks().points[n];
    EXPECT_EQ(felt.name, n < 2 ? "edge" : long_name);
    EXPECT_EQ(felt.boundary, "skin");
    EXPECT_EQ(felt.position_mm.x, static_cast<double>(n));
    EXPECT_EQ(felt.value, 40 + static_cast<double>(n));
    EXPECT_EQ(felt.force_n, 1 + static_cast<double>(n));
  }
  // Each that is moved there is the one that is moved here.
  back[0].position.x = -10;
  back[1].position.x = -11;
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(back)});
  ASSERT_TRUE(comes([&] { return marks.marks().points[2].position_mm.x == 10; }));
  EXPECT_EQ(marks.marks().points.size(), 4U);
  EXPECT_EQ(marks.marks().points[2].name, long_name);
  EXPECT_EQ(marks.marks().points[1].position_mm.x, 11);
  EXPECT_EQ(marks.marks().points[0].value, 40);
}

TEST_F(SharingTest, AMarkWithoutANameGetsOneThatIsFree) {
  open_scan();
  marks.edit(QStringLiteral("Mark"), [](Marks& now) { now.points.push_back({.name = "Mark 1"}); });
  ASSERT_EQ(sharing.turn_on(0).toStdString(), "");
  TestClient client(sharing.port());
  client.send({.type = "POINT",
               .device = igtl::marks_name,
               .content = igtl::content_of(std::vector<igtl::Point>{{.position = {1, 0, 0}}})});
  ASSERT_TRUE(comes([&] { return marks.marks().points.size() == 2; }));
  EXPECT_EQ(marks.marks().points[1].name, "Mark 2");
  // The same list again is no step; the one after it tells that it came.
  const std::size_t steps = kept.steps.size();
  std::vector<igtl::Point> known{{.name = "Mark 2", .position = {1, 0, 0}}};
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(known)});
  known.push_back({.name = "last", .position = {0, 1, 0}});
  client.send({.type = "POINT", .device = igtl::marks_name, .content = igtl::content_of(known)});
  ASSERT_TRUE(comes([&] { return marks.marks().points.size() == 3; }));
  EXPECT_EQ(kept.steps.size(), steps + 1);
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
