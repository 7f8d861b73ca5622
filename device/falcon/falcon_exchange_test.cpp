/// The Falcon's exchange to the millisecond, with replies of the test's own: when a command is due and what is in it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <random>
#include <string>

#include "device/falcon/falcon_driver.h"
#include "device/testing/fake_falcon_link.h"
#include "device/testing/public_falcon.h"

namespace palpate::device {
namespace {

constexpr double ms = 1e-3;
constexpr std::uint8_t all_homed = 0x70;

struct Exchange {
  FakeFalconBench bench;
  FalconProtocol protocol;
  double now = 1000;

  explicit Exchange(const FalconSettings& settings = {}) : protocol(settings) { connect(); }
  void connect() {
    FakeFalconLink link(bench);
    protocol.connect(link);
  }
  void reply(const std::array<int, 3>& counts = {}, std::uint8_t flags = all_homed) {
    protocol.receive(public_falcon_packet(counts, flags), now);
  }
  /// The command that is due; nothing where none is.
  std::optional<PublicFalconPacket> step(const Vec3& force = Vec3(0, 0, 1)) {
    std::array<std::uint8_t, 64> packet{};
    const std::size_t size = protocol.step(force, now, packet);
    if (size == 0) return {};
    EXPECT_EQ(size, 16U);
    return read_public_falcon_packet(std::span(packet).first(size));
  }
  static bool pushes(const std::optional<PublicFalconPacket>& command) {
    return command && command->numbers != std::array<int, 3>{};
  }
  /// Replied to and pushing.
  void begin() {
    step();
    reply();
    EXPECT_TRUE(pushes(step()));
  }
};

/// After a command the next one waits for the reply; where there is none for 20 ms the Falcon is asked again, and not
/// pushed by, since nobody knows where the grip is.
TEST(FalconExchange, IsAskedAgainAfterTwentyMilliseconds) {
  Exchange one;
  EXPECT_TRUE(one.step()) << "the first one waits for nothing";
  EXPECT_FALSE(one.step());
  one.begin();
  const double sent = one.now;
  for (one.now = sent + ms; one.now < sent + 19.95 * ms; one.now += 0.5 * ms) ASSERT_FALSE(one.step()) << one.now;
  one.now = sent + 20.05 * ms;
  const auto again = one.step();
  ASSERT_TRUE(again);
  EXPECT_FALSE(one.pushes(again));
  EXPECT_FALSE(one.step());
}

/// A reply that was given up may only be late. When another has come it is waited for, until none has come for 50 ms.
/// Then the Falcon is commanded again, and pushed by when two replies in turn were on time.
TEST(FalconExchange, AReplyGivenUpIsWaitedForFiftyMilliseconds) {
  for (const bool comes : {true, false}) {
    Exchange one;
    one.begin();
    one.now += 20.05 * ms;
    ASSERT_TRUE(one.step());
    const std::uint64_t news = one.protocol.status().news;
    const Vec3 before = one.protocol.status().position;
    one.now += ms;
    one.reply({300, 300, 300});
    const double replied = one.now;
    for (one.now = replied; one.now < replied + 49.9 * ms; one.now += 0.5 * ms) ASSERT_FALSE(one.step());
    EXPECT_TRUE(one.protocol.status().doubtful);
    EXPECT_EQ(one.protocol.status().news, news) << "nobody knows of when it tells";
    EXPECT_EQ(one.protocol.status().position, before);
    if (comes) {
      one.reply({300, 300, 300});
    } else {
      one.now = replied + 50.1 * ms;
    }
    for (int on_time = 0; on_time < 2; ++on_time) {
      const auto command = one.step();
      ASSERT_TRUE(command) << comes;
      EXPECT_FALSE(one.pushes(command)) << comes << on_time;
      EXPECT_FALSE(one.step());
      one.now += ms;
      one.reply();
    }
    EXPECT_EQ(one.protocol.status().news, news + 1);
    EXPECT_FALSE(one.protocol.status().doubtful);
    EXPECT_TRUE(one.pushes(one.step()));
  }
}

/// Green while it is ready, red else; the homing bit always, without which a Falcon forgets where it is.
TEST(FalconExchange, ItsLightTellsWhetherItIsReady) {
  Exchange one;
  const auto flags = [&](std::uint8_t homed) {
    one.reply({}, homed);
    return one.step()->flags;
  };
  EXPECT_EQ(one.step()->flags, 1 + 8);
  EXPECT_EQ(flags(0x30), 1 + 8);
  EXPECT_EQ(flags(all_homed), 1 + 2);
  EXPECT_EQ(flags(0x50), 1 + 8);
}

/// Each leg that has no home yet keeps it homing, without a pose; once it was homed that is a fault.
TEST(FalconExchange, EachLegHasToBeHomed) {
  for (unsigned legs = 0; legs < 7; ++legs) {
    Exchange one;
    const auto flags = static_cast<std::uint8_t>(legs << 4);
    one.step();
    one.reply({100, 100, 100}, flags);
    EXPECT_EQ(one.protocol.status().state, State::homing);
    EXPECT_EQ(one.protocol.status().position, Vec3(0));
    EXPECT_EQ(one.protocol.status().news, 1U) << "it is alive";
    EXPECT_FALSE(one.pushes(one.step()));
    one.reply();
    EXPECT_EQ(one.protocol.status().state, State::idle);
    one.reply({}, flags);
    EXPECT_EQ(one.protocol.status().fault, LinkFault::unhomed);
  }
}

/// What the motors do at the grip is the force that was asked for, anywhere and in any direction, up to the settings'
/// largest: by the published kinematics.
TEST(FalconExchange, TheMotorsGiveTheForceThatWasAskedFor) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  FalconSettings settings;
  settings.maximum_force = 2.25;
  settings.motor_gain = 7000;
  Exchange one(settings);
  one.step();
  for (int n = 0; n < 200; ++n) {
    const Vec3 place = 0.03 * Vec3(uniform(random), uniform(random), uniform(random));
    const auto exact = public_falcon_counts(place + Vec3(0, 0, settings.geometry.center));
    ASSERT_TRUE(exact);
    std::array<int, 3> counts{};
    for (std::size_t i = 0; i < 3; ++i) counts[i] = static_cast<int>(std::lround((*exact)[i]));
    one.now += ms;
    one.reply(counts);
    EXPECT_LT(glm::distance(one.protocol.status().position, place), 0.1e-3);
    const Vec3 force = 4.0 * Vec3(uniform(random), uniform(random), uniform(random));
    const auto command = one.step(force);
    ASSERT_TRUE(command);
    const Vec3 wanted = force * std::min(1.0, 2.25 / glm::length(force));
    const Vec3 given = public_falcon_force(place + Vec3(0, 0, settings.geometry.center), command->numbers, 7000);
    EXPECT_LT(glm::distance(given, wanted), 0.03);
  }
}

/// The grip's four buttons; the centre one, under the thumb, is the first, too.
TEST(FalconExchange, TellsItsButtons) {
  Exchange one;
  for (unsigned pressed = 0; pressed < 16; ++pressed) {
    one.step();
    one.reply({}, static_cast<std::uint8_t>(all_homed | pressed));
    EXPECT_EQ(one.protocol.status().buttons, (pressed & 4) != 0 ? pressed | 1 : pressed);
  }
}

/// Connected anew: homing, at rest, no reply owed, no doubt left, even where no good pose has ended it; poses are
/// counted on.
TEST(FalconExchange, ConnectedAnewItKnowsNothingOfBefore) {
  for (const bool has_good_pose : {true, false}) {
    Exchange one;
    one.begin();
    for (int n = 0; n < 39; ++n) {
      one.now += 2 * ms;
      one.reply({4000, -4000, -4000});
      one.step();
      EXPECT_TRUE(one.protocol.status().doubtful) << "the link takes the force away";
    }
    EXPECT_EQ(one.protocol.status().state, State::idle) << "almost in doubt for too long";
    one.now += 20.05 * ms;
    ASSERT_TRUE(one.step());
    const std::uint64_t news = one.protocol.status().news;
    one.connect();
    EXPECT_EQ(one.protocol.status().state, State::homing);
    EXPECT_EQ(one.protocol.status().news, news);
    EXPECT_TRUE(one.step()) << "a command is due at once";
    if (has_good_pose) {
      one.reply();
      EXPECT_TRUE(one.pushes(one.step())) << "no surplus reply is waited for";
    }
    for (int n = 0; n < 39; ++n) {
      one.now += 2 * ms;
      one.reply({4000, -4000, -4000});
      one.step();
    }
    EXPECT_EQ(one.protocol.status().fault, LinkFault::none);
    for (int n = 0; n < 3; ++n) {
      one.now += 2 * ms;
      one.reply({4000, -4000, -4000});
      one.step();
    }
    EXPECT_EQ(one.protocol.status().fault, LinkFault::unreachable_pose);
  }
}

}  // namespace
}  // namespace palpate::device
