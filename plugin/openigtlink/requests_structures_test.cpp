// Requests of clients: label maps, structures of files, and marks.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "plugin/openigtlink/marks.h"
#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/requests.h"
#include "plugin/openigtlink/surface.h"
#include "plugin/openigtlink/testing/asked_session.h"
#include "plugin/recording/recorded_session.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin::igtl {
namespace {

using testing::ball_of_labels;
using testing::sent_n;
using testing::SharedSession;
using testing::TestClient;
using testing::text_of_status;

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

/// While the force falls before the mapping changes, and after it: the same mark as its recording has.
struct MarkWhereTheSceneMoves : ::testing::TestWithParam<bool> {};

TEST_P(MarkWhereTheSceneMoves, IsWhereItWasFelt) {
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  scene.workspace = {.center_mm = glm::dvec3(0), .scale = 1, .fit = false};
  scene.limits.ramp_s = 1;
  SharedSession shared(LiveSession::Start::feeling, 0.022, scene);
  const auto file = plugin::testing::fresh_path("moving.h5");
  shared.session.record(file);
  TestClient client(shared.server.port());
  ASSERT_TRUE(shared.comes([&] { return sent_n(shared) > 0.3; }));
  scene.workspace.center_mm = glm::dvec3(50, 0, 0);
  scene.modes.insert(scene.modes.begin(), scene.modes.back());  // the modes have other numbers than before
  scene.modes.front().name = "another";
  shared.session.set_scene(scene);
  const std::uint32_t epoch = shared.session.epoch();
  if (GetParam()) {
    ASSERT_TRUE(shared.comes([&] { return shared.last_tick().scene_epoch == epoch; }));
  }
  shared.session.press(mark_button);
  shared.look_for(std::chrono::milliseconds(30));
  shared.session.press(0);
  std::vector<Point> got;
  ASSERT_TRUE(shared.comes([&] {
    if (const auto message = client.next("POINT", marks_name, 20)) got = points_of(message->content);
    return got.size() == 1;
  }));
  shared.session.stop_recording();
  const RecordedSession recorded(read_recording(file), *testing::ball_of_tissue());
  const Marks marks = marks_of(recorded);
  ASSERT_EQ(marks.points.size(), 1U);
  EXPECT_LT(glm::distance(lps_of(got[0].position), marks.points[0].position_mm), 1e-3)
      << marks.points[0].position_mm.x << " mm";
  EXPECT_NEAR(marks.points[0].position_mm.x, GetParam() ? 50 : 0, 5);
  // A tick of the scene before is told without its boundary.
  EXPECT_EQ(got[0].group, GetParam() ? marks.points[0].boundary : "");
}

INSTANTIATE_TEST_SUITE_P(OpenIgtRequests, MarkWhereTheSceneMoves, ::testing::Bool());

/// A tick is told of by its own scene: what the newer one has under the same number is another boundary.
TEST(OpenIgtRequests, AMarkMadeBeforeAChangeHasNoBoundaryOfTheSceneAfterIt) {
  SharedSession shared;
  TestClient client(shared.server.port());
  ASSERT_TRUE(shared.comes([&] { return sent_n(shared) > 0.3; }));
  modes::Scene scene = shared.session.scene();
  for (modes::Mode& mode : scene.modes) mode.name += ", renamed";
  // Without a look in between: the press is read after the scene has changed.
  shared.session.press(mark_button);
  std::this_thread::sleep_for(std::chrono::milliseconds(40));
  shared.session.press(0);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  shared.session.set_scene(scene);
  std::vector<Point> got;
  ASSERT_TRUE(shared.comes([&] {
    if (const auto message = client.next("POINT", marks_name, 20)) got = points_of(message->content);
    return got.size() == 1;
  }));
  EXPECT_EQ(got[0].group, "");
}

/// A client may take any name: a mark that is felt gets another.
TEST(OpenIgtRequests, AFeltMarkHasANameOfItsOwn) {
  SharedSession shared;
  TestClient client(shared.server.port());
  std::vector<Point> got;
  const auto comes = [&](std::size_t count) {
    return shared.comes([&] {
      if (const auto message = client.next("POINT", marks_name, 20)) got = points_of(message->content);
      return got.size() == count;
    });
  };
  const auto press = [&] {
    shared.session.press(mark_button);
    shared.look_for(std::chrono::milliseconds(50));
    shared.session.press(0);
  };
  const std::vector<Point> marks{{.name = "Mark 1", .position = {1, 2, 3}}, {.name = "Mark 3", .position = {4, 5, 6}}};
  client.send({.type = "POINT", .device = marks_name, .content = content_of(marks)});
  ASSERT_TRUE(comes(2));
  press();
  ASSERT_TRUE(comes(3));
  EXPECT_EQ(got[2].name, "Mark 2");
  press();
  ASSERT_TRUE(comes(4));
  EXPECT_EQ(got[3].name, "Mark 4");
}

/// A list may be older than the last press: what it leaves out stays.
TEST(OpenIgtRequests, AnOlderListOfMarksRemovesNoneThatWasPressed) {
  SharedSession shared;
  TestClient client(shared.server.port());
  std::vector<Point> got;
  const auto comes = [&](const auto& holds) {
    return shared.comes([&] {
      if (const auto message = client.next("POINT", marks_name, 20)) got = points_of(message->content);
      return holds();
    });
  };
  const auto send = [&](const std::vector<Point>& marks) {
    client.send({.type = "POINT", .device = marks_name, .content = content_of(marks)});
  };
  shared.session.press(mark_button);
  shared.look_for(std::chrono::milliseconds(50));
  shared.session.press(0);
  ASSERT_TRUE(comes([&] { return got.size() == 1; }));
  EXPECT_EQ(got[0].name, "Mark 1");
  send({{.name = "vessel", .position = {1, 2, 3}}});
  ASSERT_TRUE(comes([&] { return got.size() == 2; }));
  EXPECT_EQ(got[0].name, "Mark 1");
  EXPECT_EQ(got[1].name, "vessel");
  send({{.name = "vessel", .position = {4, 5, 6}}, {.name = "", .position = {7, 8, 9}}});
  ASSERT_TRUE(comes([&] { return got.size() == 3; }));
  EXPECT_EQ(got[1].position, glm::dvec3(4, 5, 6)) << "moved";
  EXPECT_EQ(got[2].name, "Mark 2");
  std::vector<Point> too_many(most_marks);
  for (std::size_t n = 0; n < most_marks; ++n) too_many[n].name = "m" + std::to_string(n);
  send(too_many);
  EXPECT_EQ(text_of_status(shared, client, "refused"),
            "refused: with these there would be 1027 marks; at most 1024 are kept");
}

TEST(OpenIgtRequests, AMapThatCannotBeKeptForReplayIsTold) {
  const auto taken = plugin::testing::fresh_path("taken"), map = plugin::testing::fresh_path("map.nrrd");
  std::ofstream(taken) << "a file, and no folder";
  std::ofstream(map) << "labels";
  ::testing::internal::CaptureStderr();
  {
    Received received(taken);
    received.use("organ", map);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "palpate: label map \"organ\": cannot be kept for replay in " + taken.string() + ": Not a directory\n");
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

}  // namespace
}  // namespace palpate::plugin::igtl
