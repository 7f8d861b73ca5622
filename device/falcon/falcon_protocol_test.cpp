#include "device/falcon/falcon_protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace palpate::device {
namespace {

std::vector<std::uint8_t> bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

std::vector<std::uint8_t> reply_packet(int first, int second, int third) {
  // A command without lights differs from a reply in no byte but the flags.
  FalconCommand command{{first, second, third}, false, 0};
  const auto packet = encode(command);
  return {packet.begin(), packet.end()};
}

TEST(FalconProtocol, EncodesTheLeastSignificantNibbleFirst) {
  FalconCommand command{{0x0123, -1, 0}, true, falcon_green};
  const auto packet = encode(command);
  EXPECT_EQ(std::string(packet.begin(), packet.end()), "<DCBAPPPPAAAADA>");
}

TEST(FalconProtocol, NeverWrapsTheSign) {
  const int huge[] = {4097, 32768, 40000, 65535, 65536, 1'000'000, std::numeric_limits<int>::max()};
  for (const int value : huge) {
    const auto packet = encode({{value, -value, 0}, true, 0});
    const auto reply = decode_falcon_reply(packet);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->encoders[0], 4096);
    EXPECT_EQ(reply->encoders[1], -4096);
  }
}

TEST(FalconProtocol, MotorsKeepTheDirectionAndTheLimit) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 5000; ++i) {
    const double scale = std::pow(10, 3 * normal(random));
    const Vec3 torques = scale * Vec3(normal(random), normal(random), normal(random));
    const auto motors = falcon_motors(torques, 10000);
    int largest = 0;
    for (std::size_t leg = 0; leg < 3; ++leg) {
      ASSERT_LE(std::abs(motors[leg]), falcon_motor_limit);
      if (motors[leg] != 0) {
        ASSERT_EQ(motors[leg] > 0, torques[static_cast<int>(leg)] < 0);
      }
      largest = std::max(largest, std::abs(motors[leg]));
    }
    if (largest < 1000) continue;
    for (int leg = 0; leg < 2; ++leg) {
      const auto j = static_cast<std::size_t>(leg);
      // cross product of direction, within the rounding of the integers
      ASSERT_NEAR(motors[j] * torques[leg + 1], motors[j + 1] * torques[leg],
                  0.51 * (std::abs(torques[leg]) + std::abs(torques[leg + 1])));
    }
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(falcon_motors(Vec3(1, nan, 0), 10000), (std::array<int, 3>{}));
  EXPECT_EQ(falcon_motors(Vec3(1e308, 0, 0), 10000), (std::array<int, 3>{}));
}

TEST(FalconProtocol, DecodesButtonsAndHoming) {
  const auto reply = decode_falcon_reply(bytes("<AAAIPPPHAAAA" + std::string(1, char(0x41 + 0x75)) + "A>"));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->encoders[0], -32768);
  EXPECT_EQ(reply->encoders[1], 32767);
  EXPECT_EQ(reply->buttons, 5U);
  EXPECT_TRUE(reply->homed[0] && reply->homed[1] && reply->homed[2]);
}

TEST(FalconProtocol, RefusesEveryByteThatNoFalconSends) {
  auto packet = reply_packet(1, 2, 3);
  ASSERT_TRUE(decode_falcon_reply(packet));
  for (std::size_t i = 0; i < 14; ++i) {
    auto broken = packet;
    broken[i] = i == 13 ? 0xc5 : 0x51 + 1;
    EXPECT_FALSE(decode_falcon_reply(broken)) << i;
  }
  packet.pop_back();
  EXPECT_FALSE(decode_falcon_reply(packet));
}

TEST(FalconReplies, FindsRepliesHoweverTheyAreSplit) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 300; ++trial) {
    FalconReplies replies;
    std::vector<std::uint8_t> stream;
    for (int i = 1; i <= 20; ++i) {
      const auto packet = reply_packet(i, -i, 0);
      stream.insert(stream.end(), packet.begin(), packet.end());
    }
    int last = 0;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t piece = std::min<std::size_t>(1 + random() % 40, stream.size() - at);
      if (const auto reply = replies.feed(std::span(stream).subspan(at, piece))) last = reply->encoders[0];
      at += piece;
    }
    EXPECT_EQ(last, 20);
    EXPECT_EQ(replies.received(), 20U);
    EXPECT_EQ(replies.garbled_bytes(), 0U);
  }
}

TEST(FalconReplies, RecoversAfterGarbage) {
  std::mt19937 random(3);
  const std::string alphabet = "<>AP<zA>";
  for (int trial = 0; trial < 2000; ++trial) {
    FalconReplies replies;
    std::vector<std::uint8_t> garbage;
    for (unsigned i = 0; i < random() % 50; ++i) garbage.push_back(alphabet[random() % alphabet.size()]);
    replies.feed(garbage);
    // An unlucky tail may swallow the packet behind it; the next one always comes through.
    replies.feed(reply_packet(7, 8, 9));
    const auto reply = replies.feed(reply_packet(17, 18, 19));
    ASSERT_TRUE(reply) << trial;
    EXPECT_EQ(reply->encoders, (std::array<int, 3>{17, 18, 19}));
  }
}

TEST(FalconReplies, SurvivesAnyBytes) {
  std::mt19937 random(4);
  FalconReplies replies;
  for (int i = 0; i < 300'000; ++i) {
    const std::uint8_t byte = random() % 3 == 0 ? '<' : static_cast<std::uint8_t>(random());
    replies.feed(std::span(&byte, 1));
  }
  EXPECT_GT(replies.garbled_bytes(), 290'000U);
}

/// Every byte that is no part of a reply is counted, once.
TEST(FalconReplies, CountsWhatIsGarbled) {
  FalconReplies replies;
  replies.feed(bytes("xy>"));
  EXPECT_EQ(replies.garbled_bytes(), 3U);
  replies.feed(bytes("<AAAA"));
  EXPECT_EQ(replies.garbled_bytes(), 3U) << "it may become one";
  EXPECT_TRUE(replies.feed(reply_packet(1, 2, 3)));
  EXPECT_EQ(replies.garbled_bytes(), 8U);
  EXPECT_EQ(replies.received(), 1U);
}

}  // namespace
}  // namespace palpate::device
