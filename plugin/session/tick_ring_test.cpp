/// What can still be read of the ticks that a session left, against a list of all of them.

#include "plugin/session/tick_ring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace palpate::plugin {
namespace {

/// The last ticks, and of each its shares if they are among the last four times as many: all of them or none.
TEST(TickRing, HoldsTheLastTicksWithFourSharesInEach) {
  constexpr std::uint64_t most = 16;
  for (const unsigned most_shares : {0U, 4U, 5U, 12U}) {
    std::mt19937 random(most_shares);
    TickRing ring(most);
    ASSERT_EQ(ring.capacity(), most);
    std::vector<TickRecord> ticks;
    std::vector<std::size_t> first_share;
    std::vector<PrimitiveRecord> shares;
    int whole = 0, without = 0;
    for (std::uint64_t n = 0; n < 300; ++n) {
      TickRecord tick;
      tick.index = 1000 + n;
      tick.value = static_cast<double>(n) + 0.5;
      tick.share_count = most_shares == 4 ? 4 : static_cast<std::uint32_t>(random() % (most_shares + 1));
      first_share.push_back(shares.size());
      for (std::uint32_t share = 0; share < tick.share_count; ++share) {
        shares.push_back({.tick = tick.index, .mode = share, .strength_n = static_cast<double>(shares.size())});
      }
      ticks.push_back(tick);
      ring.push(tick, std::span(shares).subspan(first_share.back()));
      ASSERT_EQ(ring.written(), n + 1);
      ASSERT_EQ(ring.oldest(), std::max<std::uint64_t>(n + 1, most) - most);
      for (std::uint64_t of = ring.oldest() > 2 ? ring.oldest() - 2 : 0; of <= n; ++of) {
        const bool is_there = of + most > n;
        const bool has_shares = ticks[of].share_count == 0 || first_share[of] + 4 * most >= shares.size();
        TickRecord told;
        ASSERT_EQ(ring.read(of, told), is_there) << n << " " << of;
        ASSERT_EQ(told.index, is_there ? ticks[of].index : 0);
        ASSERT_EQ(told.value, is_there ? ticks[of].value : 0);
        told = {};
        std::vector<PrimitiveRecord> kept(3);  // that were there before
        ASSERT_EQ(ring.read(of, told, &kept), is_there && has_shares) << n << " " << of;
        ASSERT_EQ(kept.size(), 3 + (is_there && has_shares ? ticks[of].share_count : 0));
        for (std::size_t share = 3; share < kept.size(); ++share) {
          ASSERT_EQ(kept[share].tick, ticks[of].index);
          ASSERT_EQ(kept[share].mode, share - 3);
          ASSERT_EQ(kept[share].strength_n, static_cast<double>(first_share[of] + share - 3));
        }
        ASSERT_EQ(told.index, is_there && has_shares ? ticks[of].index : 0);
        whole += is_there && has_shares ? 1 : 0;
        without += is_there && !has_shares ? 1 : 0;
      }
    }
    EXPECT_GT(whole, 300);
    EXPECT_EQ(without > 0, most_shares > 8);
  }
}

}  // namespace
}  // namespace palpate::plugin
