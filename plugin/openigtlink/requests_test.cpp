// Requests of clients to a real session: scenes are felt; force and limits stay.

#include "plugin/openigtlink/requests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/surface.h"
#include "plugin/openigtlink/testing/asked_session.h"
#include "plugin/recording/recording.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin::igtl {
namespace {

using testing::ball_of_labels;
using testing::sent_n;
using testing::SharedSession;
using testing::TestClient;
using testing::text_of_status;

/// Everything that a client may send, and much that it may not.
void send_everything(TestClient& client, unsigned seed) {
  std::mt19937 seeded(seed);
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  for (int n = 0; n < 20; ++n) {
    scene.name = "scene " + std::to_string(n);
    client.send_text(scene_name, modes::to_json(scene));
    client.send(ball_of_labels("liver", glm::dvec3(n - 10, 0, 0), 15));
    client.send_text(folder_name, "/nowhere");
    client.send_text("PalpateFeel", "feel");
    for (const char* type : {"STATUS", "TRANSFORM", "GET_STATUS", "STT_TRANS", "COMMAND", "POLYDATA"}) {
      Bytes content(seeded() % 200);
      for (std::uint8_t& byte : content) byte = static_cast<std::uint8_t>(seeded());
      client.send({.type = type, .device = "Stylus", .content = content});
    }
  }
}

TEST(OpenIgtRequests, ASceneIsFeltAndSaidAsItIsFelt) {
  SharedSession shared;
  TestClient client(shared.server.port());
  ASSERT_TRUE(shared.comes([&] { return sent_n(shared) > 0.3; }));
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  scene.name = "from Slicer";
  for (modes::Mode& mode : scene.modes) mode.enabled = false;
  client.send_text(scene_name, modes::to_json(scene));
  EXPECT_TRUE(shared.comes([&] { return sent_n(shared) < 0.01; }));
  EXPECT_EQ(shared.session.scene().name, "from Slicer");
  std::string said;
  EXPECT_TRUE(shared.comes([&] {
    if (const auto message = client.next("STRING", scene_name, 20)) said = string_of(message->content);
    return said.find("from Slicer") != std::string::npos;
  }));
  EXPECT_EQ(modes::to_json(modes::scene_from_json(said, "wire")), modes::to_json(shared.session.scene()));
}

// Slicer sends a text again whenever it changes, also by what came over the wire.
TEST(OpenIgtRequests, WhatIsOnlySentBackChangesNothing) {
  SharedSession shared;
  TestClient client(shared.server.port());
  const auto scene = client.next("STRING", scene_name), marks = client.next("POINT", marks_name);
  ASSERT_TRUE(scene && marks);
  client.send(*scene);
  client.send(*marks);
  EXPECT_TRUE(shared.comes([&] { return shared.server.counts().taken == 2; }));
  shared.look_for(std::chrono::milliseconds(300));
  EXPECT_EQ(shared.session.epoch(), 0U);
  EXPECT_FALSE(client.next("POINT", marks_name, 300));
}

// The change takes the ramp: the force nowhere steps by more than the slew limit, and takes the ramp's time to change.
TEST(OpenIgtRequests, ASceneComesAlongTheRamp) {
  SharedSession shared;
  TestClient client(shared.server.port());
  ASSERT_TRUE(shared.comes([&] { return shared.last_tick().time_s > 1.5; }));
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  scene.limits.ramp_s = 0.25;  // a client may not make the ramp shorter, either
  scene.modes[0].strength_n = modes::TransferFunction(2.5);
  client.send_text(scene_name, modes::to_json(scene));
  ASSERT_TRUE(shared.comes([&] { return shared.session.epoch() == 1; }));
  ASSERT_TRUE(shared.comes([&] { return shared.last_tick().scene_epoch == 1 && shared.last_tick().change_part >= 1; }));
  TickRecord tick, before;
  double began_s = -1, ended_s = -1, largest_step_n = 0;
  for (std::uint64_t n = shared.session.ticks()->oldest() + 1; n < shared.session.ticks()->written(); ++n) {
    if (!shared.session.ticks()->read(n, tick) || !shared.session.ticks()->read(n - 1, before)) continue;
    if (tick.scene_epoch != 1) continue;
    if (began_s < 0) began_s = tick.time_s;
    if (ended_s < 0 && tick.change_part >= 1) ended_s = tick.time_s;
    largest_step_n = std::max(largest_step_n, glm::length(vector_of(tick.sent_n) - vector_of(before.sent_n)));
  }
  EXPECT_GE(ended_s - began_s, modes::Limits{}.ramp_s - 0.01);
  EXPECT_LT(largest_step_n, 0.2);
}

TEST(OpenIgtRequests, LimitsAndStiffnessAreNeverRaised) {
  modes::Scene mild = modes::load_scene("ct-skin-and-bone");
  mild.limits = {.force_n = 1.5, .slew_n_per_ms = 0.5, .ramp_s = 1, .speed_m_per_s = 0.5};
  mild.stiffness_n_per_m = 300;
  SharedSession shared(LiveSession::Start::feeling, 0.022, mild);
  TestClient client(shared.server.port());
  modes::Scene wild = mild;
  wild.limits = {.force_n = 1e9, .slew_n_per_ms = 1e9, .ramp_s = 1e-9, .speed_m_per_s = 1e9};
  wild.stiffness_n_per_m = 1e6;
  wild.name = "wild";
  client.send_text(scene_name, modes::to_json(wild));
  EXPECT_EQ(text_of_status(shared, client, "drawn down"),
            "limits or stiffness of the scene are reduced to those that were set at the stylus");
  ASSERT_TRUE(shared.comes([&] { return shared.session.scene().name == "wild"; }));
  const modes::Limits felt = shared.session.scene().limits;
  EXPECT_EQ(felt.force_n, 1.5);
  EXPECT_EQ(felt.slew_n_per_ms, 0.5);
  EXPECT_EQ(felt.ramp_s, 1);
  EXPECT_EQ(felt.speed_m_per_s, 0.5);
  EXPECT_EQ(shared.session.scene().stiffness_n_per_m, 300);
  // Tighter ones count, and are not the new ceiling.
  modes::Scene tight = mild;
  tight.limits.force_n = 0.5;
  tight.name = "tight";
  client.send_text(scene_name, modes::to_json(tight));
  ASSERT_TRUE(shared.comes([&] { return shared.session.scene().name == "tight"; }));
  EXPECT_EQ(shared.session.scene().limits.force_n, 0.5);
  // What was set at the stylus is had again, and no more.
  mild.name = "mild again";
  client.send_text(scene_name, modes::to_json(mild));
  ASSERT_TRUE(shared.comes([&] { return shared.session.scene().name == "mild again"; }));
  EXPECT_EQ(shared.session.scene().limits.force_n, 1.5);
  wild.name = "wild again";
  client.send_text(scene_name, modes::to_json(wild));
  ASSERT_TRUE(shared.comes([&] { return shared.session.scene().name == "wild again"; }));
  EXPECT_EQ(shared.session.scene().limits.force_n, 1.5);
  EXPECT_EQ(shared.session.scene().stiffness_n_per_m, 300);
}

TEST(OpenIgtRequests, NothingTurnsTheForceOn) {
  SharedSession shared(LiveSession::Start::released);
  TestClient client(shared.server.port());
  send_everything(client, 1);
  ASSERT_TRUE(shared.comes([&] { return shared.session.scene().name == "scene 19"; }));
  shared.look_for(std::chrono::milliseconds(500));
  TickRecord tick;
  std::uint64_t ticks = 0;
  for (std::uint64_t n = shared.session.ticks()->oldest(); n < shared.session.ticks()->written(); ++n) {
    if (!shared.session.ticks()->read(n, tick)) continue;
    EXPECT_EQ(glm::length(vector_of(tick.sent_n)), 0);
    ++ticks;
  }
  EXPECT_GT(ticks, 100U);
}

TEST(OpenIgtRequests, NothingClearsAFault) {
  SharedSession shared;
  TestClient client(shared.server.port());
  ASSERT_TRUE(shared.comes([&] { return sent_n(shared) > 0.3; }));
  shared.stylus->inject(device::SimulatedFault::not_a_number);
  ASSERT_TRUE(shared.comes([&] { return fault_of(shared.last_tick()) != device::Fault::none; }));
  shared.stylus->inject(device::SimulatedFault::none);
  send_everything(client, 2);
  ASSERT_TRUE(shared.comes([&] { return shared.session.scene().name == "scene 19"; }));
  EXPECT_NE(fault_of(shared.last_tick()), device::Fault::none);
  EXPECT_EQ(sent_n(shared), 0);
  EXPECT_EQ(text_of_status(shared, client, "stopped").substr(0, 9), "Stopped: ");
}

/// Names in other letters, or cut by their sender behind 20 bytes, are felt, recorded and sent as UTF-8. What a client
/// gets it may send back.
TEST(OpenIgtRequests, ANameThatIsNoTextIsToldRecordedAndTakenBack) {
  SharedSession shared;
  const auto file = plugin::testing::fresh_path("names.h5");
  shared.session.record(file);
  TestClient client(shared.server.port());
  const std::vector<std::string> sent{"L\xe4sion \xff", std::string("abcdefghijklmnopqrs\xc3"),
                                      "L\xc3\xa4"
                                      "ppchen"};
  const std::vector<std::string> names{"L\u00e4sion \u00ff", "abcdefghijklmnopqrs", "L\u00e4ppchen"};
  for (std::size_t n = 0; n < sent.size(); ++n) {
    client.send(ball_of_labels(sent[n], glm::dvec3(0), 10 + static_cast<double>(n)));
    ASSERT_TRUE(shared.comes([&] { return shared.session.scene().structures.size() == n + 1; })) << names[n];
    EXPECT_EQ(shared.session.scene().structures[n].name, names[n]);
  }
  std::string said;
  EXPECT_TRUE(shared.comes([&] {
    if (const auto message = client.next("STRING", scene_name, 20)) said = string_of(message->content);
    return said.find(names.back()) != std::string::npos;
  })) << said;
  EXPECT_NE(said.find("\"openigtlink:L\u00e4sion \u00ff\""), std::string::npos) << said;
  modes::Scene scene = modes::scene_from_json(said, "wire");
  scene.name = "sent back";
  client.send_text(scene_name, modes::to_json(scene));
  EXPECT_TRUE(shared.comes([&] { return shared.session.scene().name == "sent back"; }));
  const auto status = shared.session.stop_recording();
  ASSERT_TRUE(status);
  EXPECT_FALSE(status->stopped) << status->why;
  EXPECT_EQ(read_recording(file).scenes.back().structures, names);
}

TEST(OpenIgtRequests, ASceneThatIsTooLongIsNotTakenForTheOneBefore) {
  SharedSession shared;
  TestClient reader(shared.server.port());
  ASSERT_TRUE(reader.next("STRING", scene_name));
  modes::Scene scene = shared.session.scene();
  scene.name = std::string(70000, 'n');
  shared.session.set_scene(scene);
  ::testing::internal::CaptureStderr();
  shared.look();
  const std::string told = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(told.find("clients do not get the scene that is felt: it has "), std::string::npos);
  EXPECT_NE(told.find(" bytes; at most 65535 fit"), std::string::npos) << told;
  TestClient late(shared.server.port());
  late.send({.type = "GET_STRING", .device = scene_name, .content = {}});
  EXPECT_TRUE(late.next_status("refused")) << "there is nothing to get";
}

TEST(OpenIgtRequests, WhatCannotBeFeltIsRefusedInWordsAndTheSceneStays) {
  SharedSession shared;
  TestClient client(shared.server.port());
  const auto refused = [&] { return text_of_status(shared, client, "refused"); };
  client.send_text(scene_name, R"({"version": 1, "modes": [{"type": "surfce"}]})");
  EXPECT_NE(refused().find("PalpateScene: modes[0].type: there is no mode \"surfce\""), std::string::npos);
  client.send_text(scene_name, "{");
  EXPECT_NE(refused().find("refused: PalpateScene"), std::string::npos);
  client.send_text(folder_name, "/scans/gone");
  EXPECT_EQ(refused(), "refused: nothing at /scans/gone");
  client.send(ball_of_labels("nothing", glm::dvec3(0), -1));
  EXPECT_EQ(refused(), "refused: nothing: there are no labels or structures in it");
  client.send_text(structures_name, "/scans/gone");
  EXPECT_NE(refused().find("/scans/gone"), std::string::npos);
  client.send_text(scene_name, R"({"version": 1, "structures": [{"name": "a", "file": "openigtlink:b", "segment": 1}],
    "modes": [{"type": "surface", "structure": "a", "strength_n": 1}]})");
  EXPECT_EQ(refused(), "refused: structure \"a\": no label map \"b\" was sent in this session");
  for (int n = 0; n < 9; ++n) {
    client.send(ball_of_labels("map " + std::to_string(n), glm::dvec3(0), 5));
    shared.comes([&, n] {
      return shared.session.scene().structures.size() == std::min<std::size_t>(8, static_cast<std::size_t>(n) + 1);
    });
  }
  EXPECT_EQ(refused(), "refused: label map \"map 8\": there are 8 already");
  EXPECT_EQ(shared.session.scene().name, "CT: skin and bone");
}

}  // namespace
}  // namespace palpate::plugin::igtl
