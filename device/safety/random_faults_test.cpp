#include "device/testing/random_faults.h"

#include <gtest/gtest.h>

#include "solver/text/testing/sanitized.h"

namespace palpate::device {
namespace {

/// `palpate-faults --random 100000` plays as many as one likes.
TEST(RandomFaults, NoSequenceOfEventsBreaksALawAtTheDevice) {
  const std::uint64_t sequences = is_sanitized ? 10 : 60;
  for (std::uint64_t seed = 1; seed <= sequences; ++seed) EXPECT_EQ(play_random_faults(seed), "") << "seed " << seed;
}

}  // namespace
}  // namespace palpate::device
