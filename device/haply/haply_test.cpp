#include "device/haply/haply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "device/haply/haply_driver.h"
#include "device/testing/fake_haply.h"

namespace palpate::device {
namespace {

using Json = nlohmann::json;

struct Bench {
  FakeHaply service;
  std::unique_ptr<LinkStylus> stylus;

  explicit Bench(const HaplySettings& settings = {}) {
    LinkStylusOptions options;
    options.threaded = false;
    stylus = make_haply_on(
        settings, [this] { return std::make_unique<FakeHaplyLink>(service); }, options);
  }
  void run(double seconds, const Vec3& force = Vec3(0)) {
    const double end = service.time + seconds;
    while (service.time < end) {
      stylus->write_force(force);
      stylus->service(1e-3);
    }
  }
  /// N, that acts; the service's frame.
  Vec3 force() const { return service.acting(service.time); }
  void expect_refusal(const std::string& why) {
    try {
      stylus->open();
      FAIL() << "not refused: " << why;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("Haply"));
      EXPECT_THAT(error.what(), ::testing::HasSubstr(why));
    }
  }
};

TEST(Haply, PosesAndForcesChangeFrames) {
  Bench bench;
  bench.service.place = {0.01, 0.02, 0.03};
  bench.stylus->open();
  bench.run(0.4, Vec3(0.1, 0.2, 0.3));
  EXPECT_LT(glm::distance(bench.stylus->read().position, Vec3(0.01, 0.03, -0.02)), 1e-12);
  EXPECT_LT(glm::distance(bench.force(), Vec3(0.1, -0.3, 0.2)), 1e-5);
  EXPECT_EQ(bench.stylus->state(), State::idle);
}

TEST(Haply, TheFirstMessageNamesTheSessionAndTheMiddleOfTheWorkspace) {
  Bench bench;
  bench.stylus->open();
  bench.run(0.02);
  const Json& first = bench.service.first_message;
  EXPECT_EQ(first.at("session").at("configure").at("profile").at("name"), "org.palpate:session");
  EXPECT_EQ(first.at("inverse3").at(0).at("configure").at("preset"), "arm_front_centered");
  EXPECT_EQ(first.at("inverse3").at(0).at("device_id"), "049D");
}

TEST(Haply, SpeaksBothSpellingsOfAForce) {
  for (const int minor : {1, 5}) {
    Bench bench;
    bench.service.version = {3, minor};
    bench.service.spelling = minor == 1 ? "values" : "vector";
    bench.stylus->open();
    bench.run(0.4, Vec3(1, 0, 0));
    EXPECT_EQ(bench.force(), Vec3(1, 0, 0)) << minor;
  }
}

TEST(Haply, FindsTheSpellingWhereTheVersionMisleads) {
  Bench bench;
  bench.service.version = {0, 0};
  bench.service.spelling = "values";
  bench.stylus->open();
  bench.run(0.5, Vec3(1, 0, 0));
  EXPECT_EQ(bench.force(), Vec3(1, 0, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::none);
}

TEST(Haply, AServiceThatHeedsNoSpellingIsAFault) {
  Bench bench;
  bench.service.spelling = "another";
  bench.stylus->open();
  bench.run(1, Vec3(1, 0, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::forces_refused);
}

TEST(Haply, ReadsTheGripsButtonsAndTurn) {
  Bench bench;
  bench.stylus->open();
  bench.run(0.05);
  const Reading reading = bench.stylus->read();
  EXPECT_EQ(reading.buttons, 2U);
  // A quarter turn about the service's z, up: right goes to away from the user.
  EXPECT_LT(glm::distance(reading.orientation * Vec3(1, 0, 0), Vec3(0, 0, -1)), 1e-12);
}

TEST(Haply, WaitsUntilTheDeviceIsReady) {
  Bench bench;
  bench.service.ready = false;
  bench.stylus->open();
  bench.run(0.1, Vec3(1, 0, 0));
  EXPECT_EQ(bench.stylus->state(), State::homing);
  EXPECT_EQ(bench.force(), Vec3(0));
  bench.service.ready = true;
  bench.run(0.4, Vec3(1, 0, 0));
  EXPECT_EQ(bench.force(), Vec3(1, 0, 0));
}

TEST(Haply, OneMessageIsUnderWayAtATime) {
  Bench bench;
  bench.stylus->open();
  bench.service.delay = 0.030;  // so late that it is asked again
  bench.run(0.2);
  bench.service.delay = 0.3e-3;
  bench.run(0.3);
  const int before = bench.service.messages;
  bench.run(0.3);
  EXPECT_LE(bench.service.to_client.size(), 1U);
  EXPECT_GT(bench.service.messages - before, 250);
}

TEST(Haply, WhatGoesWrongEndsWithoutForce) {
  const struct {
    const char* what;
    std::function<void(FakeHaply&)> cause;
    LinkFault fault;
  } cases[] = {{"gone", [](FakeHaply& s) { s.gone = true; }, LinkFault::unplugged},
               {"the arm is unplugged", [](FakeHaply& s) { s.loses_device = true; }, LinkFault::unplugged},
               {"silent", [](FakeHaply& s) { s.silent = true; }, LinkFault::silent},
               {"garbage", [](FakeHaply& s) { s.garbles = true; }, LinkFault::silent},
               {"half messages", [](FakeHaply& s) { s.halves = true; }, LinkFault::silent},
               {"a place that cannot be", [](FakeHaply& s) { s.place = Vec3(5, 0, 0); }, LinkFault::unreachable_pose}};
  for (const auto& one : cases) {
    Bench bench;
    bench.stylus->open();
    bench.run(0.4, Vec3(1, 0, 0));
    ASSERT_EQ(bench.force(), Vec3(1, 0, 0));
    one.cause(bench.service);
    bench.run(0.3, Vec3(1, 0, 0));
    EXPECT_EQ(bench.stylus->fault(), one.fault) << one.what;
    EXPECT_TRUE(bench.service.gone || bench.force() == Vec3(0)) << one.what;
  }
}

TEST(Haply, SaysWhatIsMissing) {
  Bench none;
  none.service.ids = {};
  none.expect_refusal(
      ": its service runs but finds no such device; check its plug and power, or list what is there: palpate devices");
  Bench two;
  two.service.ids = {"049D", "049E"};
  two.expect_refusal("there are 2; name the address of one");
  Bench mute;
  mute.service.silent = true;
  mute.expect_refusal(
      "Haply: its service does not tell which devices there are; start it again: sudo systemctl restart "
      "haply-inverse-service");
  try {
    make_haply({.port = 1})->open();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("Haply: its service does not answer at localhost:1 ("));
    EXPECT_THAT(error.what(),
                ::testing::HasSubstr("); install Haply Hub or the Inverse Service and start it: sudo systemctl start "
                                     "haply-inverse-service"));
  }
  try {
    make_haply({.maximum_force = 0});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "Haply: the largest force lies between 0 and 12 N");
  }
  Bench newer;
  newer.service.version = {4, 0};
  newer.expect_refusal(
      "Haply: its service is version 4; this driver speaks the protocol of version 3. Install service 3.5");
}

TEST(Haply, TellsWhatChangesWhatIsFelt) {
  const auto devices = haply_inventory(FakeHaply().inventory());
  ASSERT_EQ(devices.size(), 1U);
  EXPECT_THAT(describe(devices[0]), ::testing::HasSubstr("gravity compensation on"));
  EXPECT_THAT(describe(devices[0]), ::testing::HasSubstr("force gate 0.30"));
}

TEST(Haply, ReadsAllThatTheInventoryTells) {
  const auto devices = haply_inventory(
      R"({"inverse3": [{"device_id": "04A1", "config": {"type": "inverse3x", "handedness": "left",
          "gravity_compensation": {"enabled": true}, "torque_scaling": {"enabled": false},
          "filters": {"force_gate": {"gain": 0.25}, "damping": {"scalar": 0.5}}}},
          {"device_id": "04A2", "config": {"type": "minverse", "handedness": "right",
          "gravity_compensation": {"enabled": false}, "torque_scaling": {"enabled": true}}}]})");
  ASSERT_EQ(devices.size(), 2U);
  EXPECT_EQ(devices[0].id, "04A1");
  EXPECT_EQ(devices[0].type, "inverse3x");
  EXPECT_EQ(devices[0].handedness, "left");
  EXPECT_TRUE(devices[0].gravity_compensated);
  EXPECT_FALSE(devices[0].torque_scaled);
  EXPECT_EQ(devices[0].force_gate, 0.25);
  EXPECT_EQ(devices[0].damping, 0.5);
  EXPECT_EQ(devices[1].handedness, "right");
  EXPECT_FALSE(devices[1].gravity_compensated);
  EXPECT_TRUE(devices[1].torque_scaled);
  EXPECT_EQ(devices[1].force_gate, 0);
}

TEST(Haply, AnArmWithoutAGripIsNotTurned) {
  Bench bench;
  bench.service.has_grip = false;
  bench.service.place = {0.01, 0.02, 0.03};
  bench.stylus->open();
  EXPECT_EQ(bench.stylus->specification().orientation_axes, 0);
  bench.run(0.05);
  const Reading reading = bench.stylus->read();
  EXPECT_LT(glm::distance(reading.position, Vec3(0.01, 0.03, -0.02)), 1e-12);
  EXPECT_EQ(reading.orientation, glm::dquat(1, 0, 0, 0));
  EXPECT_EQ(reading.buttons, 0U);
}

TEST(Haply, KnowsTheSmallArm) {
  Bench bench;
  bench.service.type = "minverse";
  bench.stylus->open();
  EXPECT_EQ(bench.stylus->specification().name, "Haply Minverse");
  EXPECT_NEAR(glm::length(bench.stylus->specification().workspace_half_extent), 0.04, 1e-12);
}

TEST(Haply, ReadsTheServicesVersion) {
  EXPECT_EQ(parse_haply_version(R"({"project_version": "3.5.0", "git_tag": "x"})").minor, 5);
  EXPECT_EQ(parse_haply_version(R"({"project_version": "new"})").major, 0);
  EXPECT_EQ(parse_haply_version("").major, 0);
}

}  // namespace
}  // namespace palpate::device
