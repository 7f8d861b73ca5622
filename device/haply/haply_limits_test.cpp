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
#include "device/testing/fake_haply.h"

namespace palpate::device {
namespace {

using Json = nlohmann::json;

std::string refused(const std::function<void()>& run) {
  try {
    run();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

/// A session whose answers are the test's.
struct Session {
  FakeHaply service;
  FakeHaplyLink link{service};
  HaplyProtocol protocol;
  std::vector<std::uint8_t> packet = std::vector<std::uint8_t>(1 << 16);

  explicit Session(const HaplySettings& settings = {}) : protocol(settings) { protocol.connect(link); }
  void answer(const Json& message) {
    const std::string text = message.dump();
    protocol.receive({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, service.time);
  }
  /// The next message; null where none is due.
  Json step(const Vec3& force = Vec3(0)) {
    const std::size_t size = protocol.step(force, service.time, packet);
    return size == 0 ? Json() : Json::parse(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
  }
  const ProtocolStatus& status() const { return protocol.status(); }
};

Json vector_json(const Vec3& v) {
  return {{"x", v.x}, {"y", v.y}, {"z", v.z}};
}

Json arm_at(const Vec3& place, const Vec3& acting = Vec3(0)) {
  const Json arm{{"device_id", "049D"},
                 {"state", {{"cursor_position", vector_json(place)}, {"current_cursor_force", vector_json(acting)}}},
                 {"status", {{"calibrated", true}, {"ready", true}}}};
  return {{"inverse3", Json::array({arm})}};
}

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

/// Before 3.5 a force's numbers are "values"; where no version is told the newer spelling is tried first.
TEST(HaplyLimits, EachVersionHasItsSpelling) {
  for (const auto& [major, minor] : {std::pair{3, 0}, {3, 4}, {3, 5}, {3, 6}, {2, 9}, {0, 0}}) {
    FakeHaply service;
    service.version = {major, minor};
    FakeHaplyLink link(service);
    HaplyProtocol protocol({});
    protocol.connect(link);
    const char* const spelled = major == 3 && minor < 5 ? "values" : "vector";
    EXPECT_TRUE(service.first_message["inverse3"][0]["commands"]["set_cursor_force"].contains(spelled))
        << major << "." << minor;
  }
}

/// A message is JSON, whatever the force: to 0.01 mN, turned, and no longer than the largest.
TEST(HaplyLimits, EachForceIsToldInItsNumbers) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Session session({.maximum_force = 2.5});
  Vec3 acting(0);
  for (int n = 0; n < 300; ++n) {
    session.answer(arm_at(Vec3(0), acting));
    const double x = normal(random), y = normal(random), z = normal(random);
    const Vec3 force = std::pow(10.0, n % 6 - 3) * Vec3(x, y, z);
    const Json told = session.step(force);
    ASSERT_EQ(told["inverse3"].size(), 1U);
    EXPECT_EQ(told["inverse3"][0]["device_id"], "049D");
    const Json& sent = told["inverse3"][0]["commands"]["set_cursor_force"]["vector"];
    const Vec3 wanted = force * std::min(1.0, 2.5 / glm::length(force));
    EXPECT_NEAR(sent["x"], wanted.x, 0.51e-5);
    EXPECT_NEAR(sent["y"], -wanted.z, 0.51e-5);
    EXPECT_NEAR(sent["z"], wanted.y, 0.51e-5);
    acting = {wanted.x, -wanted.z, wanted.y};
  }
}

/// A message waits for the answer to the one before, or for 20 ms; what is sent without an answer pushes nothing, and
/// the surplus answer is waited for.
TEST(HaplyLimits, AMessageWithoutAnAnswerIsSentAgainAfterItsTime) {
  Session session;
  session.answer(arm_at(Vec3(0)));
  const auto force_of = [](const Json& message) {
    return message["inverse3"][0]["commands"]["set_cursor_force"]["vector"]["x"].get<double>();
  };
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(force_of(session.step(Vec3(1, 0, 0))), 1);
    session.service.time += 0.0199;
    EXPECT_TRUE(session.step(Vec3(1, 0, 0)).is_null());
    session.service.time += 0.0002;
    EXPECT_EQ(force_of(session.step(Vec3(1, 0, 0))), 0);
    session.answer(arm_at(Vec3(0)));
    EXPECT_TRUE(session.step(Vec3(1, 0, 0)).is_null()) << "one is still under way";
    session.answer(arm_at(Vec3(0)));
  }
  session.answer(arm_at(Vec3(0)));  // one more than was asked for is not counted against the next
  EXPECT_EQ(force_of(session.step(Vec3(1, 0, 0))), 1);
  EXPECT_TRUE(session.step(Vec3(1, 0, 0)).is_null());
}

/// Twenty milliseconds are enough, and a hair less is not. From zero on, of which differences are exact.
TEST(HaplyLimits, AnAnswerIsWaitedForTwentyMilliseconds) {
  constexpr double enough = 0.020;
  for (const double waited : {enough, std::nextafter(enough, 0.0)}) {
    Session session;
    session.answer(arm_at(Vec3(0)));
    session.service.time = 0;
    EXPECT_FALSE(session.step().is_null());
    session.service.time = waited;
    EXPECT_EQ(session.step().is_null(), waited < enough);
  }
}

/// A hundred answers in a row that tell of less than a tenth of what was sent; the other spelling is then tried for a
/// hundred more. A force of less than 0.1 N tells nothing.
TEST(HaplyLimits, AForceThatIsNotHeededIsNoticedAfterAHundredAnswers) {
  const struct {
    double sent, acts;
    bool unheeded;
  } cases[] = {{1, 0.099, true}, {1, 0.101, false}, {0.099, 0, false}, {0.101, 0, true}};
  for (const auto& one : cases) {
    Session session;
    session.answer(arm_at(Vec3(0)));
    for (int n = 0; n < 300; ++n) {
      const Json sent = session.step(Vec3(0, one.sent, 0));
      const bool switched = one.unheeded && n >= 100;
      if (session.status().state == State::idle) {
        EXPECT_TRUE(sent["inverse3"][0]["commands"]["set_cursor_force"].contains(switched ? "values" : "vector")) << n;
      }
      EXPECT_EQ(session.status().fault, one.unheeded && n >= 200 ? LinkFault::forces_refused : LinkFault::none) << n;
      session.answer(arm_at(Vec3(0), Vec3(0, 0, one.acts)));
    }
    ASSERT_TRUE(session.protocol.acting_force());
    EXPECT_EQ(*session.protocol.acting_force(), Vec3(0, 0, one.acts));
  }
}

/// One answer that tells of the force begins the hundred anew.
TEST(HaplyLimits, OnlyAnswersInARowCount) {
  Session session;
  session.answer(arm_at(Vec3(0)));
  for (int n = 1; n <= 500; ++n) {
    session.step(Vec3(1, 0, 0));
    session.answer(arm_at(Vec3(0), Vec3(n % 100 == 0 ? 1 : 0, 0, 0)));
    EXPECT_EQ(session.status().fault, LinkFault::none);
  }
  EXPECT_TRUE(session.step(Vec3(1, 0, 0))["inverse3"][0]["commands"]["set_cursor_force"].contains("vector"));
}

/// A link that tells of no version.
class PlainLink final : public Link {
 public:
  explicit PlainLink(FakeHaply& service) : link_(service) {}
  double now() noexcept override { return link_.now(); }
  bool lost() const noexcept override { return link_.lost(); }
  bool flush(double timeout) noexcept override { return link_.flush(timeout); }
  bool send(std::span<const std::uint8_t> bytes) noexcept override { return link_.send(bytes); }
  std::size_t receive(std::span<std::uint8_t> bytes, double timeout) noexcept override {
    return link_.receive(bytes, timeout);
  }

 private:
  FakeHaplyLink link_;
};

/// Whatever a session before has found out: connected anew, the newer spelling is tried first again, no force is told
/// to act, nothing is under way and nothing is held against the service.
TEST(HaplyLimits, ConnectedAnewItKnowsNothingOfBefore) {
  Session session;
  session.answer(arm_at({0.1, 0.2, 0.3}));
  const std::uint64_t news = session.status().news;
  EXPECT_GT(news, 0U);
  for (int n = 0; n < 150; ++n) {
    session.step(Vec3(1, 0, 0));
    session.answer(arm_at(Vec3(0)));
  }
  session.step(Vec3(1, 0, 0));
  const std::uint64_t before = session.status().news;
  PlainLink again(session.service);
  session.protocol.connect(again);
  EXPECT_EQ(session.status().state, State::homing);
  EXPECT_EQ(session.status().position, Vec3(0));
  EXPECT_EQ(session.status().news, before) << "poses are counted on";
  EXPECT_FALSE(session.protocol.acting_force());
  EXPECT_TRUE(session.step(Vec3(1, 0, 0)).is_null()) << "its first message is under way";
  session.answer(arm_at(Vec3(0)));
  for (int n = 0; n < 100; ++n) {
    EXPECT_TRUE(session.step(Vec3(1, 0, 0))["inverse3"][0]["commands"]["set_cursor_force"].contains("vector")) << n;
    session.answer(arm_at(Vec3(0)));
  }
  EXPECT_EQ(session.status().fault, LinkFault::none);
}

TEST(HaplyLimits, NoArmReachesFartherThanAMetre) {
  for (const double reach : {0.999, 1.001}) {
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0.6, 0, -0.8)}) {
      Session session;
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
  Session session;
  session.answer(arm_at({0.1, 0.2, 0.3}));
  Json message = arm_at(Vec3(0));
  message["inverse3"][0]["state"]["cursor_position"] = {{"y", 0.25}};
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
    Session session;
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
  Session session;
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
        Session session;
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

TEST(HaplyLimits, ItsSettingsLieWithinTheirLimits) {
  const struct {
    double force, stiffness;
    bool taken;
  } cases[] = {{0, 400, false}, {1e-9, 400, true}, {20, 400, true},  {20.01, 400, false},
               {3, 0, false},   {3, 1e-9, true},   {-1, 400, false}, {3, -1, false}};
  for (const auto& one : cases) {
    const auto make = [&] { make_haply({.maximum_force = one.force, .stiffness_limit = one.stiffness}); };
    EXPECT_EQ(refused(make).empty(), one.taken) << one.force << " " << one.stiffness;
  }
}

/// Two seconds for its first message, and no longer.
TEST(HaplyLimits, ItsFirstMessageIsWaitedForTwoSeconds) {
  for (const double comes_s : {1.95, 2.1}) {
    FakeHaply service;
    FakeHaplyLink link(service);
    service.to_client[0].first = comes_s;
    HaplyProtocol protocol({});
    EXPECT_EQ(refused([&] { protocol.connect(link); }).empty(), comes_s < 2);
    EXPECT_NEAR(service.time, std::min(comes_s, 2.0), 0.011);
  }
}

}  // namespace
}  // namespace palpate::device
