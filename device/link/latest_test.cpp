#include "device/link/latest.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace palpate::device {
namespace {

TEST(Latest, KeepsTheNewest) {
  Latest<int> latest(1);
  EXPECT_EQ(latest.load(), 1);
  EXPECT_FALSE(latest.has_news());
  latest.store(2);
  latest.store(3);
  EXPECT_TRUE(latest.has_news());
  EXPECT_EQ(latest.load(), 3);
  EXPECT_EQ(latest.load(), 3);
}

TEST(Latest, NeverTearsAndNeverGoesBack) {
  using Words = std::array<long, 16>;
  constexpr long last = 200'000;
  Latest<Words> latest(Words{});
  std::thread writer([&] {
    Words words{};
    for (long i = 1; i <= last; ++i) {
      words.fill(i);
      latest.store(words);
    }
  });
  long previous = 0;
  while (previous < last) {
    const Words& words = latest.load();
    for (const long word : words) ASSERT_EQ(word, words[0]);
    ASSERT_GE(words[0], previous);
    previous = words[0];
  }
  writer.join();
}

}  // namespace
}  // namespace palpate::device
