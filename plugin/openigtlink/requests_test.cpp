// What clients ask for, on a real session: scenes, label maps, marks and folders are felt; force and limits stay.

#include "plugin/openigtlink/requests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <random>

#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/surface.h"
#include "plugin/openigtlink/testing/shared_session.h"

namespace palpate::plugin::igtl {
namespace {

using testing::ball_of_labels;
using testing::SharedSession;
using testing::TestClient;

double sent_n(const SharedSession& shared) {
  return glm::length(vector_of(shared.last_tick().sent_n));
}

/// A STATUS that says so by its name, while the session goes on.
std::string text_of_status(SharedSession& shared, TestClient& client, const std::string& name) {
  std::optional<Status> status;
  shared.comes([&] { return (status = client.next_status(name, 20)).has_value(); });
  return status ? status->text : "nothing was said";
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
            "limits or stiffness of the scene are drawn down to those that were set at the stylus");
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
}

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

TEST(OpenIgtRequests, ALabelMapIsFeltAndMovesWithTheNextOne) {
  SharedSession shared(LiveSession::Start::feeling, 0.03, [] {
    modes::Scene scene = modes::load_scene("ct-skin-and-bone");
    for (modes::Mode& mode : scene.modes) mode.enabled = false;
    return scene;
  }());
  TestClient client(shared.server.port());
  client.send(ball_of_labels("liver", glm::dvec3(0), 25));
  ASSERT_TRUE(shared.comes([&] { return shared.session.epoch() == 1 && shared.last_tick().change_part >= 1; }));
  EXPECT_LT(sent_n(shared), 0.01) << "5 mm outside";
  shared.stylus->move_target({0, 0.022, 0});
  EXPECT_TRUE(shared.comes([&] { return sent_n(shared) > 0.3; })) << "3 mm below its top";
  ASSERT_EQ(shared.session.scene().structures.size(), 1U);
  EXPECT_EQ(shared.session.scene().structures[0].name, "liver");
  EXPECT_NEAR(shared.last_tick().distance_mm[0], 0, 0.5);

  // As a surface and in the scene, without the path of a file.
  std::optional<Message> surface, scene;
  ASSERT_TRUE(shared.comes([&] {
    while (const auto message = client.next(2)) {
      if (message->type == "POLYDATA" && message->device == "liver") surface = message;
      if (message->device == scene_name) scene = message;
    }
    return surface.has_value();
  }));
  double mean_mm = 0;
  const Surface triangles = surface_of(surface->content);
  for (const glm::dvec3& point : triangles.points)
    mean_mm += glm::length(point) / static_cast<double>(triangles.points.size());
  EXPECT_NEAR(mean_mm, 25, 0.2);
  ASSERT_TRUE(scene);
  EXPECT_NE(string_of(scene->content).find("\"openigtlink:liver\""), std::string::npos) << string_of(scene->content);
  EXPECT_EQ(string_of(scene->content).find(".nrrd"), std::string::npos);

  // The next map of that name takes its place, in the scene as it is: no second structure, no second boundary.
  client.send(ball_of_labels("liver", glm::dvec3(0, 0, -20), 15));
  EXPECT_TRUE(shared.comes([&] { return sent_n(shared) < 0.01; }));
  EXPECT_EQ(shared.session.scene().structures.size(), 1U);
  EXPECT_EQ(shared.session.scene().modes.size(), 4U);

  // A scene that names it is felt with the newest.
  modes::Scene named = modes::scene_from_json(string_of(scene->content), "wire");
  named.name = "named";
  client.send_text(scene_name, modes::to_json(named));
  EXPECT_TRUE(shared.comes([&] { return shared.session.scene().name == "named"; }));
}

TEST(OpenIgtRequests, StructuresOfAFileGetBoundaries) {
  SharedSession shared;
  TestClient client(shared.server.port());
  const auto file = plugin::testing::fresh_path("spleen.nrrd");
  const Message map = ball_of_labels("", glm::dvec3(0), 10);
  write_nrrd(image_of(map.content), file);
  client.send_text(structures_name, file.string());
  EXPECT_TRUE(shared.comes([&] { return shared.session.scene().structures.size() == 1; }));
  EXPECT_EQ(shared.session.scene().structures[0].name, "spleen");
  EXPECT_EQ(shared.session.scene().modes.back().structure, "spleen");
}

// The controlling thread beats the heart: it does not read what another thread has read.
TEST(OpenIgtRequests, WhatWasPreparedIsNotReadAgain) {
  SharedSession shared;
  const auto file = plugin::testing::fresh_path("ahead.nrrd");
  write_nrrd(image_of(ball_of_labels("", glm::dvec3(0), 10).content), file);
  modes::Scene scene = shared.session.scene();
  scene.structures = {{.name = "ball", .file = file.string(), .segment_number = 1}};
  scene.modes.push_back({.type = "surface", .structure = "ball"});
  scene.modes.back().strength_n = modes::TransferFunction(0.5);
  for (const bool other_scan : {false, true}) {
    const auto scan = other_scan ? testing::ball_of_tissue() : shared.session.scan();
    const modes::Scene plain = modes::load_scene("ct-skin-and-bone");
    shared.session.set_scene(plain);
    write_nrrd(image_of(ball_of_labels("", glm::dvec3(0), 10).content), file);
    const PreparedScene ahead = prepare(scene, scan, shared.session.planned_for().workspace_half_extent);
    std::filesystem::remove(file);
    EXPECT_ANY_THROW(shared.session.set_scene(scene)) << "it is read";
    shared.session.offer(ahead);
    if (other_scan) {
      shared.session.set_scan(ahead.volume, scene);
    } else {
      shared.session.set_scene(scene);
    }
    ASSERT_EQ(shared.session.felt().structures.size(), 1U);
    EXPECT_EQ(shared.session.felt().structures.front().distance, ahead.structures.front().distance);
  }
}

TEST(OpenIgtRequests, EachLabelOfAMapIsAStructure) {
  SharedSession shared;
  TestClient client(shared.server.port());
  Message two = ball_of_labels("organs", glm::dvec3(-15, 0, 0), 8, 3);
  const Message other = ball_of_labels("organs", glm::dvec3(15, 0, 0), 8, 7);
  for (std::size_t n = image_header_size; n < two.content.size(); ++n) two.content[n] |= other.content[n];
  client.send(two);
  EXPECT_TRUE(shared.comes([&] { return shared.session.scene().structures.size() == 2; }));
  EXPECT_EQ(shared.session.scene().structures[0].name, "organs 3");
  EXPECT_EQ(shared.session.scene().structures[1].name, "organs 7");
}

TEST(OpenIgtRequests, MarksGoBothWays) {
  SharedSession shared;
  TestClient client(shared.server.port()), other(shared.server.port());
  const std::vector<Point> marks{{.name = "vessel", .position = {1, 2, 3}}};
  client.send({.type = "POINT", .device = marks_name, .content = content_of(marks)});
  std::vector<Point> got;
  EXPECT_TRUE(shared.comes([&] {
    if (const auto message = other.next("POINT", marks_name, 20)) got = points_of(message->content);
    return got.size() == 1;
  }));
  // And one that is made with the stylus, on the skin under it.
  ASSERT_TRUE(shared.comes([&] { return sent_n(shared) > 0.3; }));
  shared.session.press(mark_button);
  shared.look_for(std::chrono::milliseconds(100));
  shared.session.press(0);
  EXPECT_TRUE(shared.comes([&] {
    if (const auto message = other.next("POINT", marks_name, 20)) got = points_of(message->content);
    return got.size() == 2;
  }));
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].name, "vessel");
  EXPECT_EQ(got[1].name, "Mark 1");
  EXPECT_EQ(got[1].group, "skin");
  EXPECT_NEAR(got[1].position.z, 25, 0.6) << "RAS: the head's direction is the same";
}

TEST(OpenIgtRequests, AFolderIsLoadedAndASceneGoesOn) {
  SharedSession shared;
  std::string asked;
  shared.load = [&](const std::string& folder) {
    asked = folder;
    return LoadedScan{.volume = testing::ball_of_tissue(), .frame = {}};
  };
  TestClient client(shared.server.port());
  const auto before = shared.session.scan();
  client.send_text(folder_name, "/scans/other");
  EXPECT_TRUE(shared.comes([&] { return shared.session.scan() != before; }));
  EXPECT_EQ(asked, "/scans/other");
  EXPECT_EQ(shared.session.scene().name, "CT: skin and bone");
  EXPECT_TRUE(shared.comes([&] { return sent_n(shared) > 0.3; }));
}

/// A folder whose loading takes until it is let go.
struct SlowFolder {
  std::promise<void> begun, let_go;
  std::shared_future<void> until = let_go.get_future().share();

  LoadedScan load() {
    begun.set_value();
    until.wait();
    return {.volume = testing::ball_of_tissue(), .frame = {}};
  }
};

TEST(OpenIgtRequests, OfWhatComesWhileOneIsPreparedTheNewestIsFelt) {
  SharedSession shared;
  SlowFolder slow;
  shared.load = [&](const std::string&) { return slow.load(); };
  TestClient client(shared.server.port());
  client.send_text(folder_name, "/scans/slow");
  auto begun = slow.begun.get_future();
  ASSERT_TRUE(shared.comes([&] { return begun.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }));
  constexpr int scenes = 40;
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  for (int n = 0; n < scenes; ++n) {
    scene.name = "scene " + std::to_string(n);
    client.send_text(scene_name, modes::to_json(scene));
    shared.look();
  }
  EXPECT_TRUE(shared.comes([&] { return shared.server.counts().taken == scenes + 1U; }));
  EXPECT_EQ(shared.server.counts().outrun, scenes - 1U) << "they wait where the newest takes the place of the others";
  slow.let_go.set_value();
  EXPECT_TRUE(shared.comes([&] { return shared.session.scene().name == "scene 39"; }));
}

TEST(OpenIgtRequests, WhatTheOwnerDoesMeanwhileStays) {
  SharedSession shared;
  std::promise<void> begun, let_go;
  auto until = let_go.get_future().share();
  std::atomic<int> loads{0};
  shared.load = [&, until](const std::string&) {
    if (++loads == 1) begun.set_value();
    until.wait();
    return LoadedScan{.volume = testing::ball_of_tissue(), .frame = {}};
  };
  TestClient client(shared.server.port());
  const auto before = shared.session.scan();
  client.send_text(folder_name, "/scans/slow");
  auto has_begun = begun.get_future();
  ASSERT_TRUE(shared.comes([&] { return has_begun.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }));
  modes::Scene own = shared.session.scene();
  own.name = "the owner's";
  own.limits.force_n = 1;
  shared.session.set_scene(own);
  let_go.set_value();
  EXPECT_TRUE(shared.comes([&] { return shared.session.scan() != before; }));
  EXPECT_EQ(loads, 2) << "prepared again, of the owner's scene";
  EXPECT_EQ(shared.session.scene().name, "the owner's");
  EXPECT_EQ(shared.session.scene().limits.force_n, 1);
}

TEST(OpenIgtRequests, ANameThatIsNoTextIsTold) {
  SharedSession shared;
  TestClient client(shared.server.port());
  client.send(ball_of_labels("L\xe4sion \xff", glm::dvec3(0), 10));
  ASSERT_TRUE(shared.comes([&] { return shared.session.scene().structures.size() == 1; }));
  std::string said;
  EXPECT_TRUE(shared.comes([&] {
    if (const auto message = client.next("STRING", scene_name, 20)) said = string_of(message->content);
    return said.find("L\xef\xbf\xbdsion") != std::string::npos;
  })) << said;
}

TEST(OpenIgtRequests, ARefusedMapIsNotKept) {
  SharedSession shared;
  TestClient client(shared.server.port());
  for (int n = 0; n < 3; ++n) {
    client.send(ball_of_labels("nothing", glm::dvec3(0), -1));
    ASSERT_EQ(text_of_status(shared, client, "refused"), "refused: nothing: there are no labels or structures in it");
  }
  EXPECT_TRUE(std::filesystem::is_empty(shared.received.fresh_file("another").parent_path()));
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

TEST(OpenIgtRequests, FilesAreNamedByClientsOfThisMachineAlone) {
  const Server::Request near{.client = 1, .from_this_machine = true, .message = {}};
  const Server::Request far{.client = 1, .from_this_machine = false, .message = {}};
  EXPECT_NO_THROW(internal::check_file(near, "/scans/liver.nrrd"));
  EXPECT_THROW(internal::check_file(far, "/scans/liver.nrrd"), Refusal);
  modes::Scene felt, wanted;
  felt.structures = {{.name = "liver", .file = "/scans/liver.nrrd"}};
  wanted.structures = {{.name = "drawn", .file = ""}, {.name = "liver", .file = "/scans/liver.nrrd"}};
  EXPECT_NO_THROW(internal::check_files(far, wanted, felt)) << "contours name no file, and the liver's is felt already";
  wanted.structures.push_back({.name = "spleen", .file = "/scans/spleen.nrrd"});
  EXPECT_THROW(internal::check_files(far, wanted, felt), Refusal);
  EXPECT_NO_THROW(internal::check_files(near, wanted, felt));
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
