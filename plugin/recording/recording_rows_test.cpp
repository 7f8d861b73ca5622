/// The names in a recording, by which other programs read it; and its events.

#include "plugin/recording/recording_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <string>
#include <vector>

#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

using testing::fresh_path;

/// A column of the file read by its name alone, as NumPy would: the row has no other member.
template <typename Number>
std::vector<Number> column(const std::filesystem::path& file, const char* table, const char* name, hid_t type,
                           hsize_t count = 1) {
  const hid_t input = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t data = H5Dopen2(input, table, H5P_DEFAULT);
  const hid_t space = H5Dget_space(data);
  const hid_t member = count == 1 ? H5Tcopy(type) : H5Tarray_create2(type, 1, &count);
  const hid_t row = H5Tcreate(H5T_COMPOUND, H5Tget_size(member));
  H5Tinsert(row, name, 0, member);
  std::vector<Number> numbers(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) * count);
  EXPECT_GE(H5Dread(data, row, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0) << name;
  for (const hid_t of_type : {row, member}) H5Tclose(of_type);
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(input);
  return numbers;
}

/// Other programs read a recording by the names of its columns: each holds the member that it is named after.
TEST(RecordingRows, EveryColumnOfItsFileHoldsWhatItIsNamedAfter) {
  TickRecord tick{.index = 1,
                  .time_s = 2,
                  .dt_s = 3,
                  .pose_time_s = 4,
                  .heartbeat_s = 5,
                  .probe_m = {6, 7, 8},
                  .proxy_m = {9, 10, 11},
                  .force_n = {12, 13, 14},
                  .sent_n = {15, 16, 17},
                  .value = 18,
                  .residual_n = 19,
                  .error_bound_m = 20,
                  .change_part = 21,
                  .distance_mm = {22, 23, 24, 25, 26, 27, 28, 29},
                  .scene_epoch = 30,
                  .sub_steps = 31,
                  .halts = 32,
                  .iterations = 33,
                  .solver = 34,
                  .outcome = 35,
                  .safety = 36,
                  .share_count = 1,
                  .buttons = 37,
                  .fresh = 38,
                  .stylus_state = 39,
                  .stylus_epoch = 40,
                  .commands = 41,
                  .from_brick = 42,
                  .missed = 43,
                  .late_ns = 44,
                  .stage_ns = {45, 46, 47, 48, 49, 50, 51, 52}};
  Recording recording;
  recording.ticks = {tick};
  recording.shares = {{.tick = 53, .mode = 54, .type = 55, .strength_n = 56, .force_n = {57, 58, 59}}};
  recording.known_to_mm = {60};
  const auto file = fresh_path("columns.h5");
  write_recording(recording, file);
  const auto doubles = [&](const char* table, const char* name, hsize_t count = 1) {
    return column<double>(file, table, name, H5T_NATIVE_DOUBLE, count);
  };
  const auto counts = [&](const char* table, const char* name, hsize_t count = 1) {
    return column<std::uint32_t>(file, table, name, H5T_NATIVE_UINT32, count);
  };
  double number = 1;
  EXPECT_EQ(counts("frames", "index").front(), number++);
  for (const char* name : {"time_s", "dt_s", "pose_time_s", "heartbeat_s"}) {
    EXPECT_EQ(doubles("frames", name).front(), number++) << name;
  }
  for (const char* name : {"probe_m", "proxy_m", "force_n", "sent_n"}) {
    for (const double one : doubles("frames", name, 3)) EXPECT_EQ(one, number++) << name;
  }
  for (const char* name : {"value", "residual_n", "error_bound_m", "change_part"}) {
    EXPECT_EQ(doubles("frames", name).front(), number++) << name;
  }
  for (const double one : doubles("frames", "distance_mm", 8)) EXPECT_EQ(one, number++);
  for (const char* name : {"scene_epoch", "sub_steps", "halts", "iterations", "solver", "outcome", "safety", "buttons",
                           "fresh", "stylus_state", "stylus_epoch", "commands", "from_brick", "missed", "late_ns"}) {
    EXPECT_EQ(counts("frames", name).front(), number++) << name;
  }
  EXPECT_EQ(counts("frames", "share_count").front(), 1);
  for (const double one : counts("frames", "stage_ns", 8)) EXPECT_EQ(one, number++);
  for (const char* name : {"frame", "mode", "type"}) EXPECT_EQ(counts("shares", name).front(), number++) << name;
  EXPECT_EQ(doubles("shares", "strength_n").front(), number++);
  for (const double one : doubles("shares", "force_n", 3)) EXPECT_EQ(one, number++);
  EXPECT_EQ(read_recording(file).known_to_mm, std::vector<double>{number});
}

/// What is noted beside the ticks comes back with every number, in the order in which it was noted.
TEST(RecordingRows, ScenesStylusesAndGapsReadBackWithAllThatTheySay) {
  io::RigidMotion motion;
  motion.turn = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  motion.shift = {11.1, -12.2, 13.3};
  Recording written;
  written.header = {.palpate_version = "3.2.1", .device = "a stylus", .scan_hash = "f00", .seed = 17, .rate_hz = 4000};
  written.scenes = {{.epoch = 4,
                     .scene = "first",
                     .scan_hash = "one",
                     .half_extent_m = {0.1, 0.2, 0.3},
                     .maximum_force_n = 8.5,
                     .change_s = 0.75,
                     .structures = {"liver", "aorta"},
                     .registered = {{"aorta", "abc", motion}},
                     .frame = ScanFrame{2, 9}},
                    {.epoch = 6, .scene = "second", .scan_hash = "two"}};
  written.styluses = {{.epoch = 1, .name = "falcon", .force_axes = 3, .maximum_force_n = 7.5},
                      {.epoch = 5, .name = "mouse", .force_axes = 0, .maximum_force_n = 0}};
  written.gaps = {{.first_tick = 100, .ticks = 7}, {.first_tick = 300, .ticks = 11}};
  const auto file = fresh_path("events.h5");
  write_recording(written, file);
  const Recording read = read_recording(file);
  EXPECT_EQ(read.header.palpate_version, "3.2.1");
  EXPECT_EQ(read.header.device, "a stylus");
  EXPECT_EQ(read.header.scan_hash, "f00");
  EXPECT_EQ(read.header.scene, "first");
  EXPECT_EQ(read.header.seed, 17);
  EXPECT_EQ(read.header.rate_hz, 4000);
  ASSERT_EQ(read.scenes.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(read.scenes[n].epoch, written.scenes[n].epoch);
    EXPECT_EQ(read.scenes[n].scene, written.scenes[n].scene);
    EXPECT_EQ(read.scenes[n].scan_hash, written.scenes[n].scan_hash);
    EXPECT_EQ(read.scenes[n].half_extent_m, written.scenes[n].half_extent_m);
    EXPECT_EQ(read.scenes[n].maximum_force_n, written.scenes[n].maximum_force_n);
    EXPECT_EQ(read.scenes[n].change_s, written.scenes[n].change_s);
    EXPECT_EQ(read.scenes[n].structures, written.scenes[n].structures);
    EXPECT_EQ(read.scenes[n].registered, written.scenes[n].registered);
    EXPECT_EQ(read.scenes[n].frame, written.scenes[n].frame);
  }
  ASSERT_EQ(read.styluses.size(), 2U);
  ASSERT_EQ(read.gaps.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(read.styluses[n].epoch, written.styluses[n].epoch);
    EXPECT_EQ(read.styluses[n].name, written.styluses[n].name);
    EXPECT_EQ(read.styluses[n].force_axes, written.styluses[n].force_axes);
    EXPECT_EQ(read.styluses[n].maximum_force_n, written.styluses[n].maximum_force_n);
    EXPECT_EQ(read.gaps[n].first_tick, written.gaps[n].first_tick);
    EXPECT_EQ(read.gaps[n].ticks, written.gaps[n].ticks);
  }
}

/// The matrix of a registration in the file's text, as DICOM has it: row by row, the shift last in each row.
TEST(RecordingRows, ARegistrationIsWrittenRowByRow) {
  io::RigidMotion motion;
  motion.turn = {1, 5, 9, 2, 6, 10, 3, 7, 11};  // column by column
  motion.shift = {4, 8, 12};
  const std::string line = to_line(SceneRecord{.registered = {{"aorta", "abc", motion}}});
  EXPECT_THAT(line, ::testing::HasSubstr("[1.0,2.0,3.0,4.0,5.0,6.0,7.0,8.0,9.0,10.0,11.0,12.0,0.0,0.0,0.0,1.0]"));
}

/// A name may come from a file in any letters, and be cut anywhere: its events stay events.
TEST(RecordingRows, NamesThatAreNoTextEndNoRecording) {
  const std::string no_text = "L\xe4sion \xff\xc3";
  const std::string events =
      to_line(SceneRecord{.epoch = 3, .scene = no_text, .scan_hash = no_text, .structures = {no_text}}) +
      to_line(StylusRecord{.epoch = 4, .name = no_text}) + to_line(Gap{.first_tick = 5, .ticks = 6});
  Recording recording;
  read_events(events, recording);
  ASSERT_EQ(recording.scenes.size(), 1U);
  EXPECT_EQ(recording.scenes[0].epoch, 3U);
  ASSERT_EQ(recording.scenes[0].structures.size(), 1U);
  EXPECT_THAT(recording.scenes[0].structures[0], ::testing::StartsWith("L\ufffdsion"));
  ASSERT_EQ(recording.styluses.size(), 1U);
  EXPECT_EQ(recording.styluses[0].epoch, 4U);
  ASSERT_EQ(recording.gaps.size(), 1U);
  EXPECT_EQ(recording.gaps[0].ticks, 6U);
}

}  // namespace
}  // namespace palpate::plugin
