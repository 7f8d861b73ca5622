/// A puck's way by its formula: speed times time times the deflection beyond the dead zone; and each of its limits.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>

#include "device/space_mouse/space_mouse.h"
#include "device/space_mouse/space_mouse_driver.h"
#include "device/testing/fake_space_mouse.h"

namespace palpate::device {
namespace {

struct Puck {
  FakeHidBench bench;
  FakeSpaceMouse puck{false};
  FakeHidLink link{puck, bench};
  SpaceMouseProtocol protocol;
  double now = 30;

  explicit Puck(const SpaceMouseSettings& settings = {}) : protocol(settings) {
    bench.time = now;
    protocol.connect(link);
  }
  /// Counts along the puck's own axes: right, towards the user, down.
  void report(const std::array<int, 3>& counts) {
    std::array<std::uint8_t, 7> bytes{1};
    for (std::size_t i = 0; i < 3; ++i) {
      bytes[1 + 2 * i] = static_cast<std::uint8_t>(counts[i] & 0xff);
      bytes[2 + 2 * i] = static_cast<std::uint8_t>((counts[i] >> 8) & 0xff);
    }
    protocol.receive(bytes, now);
  }
  Vec3 after(double seconds) {
    now += seconds;
    EXPECT_EQ(protocol.step(Vec3(1), now, {}), 0U) << "nothing is ever sent to it";
    return protocol.status().position;
  }
};

TEST(SpaceMouseLimits, GoesBySpeedTimesTimeTimesDeflection) {
  std::mt19937 random(1);
  const auto number = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  for (int n = 0; n < 300; ++n) {
    const SpaceMouseSettings settings{.speed = number(0.05, 0.3),
                                      .dead_zone = number(0, 0.5),
                                      .full_deflection = number(200, 500),
                                      .half_extent = {number(0.01, 0.1), number(0.01, 0.1), number(0.01, 0.1)}};
    Puck puck(settings);
    Vec3 place(0);
    for (int step = 0; step < 20; ++step) {
      const std::array<int, 3> counts{static_cast<int>(random() % 1200) - 600, static_cast<int>(random() % 1200) - 600,
                                      static_cast<int>(random() % 1200) - 600};
      puck.report(counts);
      const Vec3 ours(counts[0], -counts[2], counts[1]);
      const double elapsed = number(0, 0.05);
      for (int axis = 0; axis < 3; ++axis) {
        const double part = std::min(1.0, std::abs(ours[axis]) / settings.full_deflection);
        const double beyond = std::max(0.0, (part - settings.dead_zone) / (1 - settings.dead_zone));
        place[axis] += settings.speed * elapsed * std::copysign(beyond, ours[axis]);
        place[axis] = std::clamp(place[axis], -settings.half_extent[axis], settings.half_extent[axis]);
      }
      ASSERT_LT(glm::distance(puck.after(elapsed), place), 1e-12);
    }
    EXPECT_EQ(puck.protocol.status().news, 20U);
    EXPECT_EQ(puck.protocol.status().state, State::idle);
  }
}

/// A report counts for 0.15 s; a thread held up for longer than 0.05 s moves no farther than in these; no time runs
/// back.
TEST(SpaceMouseLimits, AReportCountsForItsTime) {
  Puck puck({.speed = 0.1, .dead_zone = 0, .full_deflection = 350, .half_extent = Vec3(1)});
  puck.report({350, 0, 0});
  EXPECT_NEAR(puck.after(0.049).x, 0.0049, 1e-12);
  EXPECT_NEAR(puck.after(0.099).x, 0.0099, 1e-12);
  EXPECT_NEAR(puck.after(0.003).x, 0.0099, 1e-12) << "it is let go";
  puck.report({-350, 0, 0});
  EXPECT_NEAR(puck.after(-1).x, 0.0099, 1e-12);
  EXPECT_NEAR(puck.after(0.01).x, 0.0089, 1e-12);
  EXPECT_TRUE(std::isinf(puck.protocol.longest_silence())) << "a puck at rest says nothing";
}

TEST(SpaceMouseLimits, EachSettingHasItsLimit) {
  const auto is_taken = [](const SpaceMouseSettings& settings) {
    try {
      make_space_mouse(settings);
    } catch (const std::runtime_error&) {
      return false;
    }
    return true;
  };
  for (const auto& [value, taken] : {std::pair{1e-9, true}, {0.0, false}, {-1.0, false}, {std::nan(""), false}}) {
    EXPECT_EQ(is_taken({.speed = value}), taken) << value;
    EXPECT_EQ(is_taken({.full_deflection = value}), taken) << value;
  }
  for (const auto& [value, taken] : {std::pair{0.0, true}, {0.999, true}, {1.0, false}, {-1e-9, false}}) {
    EXPECT_EQ(is_taken({.dead_zone = value}), taken) << value;
  }
}

/// Four bytes of buttons, lowest first, of which a report may hold fewer; a fifth is none.
TEST(SpaceMouseLimits, ButtonsComeByteByByte) {
  const std::array<std::uint8_t, 7> report{3, 0x81, 0x42, 0x24, 0x18, 0xff, 0xff};
  const std::uint32_t buttons[] = {0, 0x81, 0x4281, 0x244281, 0x18244281, 0x18244281, 0x18244281};
  Puck puck;
  for (std::size_t bytes = 1; bytes < 7; ++bytes) {
    puck.protocol.receive(std::span(report).first(1 + bytes), puck.now);
    EXPECT_EQ(puck.protocol.status().buttons, buttons[bytes]) << bytes;
    EXPECT_EQ(puck.after(0.01), Vec3(0)) << "they move nothing";
  }
}

}  // namespace
}  // namespace palpate::device
