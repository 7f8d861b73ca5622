// Requests of clients: label maps, structures of files, and marks.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/requests.h"
#include "plugin/openigtlink/surface.h"
#include "plugin/openigtlink/testing/asked_session.h"

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
