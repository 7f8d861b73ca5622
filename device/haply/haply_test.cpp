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

namespace palpate::device {
namespace {

using Json = nlohmann::json;

/// The service as its documents have it: an inventory first, then one state for each message. On a clock that runs only
/// while somebody waits; x right, y away from the user, z up.
struct Service {
  double time = 0;
  HaplyVersion version{3, 5};
  std::string spelling = "vector";  ///< of a force's components: what this service reads
  std::vector<std::string> ids{"049D"};
  std::string type = "inverse3";
  Vec3 place{0};  // m
  Vec3 force{0};  // N, that acts
  bool ready = true;
  bool silent = false, gone = false, garbles = false, halves = false, loses_device = false;
  double delay = 0.3e-3;
  Json first_message;
  int messages = 0;
  std::vector<std::pair<double, std::string>> to_client;

  void start() { to_client = {{time, inventory()}}; }
  static Json vector(const Vec3& v) { return {{"x", v.x}, {"y", v.y}, {"z", v.z}}; }
  std::string inventory() const {
    Json list = Json::array();
    for (const std::string& id : ids) {
      list.push_back({{"device_id", id},
                      {"config",
                       {{"type", type},
                        {"handedness", "right"},
                        {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 1.0}}},
                        {"torque_scaling", {{"enabled", true}}},
                        {"filters", {{"force_gate", {{"gain", 0.3}}}, {"damping", {{"scalar", 0.0}}}}}}},
                      {"state", {{"cursor_position", vector(place)}}},
                      {"status", {{"calibrated", ready}, {"ready", ready}}}});
    }
    return Json{{"session_id", 7}, {"inverse3", list}, {"wireless_verse_grip", Json::array()}}.dump();
  }
  std::string state() const {
    Json list = Json::array();
    if (!loses_device) {
      list.push_back({{"device_id", ids.front()},
                      {"state", {{"cursor_position", vector(place)}, {"current_cursor_force", vector(force)}}},
                      {"status", {{"calibrated", ready}, {"ready", ready}}}});
    }
    const Json grip{{"device_id", "61576"},
                    {"state",
                     {{"buttons", {{"a", false}, {"b", true}, {"c", false}}},
                      {"orientation", {{"w", std::sqrt(0.5)}, {"x", 0.0}, {"y", 0.0}, {"z", std::sqrt(0.5)}}}}}};
    return Json{{"inverse3", list}, {"wireless_verse_grip", Json::array({grip})}}.dump();
  }
  void take(const std::string& text) {
    const Json message = Json::parse(text);
    if (messages++ == 0) first_message = message;
    force = Vec3(0);  // a command lasts one message
    const Json& commands = message.at("inverse3").at(0).at("commands").at("set_cursor_force");
    if (commands.contains(spelling)) {
      const Json& v = commands.at(spelling);
      force = {v.at("x").get<double>(), v.at("y").get<double>(), v.at("z").get<double>()};
    }
    std::string answer = garbles ? "{\"inverse3\": nonsense" : state();
    if (halves) answer.resize(answer.size() / 2);
    to_client.emplace_back(time + delay, answer);
  }
};

class ServiceLink final : public HaplyLink {
 public:
  explicit ServiceLink(Service& service) : service_(service) { service.start(); }
  HaplyVersion version() const noexcept override { return service_.version; }
  double now() noexcept override { return service_.time; }
  bool lost() const noexcept override { return service_.gone; }
  bool flush(double /*timeout*/) noexcept override { return !service_.gone; }
  bool send(std::span<const std::uint8_t> packet) noexcept override {
    if (!service_.gone) service_.take({packet.begin(), packet.end()});
    return !service_.gone;
  }
  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    const double end = service_.time + timeout;
    for (;;) {
      auto& waiting = service_.to_client;
      if (!service_.silent && !waiting.empty() && waiting.front().first <= service_.time) {
        const std::string text = waiting.front().second;
        waiting.erase(waiting.begin());
        std::copy(text.begin(), text.end(), packet.begin());
        return text.size();
      }
      if (service_.time >= end) return 0;
      service_.time = std::min(service_.time + 50e-6, end);
    }
  }

 private:
  Service& service_;
};

struct Bench {
  Service service;
  std::unique_ptr<LinkStylus> stylus;

  explicit Bench(const HaplySettings& settings = {}) {
    LinkStylusOptions options;
    options.threaded = false;
    stylus = make_haply_on(
        settings, [this] { return std::make_unique<ServiceLink>(service); }, options);
  }
  void run(double seconds, const Vec3& force = Vec3(0)) {
    const double end = service.time + seconds;
    while (service.time < end) {
      stylus->write_force(force);
      stylus->service(1e-3);
    }
  }
  void expect_refusal(const std::string& why) {
    try {
      stylus->open();
      FAIL() << "not refused: " << why;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("Haply"));
      EXPECT_THAT(error.what(), testing::HasSubstr(why));
    }
  }
};

TEST(Haply, PosesAndForcesChangeFrames) {
  Bench bench;
  bench.service.place = {0.01, 0.02, 0.03};
  bench.stylus->open();
  bench.run(0.05, Vec3(0.1, 0.2, 0.3));
  EXPECT_LT(glm::distance(bench.stylus->read().position, Vec3(0.01, 0.03, -0.02)), 1e-12);
  EXPECT_LT(glm::distance(bench.service.force, Vec3(0.1, -0.3, 0.2)), 1e-5);
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
    bench.run(0.02, Vec3(1, 0, 0));
    EXPECT_EQ(bench.service.force, Vec3(1, 0, 0)) << minor;
  }
}

TEST(Haply, FindsTheSpellingWhereTheVersionMisleads) {
  Bench bench;
  bench.service.version = {0, 0};
  bench.service.spelling = "values";
  bench.stylus->open();
  bench.run(0.5, Vec3(1, 0, 0));
  EXPECT_EQ(bench.service.force, Vec3(1, 0, 0));
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
  EXPECT_EQ(bench.service.force, Vec3(0));
  bench.service.ready = true;
  bench.run(0.1, Vec3(1, 0, 0));
  EXPECT_EQ(bench.service.force, Vec3(1, 0, 0));
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
    std::function<void(Service&)> cause;
    LinkFault fault;
  } cases[] = {{"gone", [](Service& s) { s.gone = true; }, LinkFault::unplugged},
               {"the arm is unplugged", [](Service& s) { s.loses_device = true; }, LinkFault::unplugged},
               {"silent", [](Service& s) { s.silent = true; }, LinkFault::silent},
               {"garbage", [](Service& s) { s.garbles = true; }, LinkFault::silent},
               {"half messages", [](Service& s) { s.halves = true; }, LinkFault::silent},
               {"a place that cannot be", [](Service& s) { s.place = Vec3(5, 0, 0); }, LinkFault::unreachable_pose}};
  for (const auto& one : cases) {
    Bench bench;
    bench.stylus->open();
    bench.run(0.1, Vec3(1, 0, 0));
    ASSERT_EQ(bench.service.force, Vec3(1, 0, 0));
    one.cause(bench.service);
    bench.run(0.3, Vec3(1, 0, 0));
    EXPECT_EQ(bench.stylus->fault(), one.fault) << one.what;
    EXPECT_TRUE(bench.service.gone || bench.service.force == Vec3(0)) << one.what;
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
    EXPECT_THAT(error.what(), testing::HasSubstr("Haply: its service does not answer at localhost:1 ("));
    EXPECT_THAT(error.what(),
                testing::HasSubstr("); install Haply Hub or the Inverse Service and start it: sudo systemctl start "
                                   "haply-inverse-service"));
  }
  try {
    make_haply({.maximum_force = 0});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "Haply: the largest force lies between 0 and 20 N, the stiffness limit above zero");
  }
  Bench newer;
  newer.service.version = {4, 0};
  newer.expect_refusal(
      "Haply: its service is version 4; this driver speaks the protocol of version 3. Install service 3.5");
}

TEST(Haply, TellsWhatChangesWhatIsFelt) {
  const auto devices = haply_inventory(Service().inventory());
  ASSERT_EQ(devices.size(), 1U);
  EXPECT_THAT(describe(devices[0]), testing::HasSubstr("gravity compensation on"));
  EXPECT_THAT(describe(devices[0]), testing::HasSubstr("force gate 0.30"));
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
