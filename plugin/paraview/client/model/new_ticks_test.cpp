// Each tick is seen once, and a press counts however short it was.

#include "plugin/paraview/client/model/new_ticks.h"

#include <gmock/gmock.h>

#include <random>
#include <vector>

namespace palpate::plugin {
namespace {

struct NewTicksTest : ::testing::Test {
  void write(std::uint32_t buttons, std::uint32_t shares = 1) {
    TickRecord tick;
    tick.index = written++;
    tick.buttons = buttons;
    tick.share_count = shares;
    const std::vector<PrimitiveRecord> of_tick(shares, {.tick = tick.index});
    ring.push(tick, of_tick);
  }
  NewTicks::Buttons read() {
    seen.clear();
    pressed_together.clear();
    return ticks.read(ring, tick, shares, [this](std::uint32_t pressed) {
      seen.push_back(tick.index);
      if (pressed != 0) pressed_together.push_back(pressed);
      EXPECT_EQ(shares.size(), tick.share_count);
    });
  }

  TickRing ring{16};
  std::uint64_t written = 0;
  NewTicks ticks;
  TickRecord tick;
  std::vector<PrimitiveRecord> shares;
  std::vector<std::uint64_t> seen;
  std::vector<std::uint32_t> pressed_together;
};

TEST_F(NewTicksTest, EachIsSeenOnceWithItsOwnShares) {
  write(0, 2);
  write(0, 0);
  read();
  EXPECT_THAT(seen, ::testing::ElementsAre(0, 1));
  read();
  EXPECT_THAT(seen, ::testing::IsEmpty());
  write(0, 3);
  read();
  EXPECT_THAT(seen, ::testing::ElementsAre(2));
}

TEST_F(NewTicksTest, WhatWasOverwrittenIsPassedOver) {
  for (int n = 0; n < 40; ++n) write(0);
  read();
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.front(), ring.oldest());
  EXPECT_EQ(seen.back(), 39U);
}

/// Against the union of all edges, for random buttons and polls at random times.
TEST_F(NewTicksTest, EveryPressAndReleaseSinceTheLastPollCounts) {
  std::mt19937 random(1);
  std::uint32_t before = 0;
  for (int poll = 0; poll < 200; ++poll) {
    std::uint32_t pressed = 0, let = 0;
    for (std::size_t n = random() % 6; n > 0; --n) {
      const auto buttons = static_cast<std::uint32_t>(random() % 8);
      for (std::uint32_t bit = 1; bit < 8; bit *= 2) {
        if ((buttons & bit) && !(before & bit)) pressed |= bit;
        if (!(buttons & bit) && (before & bit)) let |= bit;
      }
      before = buttons;
      write(buttons);
    }
    const NewTicks::Buttons changed = read();
    EXPECT_EQ(changed.pressed, pressed) << poll;
    EXPECT_EQ(changed.let, let) << poll;
  }
}

/// Two keys that are pressed one after the other are not one key that is both.
TEST_F(NewTicksTest, WhatIsPressedInOneTickIsToldTogether) {
  for (const std::uint32_t buttons : {4, 0, 1, 5, 4, 1, 0, 5, 7}) write(buttons);
  const NewTicks::Buttons changed = read();
  EXPECT_EQ(changed.pressed, 7U);
  EXPECT_THAT(pressed_together, ::testing::ElementsAre(4, 1, 4, 1, 5, 2));
}

TEST_F(NewTicksTest, ARestartedSessionIsReadFromItsFirstTick) {
  write(3);
  write(3);
  read();
  TickRing again(16);
  for (std::uint64_t n = 0; n < 2; ++n) {
    TickRecord first;
    first.index = n;
    first.buttons = 3;
    again.push(first, {});
  }
  const auto read_again = [&] {
    seen.clear();
    return ticks.read(again, tick, shares, [this](std::uint32_t) { seen.push_back(tick.index); });
  };
  read_again();
  EXPECT_THAT(seen, ::testing::IsEmpty()) << "it does not know yet";
  ticks.count_anew();
  EXPECT_EQ(read_again().pressed, 0U) << "still held down";
  EXPECT_THAT(seen, ::testing::ElementsAre(0, 1));
  ticks.restart();
  EXPECT_EQ(read_again().pressed, 3U) << "another session";
  EXPECT_THAT(seen, ::testing::ElementsAre(0, 1));
}

}  // namespace
}  // namespace palpate::plugin
