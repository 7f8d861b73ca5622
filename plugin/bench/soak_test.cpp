// A minute of `palpate-bench soak` as fast as possible, and some seconds of it at the clock's pace.
#include "plugin/bench/soak.h"

#include <gtest/gtest.h>

#include "plugin/testing/test_files.h"
#include "solver/text/testing/sanitized.h"

namespace palpate::plugin {
namespace {

SoakResult soak_in_a_folder_of_its_own(SoakOptions options) {
  options.folder = testing::fresh_path("soak");
  std::filesystem::create_directory(options.folder);
  SoakResult result = soak(options);
  EXPECT_TRUE(std::filesystem::is_empty(options.folder)) << "parts are removed once replayed";
  return result;
}

void expect_sound(const SoakResult& result) {
  EXPECT_EQ(result.over_limit, 0U);
  EXPECT_EQ(result.not_finite, 0U);
  EXPECT_EQ(result.unaccounted, 0U);
  EXPECT_EQ(result.lost, 0U);
  EXPECT_EQ(result.replay.ticks, result.ticks);
  EXPECT_EQ(result.replay.different, 0U) << "first: " << result.replay.first_different.value_or(0);
  EXPECT_EQ(result.replay.after_gap, 0U);
  EXPECT_GT(result.largest_n, 0.5) << "something has to be felt";
}

constexpr double minutes = is_sanitized ? 0.25 : 1;

TEST(Soak, AMinuteOfProbing) {
  const SoakResult result =
      soak_in_a_folder_of_its_own({.minutes = minutes, .seconds_of_scan = 5, .seconds_between_unplugs = 4});
  expect_sound(result);
  EXPECT_GE(static_cast<double>(result.ticks), 60000 * minutes);
  EXPECT_GE(static_cast<double>(result.scenes), 55 * minutes);
  EXPECT_GE(static_cast<double>(result.scans), 8 * minutes);
  EXPECT_GE(result.unplugs, 1U);
  EXPECT_GE(result.faulty_ticks, 200U);
  EXPECT_GE(result.points.size(), 2U);
}

TEST(Soak, AtTheClocksPace) {
  const SoakResult result = soak_in_a_folder_of_its_own({.minutes = 4.0 / 60,
                                                         .seconds_of_scan = 1,
                                                         .seconds_of_scene = 0.5,
                                                         .seconds_between_unplugs = 1.5,
                                                         .at_clock_pace = true});
  expect_sound(result);
  EXPECT_GE(result.ticks + result.missed, 3900U);
}

}  // namespace
}  // namespace palpate::plugin
