/// The Haply's exchange, message by message: what is sent, when, and what an answer comes to.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>

#include "device/testing/haply_session.h"

namespace palpate::device {
namespace {

using Json = nlohmann::json;

/// Before 3.5 a force's numbers are "values"; where no version is told the newer spelling is tried first.
TEST(HaplyExchange, EachVersionHasItsSpelling) {
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
TEST(HaplyExchange, EachForceIsToldInItsNumbers) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  HaplySession session({.maximum_force = 2.5});
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

/// A message waits for the answer to the one before, or for 20 ms. What is sent without an answer pushes nothing, and
/// the answers that are missing are waited for: in them is no pose of now. A force is sent after two that came in time.
TEST(HaplyExchange, AMessageWithoutAnAnswerIsSentAgainAfterItsTime) {
  HaplySession session;
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
    const std::uint64_t news = session.status().news;
    session.service.time += 0.003;
    session.answer(arm_at(Vec3(0, 0, 0.05)));
    EXPECT_TRUE(session.step(Vec3(1, 0, 0)).is_null()) << "one is still under way";
    EXPECT_TRUE(session.status().doubtful);
    session.service.time += 0.018;
    session.answer(arm_at(Vec3(0, 0, 0.05)));
    EXPECT_TRUE(session.status().doubtful) << "it is of a message 21 ms ago";
    for (int on_time = 0; on_time < 2; ++on_time) {
      EXPECT_EQ(session.status().news, news);
      EXPECT_EQ(session.status().position, Vec3(0));
      EXPECT_EQ(force_of(session.step(Vec3(1, 0, 0))), 0);
      EXPECT_TRUE(session.step(Vec3(1, 0, 0)).is_null());
      session.service.time += 0.001;
      session.answer(arm_at(Vec3(0)));
    }
    EXPECT_FALSE(session.status().doubtful);
    EXPECT_EQ(session.status().news, news + 1);
  }
}

/// Twenty milliseconds are enough, and a hair less is not. From zero on, of which differences are exact.
TEST(HaplyExchange, AnAnswerIsWaitedForTwentyMilliseconds) {
  constexpr double enough = 0.020;
  for (const double waited : {enough, std::nextafter(enough, 0.0)}) {
    HaplySession session;
    session.answer(arm_at(Vec3(0)));
    session.service.time = 0;
    EXPECT_FALSE(session.step().is_null());
    session.service.time = waited;
    EXPECT_EQ(session.step().is_null(), waited < enough);
  }
}

/// A hundred answers in a row that tell of less than a tenth of what was sent; the other spelling is then tried for a
/// hundred more. A force of less than 0.1 N tells nothing. After five it is a trial: the service is asked for 0.2 N at
/// most, as long as it does not heed.
TEST(HaplyExchange, AForceThatIsNotHeededIsNoticedAfterAHundredAnswers) {
  const struct {
    double asked, part;
    bool unheeded;
  } cases[] = {{1, 0.099, true}, {1, 0.101, false}, {0.099, 0, false}, {0.101, 0, true}, {3, 0.05, true}};
  for (const auto& one : cases) {
    HaplySession session;
    session.answer(arm_at(Vec3(0)));
    double acts = 0;
    for (int n = 0; n < 300; ++n) {
      const Json sent = session.step(Vec3(0, one.asked, 0));
      const Json& command = sent["inverse3"][0]["commands"]["set_cursor_force"];
      const bool switched = one.unheeded && n >= 100;
      double told = 0;
      if (session.status().state == State::idle) {
        ASSERT_TRUE(command.contains(switched ? "values" : "vector")) << n;
        told = command[switched ? "values" : "vector"]["z"];
        const double most = one.unheeded && n >= 5 ? 0.2 : std::numeric_limits<double>::infinity();
        EXPECT_EQ(told, std::min(one.asked, most)) << n;
        EXPECT_EQ(session.status().most_force, most) << n << ": it is told, too";
      }
      EXPECT_EQ(session.status().fault, one.unheeded && n >= 200 ? LinkFault::forces_refused : LinkFault::none) << n;
      if (session.status().fault == LinkFault::none) acts = one.part * told;
      session.answer(arm_at(Vec3(0), Vec3(0, 0, acts)));
    }
    ASSERT_TRUE(session.protocol.acting_force());
    EXPECT_EQ(*session.protocol.acting_force(), Vec3(0, 0, acts));
  }
}

/// One answer that tells of the force begins the hundred anew.
TEST(HaplyExchange, OnlyAnswersInARowCount) {
  HaplySession session;
  session.answer(arm_at(Vec3(0)));
  for (int n = 1; n <= 500; ++n) {
    session.step(Vec3(1, 0, 0));
    session.answer(arm_at(Vec3(0), Vec3(n % 100 == 0 ? 1 : 0, 0, 0)));
    EXPECT_EQ(session.status().fault, LinkFault::none);
  }
  EXPECT_TRUE(session.step(Vec3(1, 0, 0))["inverse3"][0]["commands"]["set_cursor_force"].contains("vector"));
}

/// Twenty answers in a row that tell of another's force are a fault. Nineteen are not, however often, with one between
/// them that tells of ours, of a part of it or of none.
TEST(HaplyExchange, OnlyForeignForcesInARowCount) {
  for (const Vec3& ours : {Vec3(0), Vec3(1, 0, 0)}) {
    for (const double part : {1.0, 0.3, 0.0}) {
      HaplySession session;
      session.answer(arm_at(Vec3(0)));
      const auto told = [&](const Vec3& acting) {
        session.step(ours);
        session.answer(arm_at(Vec3(0), acting));
        return session.status().fault;
      };
      for (int n = 1; n <= 200; ++n) {
        ASSERT_EQ(told(n % 20 == 0 ? part * ours : ours + Vec3(0, 0, 1)), LinkFault::none) << part << " " << n;
      }
      for (int n = 1; n <= 20; ++n) {
        EXPECT_EQ(told(ours + Vec3(0, 0, 1)), n < 20 ? LinkFault::none : LinkFault::foreign_force) << n;
      }
    }
  }
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
TEST(HaplyExchange, ConnectedAnewItKnowsNothingOfBefore) {
  HaplySession session;
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

/// Two seconds for its first message, and no longer.
TEST(HaplyExchange, ItsFirstMessageIsWaitedForTwoSeconds) {
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
