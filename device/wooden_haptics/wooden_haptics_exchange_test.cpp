/// The arm's exchange, report by report, by the bytes that its firmware sends and reads.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "device/wooden_haptics/wooden_haptics_driver.h"

namespace palpate::device {
namespace {

constexpr double ms = 1e-3;

/// A report of seven words: three counters, the fourth encoder, two more, the button.
std::vector<std::uint8_t> report_of(const std::array<int, 3>& counts, int button = 0, std::size_t size = 14) {
  std::vector<std::uint8_t> report(size);
  const std::array<int, 7> words{counts[0], counts[1], counts[2], 0, 0, 0, button};
  for (std::size_t i = 0; i < std::min<std::size_t>(7, size / 2); ++i) {
    report[2 * i] = static_cast<std::uint8_t>(words[i] & 0xff);
    report[2 * i + 1] = static_cast<std::uint8_t>((words[i] >> 8) & 0xff);
  }
  return report;
}

/// Reports of the test's, one a millisecond.
class ReportingLink final : public Link {
 public:
  double now() noexcept override { return time; }
  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    time += timeout;
    if (reports.empty()) return 0;
    const std::vector<std::uint8_t> report = reports.front();
    if (reports.size() > 1) reports.pop_front();
    std::copy(report.begin(), report.end(), packet.begin());
    return report.size();
  }
  bool send(std::span<const std::uint8_t> packet) noexcept override {
    sizes.push_back(packet.size());
    pushing += std::any_of(packet.begin(), packet.end(), [](std::uint8_t byte) { return byte != 0; }) ? 1 : 0;
    return true;
  }
  bool flush(double /*timeout*/) noexcept override { return true; }
  bool lost() const noexcept override { return false; }

  double time = 100;
  std::deque<std::vector<std::uint8_t>> reports;  ///< the last one again and again
  std::vector<std::size_t> sizes;
  int pushing = 0;  ///< packets that were not zeros
};

struct Arm {
  WoodenHapticsProtocol protocol;
  double now = 200;

  explicit Arm(const WoodenHapticsSettings& settings = wooden_haptics_preset("2015")) : protocol(settings) {}
  void report(const std::array<int, 3>& counts, int button = 0, std::size_t size = 14) {
    protocol.receive(report_of(counts, button, size), now += ms);
  }
  /// The words of the answer; nothing where none is due.
  std::vector<int> answer(const Vec3& force = Vec3(0)) {
    std::array<std::uint8_t, 64> packet{};
    packet.fill(0xee);
    const std::size_t size = protocol.step(force, now, packet);
    std::vector<int> words;
    for (std::size_t i = 0; 2 * i < size; ++i) {
      words.push_back(static_cast<std::int16_t>(packet[2 * i] | packet[2 * i + 1] << 8));
    }
    return words;
  }
  State state() const { return protocol.status().state; }
  /// Its button pressed and let go in the home pose of the 2015 arm.
  void calibrate() {
    report({7, 8, 9}, 1);
    answer();
    report({0, 0, 6000});
    EXPECT_EQ(state(), State::idle);
  }
};

/// While its button is pressed it is told its home's counts and no currents; from then on it counts from home.
TEST(WoodenHapticsExchange, TheButtonSetsTheCounters) {
  WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  settings.home_counts = {12, -345, 6000};
  Arm arm(settings);
  arm.report({3, 4, 5});
  EXPECT_EQ(arm.state(), State::homing);
  EXPECT_EQ(arm.answer(Vec3(1)), std::vector<int>(7, 0));
  for (int n = 0; n < 3; ++n) {
    arm.report({3, 4, 5}, 1);
    EXPECT_EQ(arm.answer(Vec3(1)), (std::vector<int>{0, 0, 0, 1, 12, -345, 6000}));
    EXPECT_EQ(arm.state(), State::homing);
  }
  arm.report({12, -345, 6000});
  EXPECT_EQ(arm.state(), State::idle);
  EXPECT_LT(glm::distance(arm.protocol.status().position,
                          wooden_haptics_position(settings, wooden_haptics_angles(settings, settings.home_counts))),
            1e-12);
  EXPECT_EQ(arm.protocol.status().news, 5U) << "each report tells that it lives";
  arm.report({12, -345, 6000}, 1);
  EXPECT_EQ(arm.state(), State::homing) << "and again when it bounces";
  EXPECT_EQ(arm.answer(Vec3(1))[0], 0);
}

/// In mid-session its counters would be set under the hand, wherever it is. So its home is lost. It is told the home's
/// counts all the same, which clears the latch of its button: opened again, it waits for another press.
TEST(WoodenHapticsExchange, TheButtonInMidSessionIsALostHome) {
  Arm arm;
  arm.calibrate();
  const auto hold = [&](int reports) {
    for (int n = 0; n < reports; ++n) {
      arm.report({0, 0, 6000});
      arm.answer(Vec3(0, 1, 0));
    }
  };
  hold(95);
  arm.report({0, 0, 6000}, 1);
  EXPECT_EQ(arm.state(), State::homing) << "so soon it is a bounce";
  arm.answer();
  hold(101);
  EXPECT_EQ(arm.state(), State::idle);
  const Vec3 before = arm.protocol.status().position;
  arm.report({0, 0, 6000}, 1);
  EXPECT_EQ(arm.state(), State::fault);
  EXPECT_EQ(arm.protocol.status().fault, LinkFault::unhomed);
  EXPECT_EQ(arm.answer(Vec3(0, 1, 0)), (std::vector<int>{0, 0, 0, 1, 0, 0, 6000}));
  for (int n = 0; n < 300; ++n) {
    arm.report({0, 0, 0});
    EXPECT_EQ(arm.state(), State::fault);
    EXPECT_EQ(arm.answer(Vec3(0, 1, 0)), std::vector<int>(7, 0));
  }
  EXPECT_EQ(arm.protocol.status().position, before);
  arm.protocol.disconnected(false);
  ReportingLink link;
  link.reports = {report_of({0, 0, 0})};
  arm.protocol.connect(link);
  EXPECT_EQ(arm.state(), State::homing);
}

/// Only 8, 14 and 64 bytes are reports, and of an arm only those of its first report's length.
TEST(WoodenHapticsExchange, AReportHasOneOfThreeLengths) {
  for (std::size_t size = 0; size <= 64; ++size) {
    Arm arm;
    arm.report({0, 0, 0}, 0, size);
    const bool known = size == 8 || size == 14 || size == 64;
    EXPECT_EQ(arm.protocol.status().news, known ? 1U : 0U) << size;
    EXPECT_EQ(arm.answer().size(), known ? size / 2 : 0U) << "answered in its own length";
    if (!known) continue;
    for (const std::size_t other : {8U, 14U, 64U}) {
      arm.report({0, 0, 0}, 0, other);
      EXPECT_EQ(arm.protocol.status().news, other == size ? 2U : 1U) << size << " " << other;
      if (other == size) break;
    }
  }
}

/// Firmware that waits is begun with after 10 ms of silence: both lengths in turn, until a report tells which it has.
TEST(WoodenHapticsExchange, ASilentFirmwareIsBegunWith) {
  Arm arm;
  EXPECT_TRUE(arm.answer().empty());
  for (const std::size_t words : {7U, 7U, 7U, 4U, 7U, 7U, 7U, 4U}) {
    arm.now += 9.9 * ms;
    EXPECT_TRUE(arm.answer().empty());
    arm.now += 0.2 * ms;
    EXPECT_EQ(arm.answer(), std::vector<int>(words, 0));
  }
  arm.report({0, 0, 0});
  EXPECT_EQ(arm.answer().size(), 7U);
  EXPECT_TRUE(arm.answer().empty()) << "one answer to a report";
  arm.now += 10.1 * ms;
  EXPECT_EQ(arm.answer(Vec3(1)), std::vector<int>(7, 0));
}

/// Ten milliseconds are enough, and a hair less is not. From zero on, of which differences are exact.
TEST(WoodenHapticsExchange, SilenceLastsTenMilliseconds) {
  constexpr double enough = 10 * ms;
  for (const double silence : {enough, std::nextafter(enough, 0.0)}) {
    Arm arm;
    arm.now = 0;
    EXPECT_TRUE(arm.answer().empty());
    arm.now = silence;
    EXPECT_EQ(arm.answer().empty(), silence < enough);
  }
}

/// A second for its first report, and no longer.
TEST(WoodenHapticsExchange, ItsFirstReportIsWaitedForASecond) {
  for (const bool comes : {true, false}) {
    ReportingLink link;
    for (int n = 0; n < 990; ++n) link.reports.push_back({});
    link.reports.push_back(comes ? report_of({0, 0, 0}) : std::vector<std::uint8_t>{});
    WoodenHapticsProtocol protocol(wooden_haptics_preset("2015"));
    const double begun = link.time;
    bool connected = true;
    try {
      protocol.connect(link);
    } catch (const std::runtime_error&) {
      connected = false;
    }
    EXPECT_EQ(connected, comes);
    EXPECT_NEAR(link.time - begun, comes ? 0.991 : 1.0, 2.1 * ms);
    EXPECT_NEAR(static_cast<double>(link.sizes.size()), 98, 3) << "begun with every 10 ms";
    EXPECT_EQ(link.sizes.back(), 14U);
  }
}

/// An arm that was closed with its home keeps it; whatever its first report says then, it is homing or ready, and one
/// that was not ready, or was unplugged, has to be homed again.
TEST(WoodenHapticsExchange, AHomeIsKeptWhereItIsKnown) {
  for (const bool ready : {true, false}) {
    for (const bool lost : {true, false}) {
      for (const bool could_be : {true, false}) {
        Arm arm;
        if (ready) arm.calibrate();
        arm.protocol.disconnected(lost);
        ReportingLink link;
        // The bodies cannot turn half round.
        link.reports = {report_of(could_be ? std::array{0, 0, 5900} : std::array{20000, 20000, 20000})};
        const std::uint64_t news = arm.protocol.status().news;
        arm.protocol.connect(link);
        EXPECT_EQ(arm.state(), ready && !lost && could_be ? State::idle : State::homing);
        EXPECT_EQ(arm.protocol.status().news, news + (could_be || !ready || lost ? 1 : 0)) << "poses are counted on";
        EXPECT_EQ(arm.protocol.status().buttons, 0U);
        EXPECT_EQ(link.pushing, 0) << "nobody has asked for a force yet";
        arm.now = link.time;
        arm.report({0, 0, 5900});
        EXPECT_EQ(arm.state(), ready && !lost ? State::idle : State::homing);
      }
    }
  }
}

/// One of another kind that was refused was in its home pose, which the arm that comes next need not be.
TEST(WoodenHapticsExchange, ARefusedArmLeavesNoHome) {
  Arm arm;
  ReportingLink link;
  link.reports = {report_of({1, 2, 3}, 0, 8)};
  EXPECT_ANY_THROW(arm.protocol.connect(link));
  link.reports = {report_of({0, 0, 6000})};
  arm.protocol.connect(link);
  EXPECT_EQ(arm.state(), State::homing);
  arm.now = link.time;
  for (int n = 0; n < 10; ++n) arm.report({0, 0, 6000});
  EXPECT_EQ(arm.state(), State::homing);
  EXPECT_EQ(arm.answer(Vec3(0, 1, 0)), std::vector<int>(7, 0));
}

/// However the settings came about.
TEST(WoodenHapticsExchange, SettingsThatNoArmHasAreRefused) {
  WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  EXPECT_NE(make_wooden_haptics_on(settings, {}, {}), nullptr);
  settings.workspace_radius = 0;
  EXPECT_THROW(make_wooden_haptics_on(settings, {}, {}), std::runtime_error);
}

/// Of a pose, told by its distance from the origin in radii of the workspace.
TEST(WoodenHapticsExchange, ItReachesThreeRadii) {
  WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  const double away = glm::length(wooden_haptics_position(settings, wooden_haptics_angles(settings, {0, 0, 6000})));
  for (const double radii : {2.99, 3.01}) {
    settings.workspace_radius = away / radii;
    Arm arm(settings);
    arm.report({7, 8, 9}, 1);
    arm.answer();
    const std::uint64_t before = arm.protocol.status().news;
    arm.report({0, 0, 6000});
    EXPECT_EQ(arm.protocol.status().news - before, radii < 3 ? 1U : 0U);
  }
}

/// Impossible poses take the force away at once; after 80 ms of them they are a fault.
TEST(WoodenHapticsExchange, APoseThatCannotBeGetsNoForce) {
  Arm arm;
  arm.calibrate();
  const auto pushes = [&] {
    const std::vector<int> words = arm.answer(Vec3(0, 1, 0));
    return std::any_of(words.begin(), words.end(), [](int word) { return word != 0; });
  };
  EXPECT_TRUE(pushes());
  const Vec3 before = arm.protocol.status().position;
  for (int n = 1; n <= 79; ++n) {
    arm.report({20000, 0, 0});
    EXPECT_EQ(arm.state(), State::idle) << n;
    EXPECT_TRUE(arm.protocol.status().doubtful) << "the link takes the force away";
    EXPECT_EQ(arm.protocol.status().position, before);
  }
  for (int n = 0; n < 3; ++n) arm.report({20000, 0, 0});
  EXPECT_EQ(arm.state(), State::fault);
  EXPECT_EQ(arm.protocol.status().fault, LinkFault::unreachable_pose);
  arm.report({0, 0, 6000});
  EXPECT_EQ(arm.state(), State::fault) << "it is kept";
  EXPECT_FALSE(pushes());
}

/// Each motor may give its limit for three of four seconds, and then what it lasts at; all three are shrunk by one
/// factor.
TEST(WoodenHapticsExchange, TheMotorsAreNotWarmedBeyondWhatTheyBear) {
  WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  settings.maximum_force = 20;
  // In its home pose the base pushes sideways, the upper body up and the lower one towards the user.
  const std::pair<std::size_t, Vec3> motors[] = {{0, {15, 5, 2}}, {1, {2, 5, 15}}, {2, {0, 15, 5}}};
  for (const auto& [motor, force] : motors) {
    Arm arm(settings);
    arm.calibrate();
    std::vector<int> first;
    for (int n = 0; n < 10'000; ++n) {
      arm.report({0, 0, 6000});
      const std::vector<int> words = arm.answer(force);
      const int largest = std::max({std::abs(words[0]), std::abs(words[1]), std::abs(words[2])});
      ASSERT_EQ(std::abs(words[motor]), largest);
      if (n == 0) first = words;
      if (n < 2900) {
        ASSERT_NEAR(largest, 2000, 1) << n;
      }
      if (n > 9000) {
        ASSERT_NEAR(largest, 1000, 5) << n;
      }
      for (std::size_t i = 0; i < 3; ++i) ASSERT_NEAR(words[i] * 2000.0, first[i] * static_cast<double>(largest), 4000);
    }
  }
}

}  // namespace
}  // namespace palpate::device
