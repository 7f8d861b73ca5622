#include "plugin/recording/recording.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <type_traits>

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

/// Each column holds the member that it is named after: every number here is another.
TEST(Recording, ItsCsvHasEveryMemberUnderItsName) {
  TickRecord frame;
  std::map<std::string, std::string> expected;
  double number = 1000.5;
  const auto set = [&](const char* name, auto& member) {
    number += 1;
    member = static_cast<std::remove_reference_t<decltype(member)>>(number);
    expected[name] = fmt::format("{}", member);
  };
  const auto set_vector = [&](const std::string& name, double(&member)[3]) {
    set((name + "_x").c_str(), member[0]);
    set((name + "_y").c_str(), member[1]);
    set((name + "_z").c_str(), member[2]);
  };
  set("index", frame.index);
  set("time_s", frame.time_s);
  set("dt_s", frame.dt_s);
  set("pose_time_s", frame.pose_time_s);
  set("heartbeat_s", frame.heartbeat_s);
  set_vector("probe_m", frame.probe_m);
  set_vector("proxy_m", frame.proxy_m);
  set_vector("force_n", frame.force_n);
  set_vector("sent_n", frame.sent_n);
  set("value", frame.value);
  set("residual_n", frame.residual_n);
  set("error_bound_m", frame.error_bound_m);
  set("change_part", frame.change_part);
  set("scene_epoch", frame.scene_epoch);
  set("sub_steps", frame.sub_steps);
  set("halts", frame.halts);
  set("iterations", frame.iterations);
  set("solver", frame.solver);
  set("outcome", frame.outcome);
  set("safety", frame.safety);
  set("share_count", frame.share_count);
  set("buttons", frame.buttons);
  set("fresh", frame.fresh);
  set("stylus_state", frame.stylus_state);
  set("stylus_epoch", frame.stylus_epoch);
  set("commands", frame.commands);
  set("from_brick", frame.from_brick);
  set("missed", frame.missed);
  set("late_ns", frame.late_ns);
  for (const char* stage : {"read", "map", "sample", "modes", "solve", "filter", "write", "observe"}) {
    set((std::string(stage) + "_ns").c_str(), frame.stage_ns[expected.size() - 37]);
  }
  Recording recording;
  recording.frames = {frame};
  const auto file = fresh_path("named.csv");
  write_csv(recording, file);
  std::ifstream lines(file);
  std::string names, values;
  std::getline(lines, names);
  std::getline(lines, values);
  std::istringstream name_stream(names), value_stream(values);
  std::map<std::string, std::string> told;
  std::string name, value;
  while (std::getline(name_stream, name, ',') && std::getline(value_stream, value, ',')) told[name] = value;
  EXPECT_EQ(told, expected);
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
