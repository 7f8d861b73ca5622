#include "plugin/recording/recording.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <type_traits>

#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

using testing::fresh_path;

Recording random_recording(std::size_t ticks) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.header = {.palpate_version = "1.2.3",
                      .scene = std::string(100000, 's'),
                      .device = "simulated",
                      .scan_hash = "0123456789abcdef",
                      .seed = 42};
  for (std::size_t n = 0; n < ticks; ++n) {
    TickRecord tick;
    tick.index = n;
    tick.time_s = 1e-3 * static_cast<double>(n);
    tick.probe_m[1] = normal(random);
    tick.sent_n[2] = normal(random) * 1e-300;
    tick.value = n % 2 == 0 ? std::numeric_limits<double>::quiet_NaN() : normal(random);
    tick.stage_ns[stage_count - 1] = static_cast<std::uint32_t>(random());
    tick.share_count = static_cast<std::uint32_t>(n % 3);
    for (std::uint32_t share = 0; share < tick.share_count; ++share) {
      recording.shares.push_back({.tick = n, .mode = share, .type = 3, .strength_n = normal(random)});
    }
    recording.ticks.push_back(tick);
    recording.known_to_mm.push_back(n % 5 == 0 ? std::numeric_limits<double>::quiet_NaN() : std::abs(normal(random)));
  }
  recording.scenes = {{.epoch = 0, .scene = recording.header.scene, .scan_hash = "a", .frame = ScanFrame{3, 17}},
                      {.epoch = 1, .scene = recording.header.scene, .scan_hash = "b", .frame = ScanFrame{0, 17}},
                      {.epoch = 2, .scene = recording.header.scene, .scan_hash = "a", .frame = ScanFrame{3, 17}},
                      {.epoch = 3, .scene = recording.header.scene, .scan_hash = "c"}};
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
  ASSERT_EQ(read.ticks.size(), written.ticks.size());
  ASSERT_EQ(read.shares.size(), written.shares.size());
  EXPECT_EQ(std::memcmp(read.ticks.data(), written.ticks.data(), sizeof(TickRecord) * read.ticks.size()), 0);
  EXPECT_EQ(std::memcmp(read.shares.data(), written.shares.data(), sizeof(PrimitiveRecord) * read.shares.size()), 0);
  ASSERT_EQ(read.known_to_mm.size(), written.known_to_mm.size());
  EXPECT_EQ(std::memcmp(read.known_to_mm.data(), written.known_to_mm.data(), sizeof(double) * read.ticks.size()), 0);
  ASSERT_EQ(read.scenes.size(), written.scenes.size());
  for (std::size_t n = 0; n < read.scenes.size(); ++n) EXPECT_EQ(read.scenes[n].frame, written.scenes[n].frame) << n;
  EXPECT_EQ(scan_frames_of(read), (std::vector<ScanFrame>{{3, 17}, {0, 17}}));
}

/// Each column holds the member that it is named after: every number here is another.
TEST(Recording, ItsCsvHasEveryMemberUnderItsName) {
  TickRecord tick;
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
  set("index", tick.index);
  set("time_s", tick.time_s);
  set("dt_s", tick.dt_s);
  set("pose_time_s", tick.pose_time_s);
  set("heartbeat_s", tick.heartbeat_s);
  set_vector("probe_m", tick.probe_m);
  set_vector("proxy_m", tick.proxy_m);
  set_vector("force_n", tick.force_n);
  set_vector("sent_n", tick.sent_n);
  set("value", tick.value);
  set("residual_n", tick.residual_n);
  set("error_bound_m", tick.error_bound_m);
  set("change_part", tick.change_part);
  set("scene_epoch", tick.scene_epoch);
  set("sub_steps", tick.sub_steps);
  set("halts", tick.halts);
  set("iterations", tick.iterations);
  set("solver", tick.solver);
  set("outcome", tick.outcome);
  set("safety", tick.safety);
  set("share_count", tick.share_count);
  set("buttons", tick.buttons);
  set("fresh", tick.fresh);
  set("stylus_state", tick.stylus_state);
  set("stylus_epoch", tick.stylus_epoch);
  set("commands", tick.commands);
  set("from_brick", tick.from_brick);
  set("missed", tick.missed);
  set("late_ns", tick.late_ns);
  for (const char* stage : {"read", "map", "sample", "modes", "solve", "filter", "write", "observe"}) {
    set((std::string(stage) + "_ns").c_str(), tick.stage_ns[expected.size() - 37]);
  }
  Recording recording;
  recording.ticks = {tick};
  recording.known_to_mm = {0.375};
  expected["known_to_mm"] = "0.375";
  recording.scenes = {{.epoch = tick.scene_epoch, .frame = ScanFrame{2, 5}}};
  expected["scan_frame"] = "2";
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
  EXPECT_TRUE(read_recording(file).ticks.empty());
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

// HDF5 takes what does not match its checksum for half written, and would wait for its writer.
TEST(Recording, IsReadOrRefusedAtOnceWhereverAByteIsDamaged) {
  const auto whole = fresh_path("whole.h5"), damaged = fresh_path("damaged.h5");
  write_recording(random_recording(30), whole);
  std::ifstream input(whole, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(input), {}};
  std::mt19937_64 random(11);
  for (int n = 0; n < 300; ++n) {
    std::string other = bytes;
    // The header first, byte by byte.
    const std::size_t at = n < 100 ? static_cast<std::size_t>(n) : random() % other.size();
    other[at] = static_cast<char>(other[at] ^ (1U << (random() % 8)));
    std::ofstream(damaged, std::ios::binary) << other;
    const auto began = std::chrono::steady_clock::now();
    try {
      static_cast<void>(read_recording(damaged));
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("damaged.h5")) << at;
    }
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5)) << at;
  }
}

/// The same recording with a text of another kind: as many as given, or one whose length is not given.
void put_text(const std::filesystem::path& file, const char* name, hsize_t count, std::size_t size) {
  const hid_t input = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(input, 0);
  ASSERT_GE(H5Ldelete(input, name, H5P_DEFAULT), 0);
  const hid_t type = H5Tcopy(H5T_C_S1);
  ASSERT_GE(H5Tset_size(type, size), 0);
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t data = H5Dcreate2(input, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(data, 0);
  H5Dclose(data);
  H5Sclose(space);
  H5Tclose(type);
  H5Fclose(input);
}

TEST(Recording, OfTextsOfAnotherKindIsRefused) {
  const auto file = fresh_path("texts.h5");
  for (const auto& [count, size] : {std::pair<hsize_t, std::size_t>{100000, 16}, {0, 16}, {1, H5T_VARIABLE}}) {
    write_recording(random_recording(3), file);
    put_text(file, "device", count, size);
    EXPECT_THROW(read_recording(file), std::runtime_error) << count;
  }
}

}  // namespace
}  // namespace palpate::plugin
