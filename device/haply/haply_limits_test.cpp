/// The Haply's limits, each reached, and what its messages may hold: by the service's documents.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "device/haply/haply.h"
#include "device/haply/haply_driver.h"
#include "device/testing/haply_session.h"

namespace palpate::device {
namespace {

using Json = nlohmann::json;

Json inventory_of(const Json& device) {
  return {{"inverse3", Json::array({device})}};
}

Json with_grip(const char* list, const Json& state) {
  const Json grip{{"state", state}};
  Json message = arm_at(Vec3(0));
  message[list] = Json::array({grip});
  return message;
}

TEST(HaplyLimits, OfItsVersionTheFirstTwoNumbersCount) {
  const struct {
    const char* told;
    int major, minor;
  } versions[] = {{"3.5.0", 3, 5}, {"3.1", 3, 1}, {"12.34.56", 12, 34}, {"4", 0, 0},  {"3.", 0, 0},
                  {"3-5", 0, 0},   {"", 0, 0},    {"v3.5", 0, 0},       {"3.x", 0, 0}};
  for (const auto& one : versions) {
    const HaplyVersion version = parse_haply_version(Json{{"project_version", one.told}}.dump());
    EXPECT_EQ(version.major, one.major) << one.told;
    EXPECT_EQ(version.minor, one.minor) << one.told;
  }
  for (const char* const other : {"[]", "{\"project_version\": 3.5}", "nonsense", "3"}) {
    EXPECT_EQ(parse_haply_version(other).major, 0) << other;
  }
  EXPECT_EQ(HaplyVersion{}.major + HaplyVersion{}.minor, 0);
}

TEST(HaplyLimits, NoArmReachesFartherThanAMetre) {
  for (const double reach : {0.999, 1.001}) {
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0.6, 0, -0.8)}) {
      HaplySession session;
      session.answer(arm_at(reach * direction));
      EXPECT_EQ(session.status().fault, reach > 1 ? LinkFault::unreachable_pose : LinkFault::none);
      EXPECT_EQ(session.status().state, reach > 1 ? State::fault : State::idle);
      if (reach > 1) continue;
      EXPECT_LT(glm::distance(session.status().position, reach * Vec3(direction.x, direction.z, -direction.y)), 1e-12);
    }
  }
}

/// What is zero is left out.
TEST(HaplyLimits, ACoordinateThatIsNotToldIsZero) {
  HaplySession session;
  session.answer(arm_at({0.1, 0.2, 0.3}));
  Json message = arm_at(Vec3(0));
  message["inverse3"][0]["state"]["cursor_position"] = {{"y", 0.25}};
  session.step();
  session.answer(message);
  EXPECT_EQ(session.status().position, Vec3(0, 0, -0.25));
}

/// Either word alone says that it has to be readied; an arm of which neither is told is ready as soon as it tells a
/// pose.
TEST(HaplyLimits, AnArmIsReadyUnlessItSaysOtherwise) {
  const struct {
    Json status;
    State state;
  } cases[] = {{{{"calibrated", true}, {"ready", true}}, State::idle},
               {{{"calibrated", false}, {"ready", true}}, State::homing},
               {{{"calibrated", true}, {"ready", false}}, State::homing},
               {{{"ready", false}}, State::homing},
               {{{"calibrated", 0}}, State::idle},
               {Json::object(), State::idle},
               {Json(), State::idle}};
  for (const auto& one : cases) {
    HaplySession session;
    EXPECT_EQ(session.status().state, State::homing);
    Json message = arm_at(Vec3(0));
    message["inverse3"][0]["status"] = one.status;
    if (one.status.is_null()) message["inverse3"][0].erase("status");
    session.answer(message);
    EXPECT_EQ(session.status().state, one.state) << one.status.dump();
    const Json sent = session.step(Vec3(1, 0, 0));
    EXPECT_EQ(sent["inverse3"][0]["commands"]["set_cursor_force"]["vector"]["x"], one.state == State::idle ? 1 : 0);
  }
}

/// Three buttons of a wireless grip, and the one of a wired grip, told as a word or as a number.
TEST(HaplyLimits, EachButtonHasItsBit) {
  HaplySession session;
  const auto buttons_of = [&](const Json& message) {
    session.answer(message);
    return session.status().buttons;
  };
  for (unsigned bits = 0; bits < 8; ++bits) {
    const Json buttons{{"a", (bits & 1) != 0}, {"b", (bits & 2) != 0}, {"c", (bits & 4) != 0}};
    EXPECT_EQ(buttons_of(with_grip("wireless_verse_grip", {{"buttons", buttons}})), bits);
  }
  const std::pair<Json, unsigned> wired[] = {{true, 1}, {false, 0}, {1, 1}, {0, 0}, {0.5, 1}, {"down", 0}, {-1, 0}};
  for (const auto& [told, bits] : wired) {
    EXPECT_EQ(buttons_of(with_grip("verse_grip", {{"button", told}})), bits) << told.dump();
  }
  EXPECT_EQ(buttons_of(arm_at(Vec3(0))), 0U);
}

/// A turn is a quaternion of length 1, give or take a tenth. It turns the service's frame, which is ours about x.
TEST(HaplyLimits, AGripIsTurnedByAnyQuaternionOfLengthOne) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const auto ours = [](const Vec3& v) { return Vec3(v.x, v.z, -v.y); };
  for (const char* const list : {"wireless_verse_grip", "verse_grip"}) {
    for (const double length : {0.89, 0.91, 1.0, 1.09, 1.11}) {
      for (int n = 0; n < 10; ++n) {
        HaplySession session;
        const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
        const glm::dquat turn = glm::normalize(glm::dquat(w, x, y, z));
        session.answer(with_grip(
            list,
            {{"orientation",
              {{"w", length * turn.w}, {"x", length * turn.x}, {"y", length * turn.y}, {"z", length * turn.z}}}}));
        const glm::dquat told = session.status().orientation;
        EXPECT_NEAR(glm::length(told), 1, 1e-12);
        if (std::abs(length - 1) > 0.1) {
          EXPECT_EQ(told, glm::dquat(1, 0, 0, 0));
          continue;
        }
        for (const Vec3& v : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
          EXPECT_LT(glm::distance(told * ours(v), ours(turn * v)), 1e-12);
        }
      }
    }
  }
}

/// An id goes into messages as it is: one that is more than letters and numbers is of no device.
TEST(HaplyLimits, OnlyPlainIdsAreDevices) {
  for (const char* const id : {"", "04\"9D", "04 9D", "049D}", "04-9D"}) {
    EXPECT_TRUE(haply_inventory(inventory_of({{"device_id", id}}).dump()).empty()) << id;
  }
  EXPECT_EQ(haply_inventory(inventory_of({{"device_id", "04zZ"}}).dump()).size(), 1U);
  for (const char* const none : {"", "[]", "{}", R"({"inverse3": {}})", R"({"inverse3": 3})", R"({"inverse3": [1]})"}) {
    EXPECT_TRUE(haply_inventory(none).empty()) << none;
  }
}

TEST(HaplyLimits, WhatChangesWhatIsFeltIsToldInFull) {
  HaplyDevice device{.force_gate = 0.126, .damping = 2.5};
  for (const bool on : {false, true}) {
    device.gravity_compensated = on;
    device.torque_scaled = !on;
    EXPECT_EQ(describe(device), std::string("the service's own settings change what is felt: gravity compensation ") +
                                    (on ? "on" : "off") + ", torque scaling " + (on ? "off" : "on") +
                                    ", force gate 0.13, damping 2.50");
  }
}

/// The one that is named, whether it is the first or not.
TEST(HaplyLimits, TheArmThatIsNamedIsTaken) {
  for (const std::string id : {"A1", "B2", "C3"}) {
    FakeHaply service;
    service.ids = {"A1", "B2", "C3"};
    FakeHaplyLink link(service);
    HaplyProtocol protocol({.address = id, .preset = ""});
    protocol.connect(link);
    EXPECT_EQ(service.first_message["inverse3"][0]["device_id"], id);
    EXPECT_FALSE(service.first_message["inverse3"][0].contains("configure")) << "no preset is wanted";
  }
  FakeHaply service;
  FakeHaplyLink link(service);
  HaplyProtocol other({.address = "A1"});
  EXPECT_THAT(refused([&] { other.connect(link); }), ::testing::HasSubstr("Haply A1: its service runs"));
}

/// What the service listens at as it is installed.
TEST(HaplyLimits, ItsServiceIsLookedForWhereItIsInstalled) {
  const HaplySettings settings;
  EXPECT_EQ(settings.host, "localhost");
  EXPECT_EQ(settings.port, 10001);
  EXPECT_EQ(settings.events_port, 10020);
}

TEST(HaplyLimits, ItsSettingsLieWithinTheirLimits) {
  const struct {
    double force, stiffness;
    bool taken;
  } cases[] = {{0, 400, false}, {1e-9, 400, true}, {12, 400, true}, {12.01, 400, false}, {3, 0, false},
               {3, 3000, true}, {3, 3001, false},  {3, 1e-9, true}, {-1, 400, false},    {3, -1, false}};
  for (const auto& one : cases) {
    const auto make = [&] { make_haply({.maximum_force = one.force, .stiffness_limit = one.stiffness}); };
    EXPECT_EQ(refused(make).empty(), one.taken) << one.force << " " << one.stiffness;
  }
}

}  // namespace
}  // namespace palpate::device
