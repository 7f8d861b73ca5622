// Debian's examples of OpenIGTLink as servers, whose messages are read here, and as a client that sends messages which
// Palpate does not use. serve_test.cpp runs `palpate serve` with the example of a receiver.

#include <gtest/gtest.h>

#include <chrono>

#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/receiver.h"
#include "plugin/openigtlink/testing/example_peer.h"
#include "plugin/openigtlink/testing/stepped_server.h"

namespace palpate::plugin::igtl {
namespace {

using testing::free_port;
using testing::Peer;

/// What the example sends until there are so many messages.
std::vector<Message> messages_of(const std::string& example, const std::string& more, std::size_t count) {
  const int port = free_port();
  const Peer server(example, std::to_string(port) + more);
  testing::Connection connection(port);
  std::vector<Message> got;
  Receiver receiver([](const Header&) { return std::size_t{1} << 20U; });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (got.size() < count && std::chrono::steady_clock::now() < end) {
    receiver.take(connection.receive(), [&](Message&& message) { got.push_back(std::move(message)); });
  }
  EXPECT_EQ(receiver.dropped(), 0U);
  return got;
}

TEST(OpenIgtPeers, StringServerIsUnderstood) {
  const auto got = messages_of("StringServer", " 50", 3);
  ASSERT_GE(got.size(), 3U);
  EXPECT_EQ(got[0].type, "STRING");
  EXPECT_EQ(string_of(got[0].content), "OpenIGTLink");
  EXPECT_EQ(string_of(got[1].content), "Network");
}

TEST(OpenIgtPeers, StatusServerIsUnderstood) {
  const auto got = messages_of("StatusServer", "", 1);
  ASSERT_GE(got.size(), 1U);
  const Status status = status_of(got[0].content);
  EXPECT_EQ(static_cast<int>(status.code), 1);
  EXPECT_EQ(status.sub_code, 128);
  EXPECT_EQ(status.name, "OK!");
}

TEST(OpenIgtPeers, PointServerIsUnderstood) {
  const auto got = messages_of("PointServer", "", 1);
  ASSERT_GE(got.size(), 1U);
  const std::vector<Point> points = points_of(got[0].content);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].name, "POINT_0");
  EXPECT_EQ(points[1].rgba, (std::array<std::uint8_t, 4>{0, 255, 0, 255}));
  EXPECT_EQ(points[2].diameter, 75);
  EXPECT_EQ(points[2].owner, "IMAGE_0");
  EXPECT_EQ(points[0].position, glm::dvec3(10, 20, 30));
  EXPECT_EQ(points[2].position, glm::dvec3(70, 80, 90));
}

TEST(OpenIgtPeers, ATrackersTransformsArePassedOver) {
  testing::SteppedServer stepped;
  const Peer tracker("TrackerClient", "127.0.0.1 " + std::to_string(stepped.server.port()) + " 200");
  testing::TestClient other(stepped.server.port());
  for (int n = 0; n < 1000 && stepped.server.counts().passed_over < 50; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_GE(stepped.server.counts().passed_over, 50U);
  EXPECT_EQ(stepped.server.counts().dropped, 0U);
  other.send_text("PalpateScene", "{}");
  for (int n = 0; n < 500 && stepped.server.counts().taken == 0; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(stepped.server.take().size(), 1U) << "and it does not control";
}

}  // namespace
}  // namespace palpate::plugin::igtl
