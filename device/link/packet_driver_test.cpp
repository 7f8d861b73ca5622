/// The driver of a device that speaks in packets, on a link and a protocol that note what they are asked.

#include "device/link/packet_driver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

namespace palpate::device {
namespace {

struct Noted {
  std::vector<std::vector<std::uint8_t>> waiting;   ///< packets of the device
  bool babbles = false;                             ///< there is always another
  std::vector<double> timeouts;                     ///< of each wait for one
  std::vector<std::vector<std::uint8_t>> received;  ///< by the protocol
  std::vector<std::vector<std::uint8_t>> sent;
  std::size_t due = 0;  ///< bytes of the next answer
  Vec3 force{0};
  bool refuses = false, lost = false, told_lost = false;
  int links = 0;  ///< open
};

class NotedLink final : public Link {
 public:
  explicit NotedLink(Noted& noted) : noted_(noted) { ++noted_.links; }
  ~NotedLink() override { --noted_.links; }
  double now() noexcept override { return 42; }
  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    noted_.timeouts.push_back(timeout);
    if (noted_.babbles) return 1;
    if (noted_.waiting.empty()) return 0;
    const std::vector<std::uint8_t> next = noted_.waiting.front();
    noted_.waiting.erase(noted_.waiting.begin());
    std::copy(next.begin(), next.end(), packet.begin());
    return next.size();
  }
  bool send(std::span<const std::uint8_t> packet) noexcept override {
    noted_.sent.emplace_back(packet.begin(), packet.end());
    return true;
  }
  bool flush(double /*timeout*/) noexcept override { return true; }
  bool lost() const noexcept override { return noted_.lost; }

 private:
  Noted& noted_;
};

class NotedProtocol final : public Protocol {
 public:
  explicit NotedProtocol(Noted& noted) : noted_(noted) {}
  void connect(Link& /*link*/) override {
    if (noted_.refuses) throw std::runtime_error("refused");
  }
  void disconnected(bool lost) noexcept override { noted_.told_lost = lost; }
  void receive(std::span<const std::uint8_t> packet, double now) noexcept override {
    EXPECT_EQ(now, 42);
    noted_.received.emplace_back(packet.begin(), packet.end());
  }
  std::size_t step(const Vec3& force, double now, std::span<std::uint8_t> packet) noexcept override {
    EXPECT_EQ(now, 42);
    noted_.force = force;
    for (std::size_t n = 0; n < noted_.due; ++n) packet[n] = static_cast<std::uint8_t>(n + 1);
    return noted_.due;
  }
  const ProtocolStatus& status() const noexcept override { return status_; }

 private:
  Noted& noted_;
  ProtocolStatus status_;
};

std::unique_ptr<PacketDriver> driver_of(Noted& noted) {
  return std::make_unique<PacketDriver>(std::make_unique<NotedProtocol>(noted),
                                        [&] { return std::make_unique<NotedLink>(noted); });
}

/// The first is waited for; those that are there already are taken with it, each with its own bytes, in their order.
TEST(PacketDriver, TakesAllThatHasArrived) {
  Noted noted;
  const auto driver = driver_of(noted);
  driver->connect();
  const std::vector<std::vector<std::uint8_t>> packets{{1, 2, 3}, {4}, {5, 6}};
  noted.waiting = packets;
  driver->take(0.25);
  EXPECT_EQ(noted.received, packets);
  EXPECT_EQ(noted.timeouts, (std::vector<double>{0.25, 0, 0, 0}));
  driver->take(0.5);
  EXPECT_EQ(noted.received.size(), 3U) << "nothing came";
  EXPECT_EQ(noted.timeouts.back(), 0.5);
}

TEST(PacketDriver, ADeviceThatBabblesDoesNotHoldIt) {
  Noted noted;
  const auto driver = driver_of(noted);
  driver->connect();
  noted.babbles = true;
  driver->take(1e-3);
  EXPECT_EQ(noted.received.size(), 64U);
}

TEST(PacketDriver, SendsWhatIsDueAndNothingElse) {
  Noted noted;
  const auto driver = driver_of(noted);
  driver->connect();
  driver->give({1, 2, 3});
  EXPECT_EQ(noted.force, Vec3(1, 2, 3));
  EXPECT_TRUE(noted.sent.empty());
  noted.due = 3;
  driver->give({4, 5, 6});
  EXPECT_EQ(noted.sent, (std::vector<std::vector<std::uint8_t>>{{1, 2, 3}}));
}

TEST(PacketDriver, LeavesNoLinkOpenAndSaysWhetherItWasLost) {
  Noted noted;
  const auto driver = driver_of(noted);
  noted.refuses = true;
  EXPECT_THROW(driver->connect(), std::runtime_error);
  EXPECT_EQ(noted.links, 0);
  noted.refuses = false;
  for (const bool lost : {true, false}) {
    noted.lost = lost;
    driver->connect();
    EXPECT_EQ(noted.links, 1);
    EXPECT_EQ(driver->lost(), lost);
    driver->disconnect();
    EXPECT_EQ(noted.told_lost, lost);
    EXPECT_EQ(noted.links, 0);
  }
  driver->disconnect();  // without a link there is nothing to do
}

}  // namespace
}  // namespace palpate::device
