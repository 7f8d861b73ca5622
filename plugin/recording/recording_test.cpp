#include "plugin/recording/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include <fstream>
#include <random>

#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

using testing::fresh_path;

Recording random_recording(std::size_t frames) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.header = {.palpate_version = "1.2.3",
                      .scene = std::string(100000, 's'),
                      .device = "simulated",
                      .scan_hash = "0123456789abcdef",
                      .seed = 42};
  for (std::size_t n = 0; n < frames; ++n) {
    TickRecord frame;
    frame.index = n;
    frame.time_s = 1e-3 * static_cast<double>(n);
    frame.probe_m[1] = normal(random);
    frame.sent_n[2] = normal(random) * 1e-300;
    frame.value = n % 2 == 0 ? std::numeric_limits<double>::quiet_NaN() : normal(random);
    frame.stage_ns[stage_count - 1] = static_cast<std::uint32_t>(random());
    frame.share_count = static_cast<std::uint32_t>(n % 3);
    for (std::uint32_t share = 0; share < frame.share_count; ++share) {
      recording.shares.push_back({.frame = n, .mode = share, .type = 3, .strength_n = normal(random)});
    }
    recording.frames.push_back(frame);
  }
  return recording;
}

TEST(Recording, ReadsBackToTheLastBit) {
  const auto file = fresh_path("round_trip.h5");
  const Recording written = random_recording(10000);
  write_recording(written, file);
  const Recording read = read_recording(file);
  EXPECT_EQ(read.header.scene, written.header.scene);
  EXPECT_EQ(read.header.scan_hash, written.header.scan_hash);
  EXPECT_EQ(read.header.seed, written.header.seed);
  ASSERT_EQ(read.frames.size(), written.frames.size());
  ASSERT_EQ(read.shares.size(), written.shares.size());
  EXPECT_EQ(std::memcmp(read.frames.data(), written.frames.data(), sizeof(TickRecord) * read.frames.size()), 0);
  EXPECT_EQ(std::memcmp(read.shares.data(), written.shares.data(), sizeof(PrimitiveRecord) * read.shares.size()), 0);
}

TEST(Recording, AnEmptySessionIsARecordingToo) {
  const auto file = fresh_path("empty.h5");
  write_recording({}, file);
  EXPECT_TRUE(read_recording(file).frames.empty());
}

TEST(Recording, LeavesNothingBehindWhereItCannotWrite) {
  const auto folder = fresh_path("no_such_folder");
  EXPECT_THROW(write_recording(random_recording(1), folder / "r.h5"), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(Recording, RefusesWhatIsNotOneNamingTheFile) {
  const auto file = fresh_path("text.h5");
  std::ofstream(file) << "not HDF5";
  try {
    read_recording(file);
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("text.h5"));
  }
  EXPECT_THROW(read_recording(fresh_path("absent.h5")), std::runtime_error);
}

}  // namespace
}  // namespace palpate::plugin
