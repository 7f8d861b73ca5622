#include "device/testing/random_faults.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>

#include "device/link/realtime.h"

namespace palpate::device {
namespace {

/// As many as a minute allows, of which a busy machine gives only a part: 1500 take half a minute of a processor.
/// `palpate-faults --random 100000` plays as many as one likes.
TEST(RandomFaults, NoSequenceOfEventsBreaksALawAtTheDevice) {
  constexpr std::uint64_t most = 1500, fewest = 40;
  constexpr double longest_s = 60;
  const double begun = monotonic_time();
  std::uint64_t seed = 0;
  while (seed < most && (seed < fewest || monotonic_time() - begun < longest_s)) {
    ++seed;
    EXPECT_EQ(play_random_faults(seed), "") << "seed " << seed;
  }
  std::printf("%llu sequences\n", static_cast<unsigned long long>(seed));
}

}  // namespace
}  // namespace palpate::device
