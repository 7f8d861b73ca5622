#include "plugin/session/broadcast_ring.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace palpate::plugin {
namespace {

struct Item {
  std::array<std::uint64_t, 12> words;  // all alike: a torn one shows
};

TEST(BroadcastRing, KeepsTheNewestAndSaysWhichAreGone) {
  BroadcastRing<std::uint64_t> ring(5);
  EXPECT_EQ(ring.capacity(), 8U);
  for (std::uint64_t n = 0; n < 20; ++n) ring.push(100 + n);
  EXPECT_EQ(ring.written(), 20U);
  EXPECT_EQ(ring.oldest(), 12U);
  std::uint64_t item = 0;
  for (std::uint64_t n = ring.oldest(); n < ring.written(); ++n) {
    ASSERT_TRUE(ring.read(n, item)) << n;
    EXPECT_EQ(item, 100 + n);
  }
  EXPECT_FALSE(ring.read(11, item));
}

TEST(BroadcastRing, ReadersNeverSeeATornItemHoweverFastTheWriter) {
  BroadcastRing<Item> ring(16);
  constexpr std::uint64_t items = 100000;
  std::array<std::uint64_t, 2> got{};
  std::array<bool, 2> whole{true, true};
  const auto read_all = [&](std::size_t reader) {
    Item item{};
    for (std::uint64_t n = 0; n < items;) {
      const std::uint64_t written = ring.written();
      if (n == written) {
        std::this_thread::yield();
        continue;
      }
      n = std::max(n, ring.oldest());
      if (n < written && ring.read(n, item)) {
        ++got[reader];
        for (const std::uint64_t word : item.words) whole[reader] = whole[reader] && word == n;
      }
      ++n;
    }
  };
  std::thread first(read_all, 0), second(read_all, 1);
  for (std::uint64_t n = 0; n < items; ++n) {
    Item item{};
    item.words.fill(n);
    ring.push(item);
    // Seldom: on a busy machine each lets others go first for milliseconds.
    if (n % 512 == 511) std::this_thread::yield();
  }
  first.join();
  second.join();
  EXPECT_TRUE(whole[0] && whole[1]);
  EXPECT_GT(got[0], 0U);
  EXPECT_GT(got[1], 0U);
}

}  // namespace
}  // namespace palpate::plugin
