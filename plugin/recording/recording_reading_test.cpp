/// Reading a recording's texts and lines, and the message about a file that is not a recording.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "io/testing/file_bytes.h"
#include "plugin/recording/recording.h"
#include "plugin/recording/recording_rows.h"
#include "plugin/recording/recording_writer.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using testing::fresh_path;

/// Texts of every length, also none.
TEST(RecordingReading, TextsOfEveryLengthReadBack) {
  for (const std::size_t length : {0U, 1U, 2U, 16U, 70000U}) {
    Recording recording;
    recording.header.palpate_version = std::string(length, 'v');
    recording.header.device = std::string(length, 'd');
    recording.header.scan_hash = std::string(length, 'h');
    const auto file = fresh_path("texts.h5");
    write_recording(recording, file);
    const Recording read = read_recording(file);
    EXPECT_EQ(read.header.palpate_version, recording.header.palpate_version);
    EXPECT_EQ(read.header.device, recording.header.device);
    EXPECT_EQ(read.header.scan_hash, recording.header.scan_hash);
    EXPECT_EQ(read.header.scene, "");
    EXPECT_TRUE(read.scenes.empty());
  }
  // A header's scene alone is a scene of the header's scan.
  Recording recording;
  recording.header.scene = "{\"a\": 1}";
  recording.header.scan_hash = "f00";
  const auto file = fresh_path("scene.h5");
  write_recording(recording, file);
  const Recording read = read_recording(file);
  EXPECT_EQ(read.header.scene, recording.header.scene);
  ASSERT_EQ(read.scenes.size(), 1U);
  EXPECT_EQ(read.scenes[0].scene, recording.header.scene);
  EXPECT_EQ(read.scenes[0].scan_hash, "f00");
  EXPECT_EQ(read.scenes[0].epoch, 0U);
}

std::string why_unread(const fs::path& file) {
  try {
    read_recording(file);
    return "read";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

/// Another program's HDF5 file, in which one dataset is of another kind.
template <typename Make>
fs::path with_version(const Make& make) {
  const auto file = fresh_path("other.h5");
  write_recording({}, file);
  const hid_t output = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(output, "palpate_version", H5P_DEFAULT);
  const auto [type, space] = make();
  const hid_t data = H5Dcreate2(output, "palpate_version", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  EXPECT_GE(data, 0);
  H5Dclose(data);
  H5Sclose(space);
  H5Tclose(type);
  H5Fclose(output);
  return file;
}

/// What is no recording is refused by what is wrong with it; and HDF5 itself says nothing, in any thread.
TEST(RecordingReading, WhatIsNoRecordingIsRefusedInWordsOfOurs) {
  const auto text = [](hid_t size) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, static_cast<std::size_t>(size));
    return type;
  };
  const auto cannot = [](const fs::path& file, const std::string& what) {
    return "cannot read the recording " + file.string() + ": HDF5 cannot " + what;
  };
  const auto plain = fresh_path("plain.h5"), empty = fresh_path("nothing.h5"), absent = fresh_path("absent.h5");
  std::ofstream(plain) << "not HDF5";
  H5Fclose(H5Fcreate(empty.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  const auto number = with_version([] { return std::pair(H5Tcopy(H5T_NATIVE_INT), H5Screate(H5S_SCALAR)); });
  EXPECT_EQ(why_unread(number), cannot(number, "read what is in it"));
  const auto variable = with_version([] {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    return std::pair(type, H5Screate(H5S_SCALAR));
  });
  EXPECT_EQ(why_unread(variable), cannot(variable, "read what is in it"));
  const auto several = with_version([&] {
    const hsize_t two = 2;
    return std::pair(text(4), H5Screate_simple(1, &two, nullptr));
  });
  EXPECT_EQ(why_unread(several), cannot(several, "read what is in it"));
  const auto one = with_version([&] { return std::pair(text(4), H5Screate(H5S_SCALAR)); });
  EXPECT_EQ(why_unread(one), "read");
  /// What HDF5 says on the way, told to say all that it can.
  const auto said_by_hdf5 = [](const auto& step) {
    H5Eset_auto2(H5E_DEFAULT, reinterpret_cast<H5E_auto2_t>(H5Eprint2), nullptr);
    ::testing::internal::CaptureStderr();
    step();
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(
      said_by_hdf5([&] { EXPECT_EQ(why_unread(plain), cannot(plain, "open it (is it a recording of Palpate's?)")); }),
      "");
  EXPECT_EQ(
      said_by_hdf5([&] { EXPECT_EQ(why_unread(absent), cannot(absent, "open it (is it a recording of Palpate's?)")); }),
      "");
  EXPECT_EQ(said_by_hdf5([&] { EXPECT_EQ(why_unread(empty), cannot(empty, "find what a recording holds")); }), "");
  const auto nowhere = fresh_path("no_such_folder") / "r.h5";
  EXPECT_EQ(said_by_hdf5([&] {
              try {
                RecordingWriter(nowhere, {});
                ADD_FAILURE() << "written";
              } catch (const std::runtime_error& error) {
                EXPECT_EQ(error.what(),
                          "cannot write the recording " + nowhere.string() +
                              ": HDF5 cannot create the file (does its folder exist, and may you write there?)");
              }
            }),
            "");
}

/// The table of a recording, made longer without rows.
fs::path with_rows(const Recording& recording, const char* table, hsize_t rows) {
  const auto file = fresh_path("long.h5");
  write_recording(recording, file);
  const hid_t output = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t data = H5Dopen2(output, table, H5P_DEFAULT);
  EXPECT_GE(H5Dset_extent(data, &rows), 0);
  H5Dclose(data);
  H5Fclose(output);
  return file;
}

/// A file of a few kB may claim to hold any number of rows: no memory is taken for them.
TEST(RecordingReading, WhatClaimsToHoldMoreThanIsStoredIsRefused) {
  constexpr std::size_t much = 1U << 26U;
  const auto claims = [](const fs::path& file, const std::string& name, std::size_t bytes) {
    return "cannot read the recording " + file.string() + ": " + name + " claims to hold " + std::to_string(bytes) +
           " bytes, but only 0 are stored: the file is damaged";
  };
  for (const auto& [name, size] : {std::pair("frames", sizeof(TickRecord)),
                                   {"shares", sizeof(PrimitiveRecord)},
                                   {"known_to_mm", sizeof(double)},
                                   {"events", sizeof(char)}}) {
    const std::size_t rows = much / size;
    const auto file = with_rows({}, name, rows);
    EXPECT_LT(fs::file_size(file), 100'000U) << name;
    EXPECT_EQ(why_unread(file), claims(file, name, rows * size));
  }
  const auto text = with_version([] {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, much);
    return std::pair(type, H5Screate(H5S_SCALAR));
  });
  EXPECT_EQ(why_unread(text), claims(text, "palpate_version", much));

  Recording few;
  few.ticks.resize(10);
  EXPECT_EQ(read_recording(with_rows(few, "frames", 10)).ticks.size(), 10U);
  const std::string said = why_unread(with_rows(few, "frames", much / sizeof(TickRecord)));
  EXPECT_NE(said.find("frames claims to hold"), std::string::npos) << said;
}

/// Nothing that can be written is packed so well that it would be taken for a claim.
TEST(RecordingReading, WhatIsPackedAsWellAsCanBeIsRead) {
  Recording recording;
  recording.scenes = {{.scene = std::string(std::size_t{1} << 25U, 'a'), .scan_hash = "h"}};
  const auto file = fresh_path("packed_scene.h5");
  write_recording(recording, file);
  EXPECT_LT(fs::file_size(file), 1U << 20U);
  EXPECT_TRUE(read_recording(file).header.scene == recording.scenes[0].scene);
}

/// Lines of older versions lack what came later; of other kinds there may be lines, too; and the last may be cut.
TEST(RecordingReading, OlderEventsAreReadWithWhatWasTrueThen) {
  Recording recording;
  read_events(
      "{\"kind\":\"scene\",\"epoch\":3,\"scan_hash\":\"h\",\"half_extent_m\":[1,2,4],\"maximum_force_n\":5,\"scene\":"
      "\"s\"}\n"
      "{\"kind\":\"something new\",\"epoch\":3}\n"
      "{\"kind\":\"gap\",\"first_frame\":17,\"frames\":4}\n"
      "{\"kind\":\"gap\",\"first_fra",
      recording);
  ASSERT_EQ(recording.scenes.size(), 1U);
  EXPECT_EQ(recording.scenes[0].epoch, 3U);
  EXPECT_EQ(recording.scenes[0].half_extent_m, glm::dvec3(1, 2, 4));
  EXPECT_EQ(recording.scenes[0].maximum_force_n, 5);
  EXPECT_EQ(recording.scenes[0].change_s, 0.5);
  EXPECT_TRUE(recording.scenes[0].structures.empty());
  EXPECT_TRUE(recording.scenes[0].registered.empty());
  EXPECT_FALSE(recording.scenes[0].frame);
  EXPECT_TRUE(recording.styluses.empty());
  ASSERT_EQ(recording.gaps.size(), 1U);
  EXPECT_EQ(recording.gaps[0].first_tick, 17U);
  EXPECT_EQ(recording.gaps[0].ticks, 4U);
  for (const std::string& line : {to_line(SceneRecord{}), to_line(StylusRecord{}), to_line(Gap{})}) {
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
    EXPECT_EQ(line.back(), '\n');
  }
  EXPECT_ANY_THROW(read_events("no JSON\n", recording));
  EXPECT_ANY_THROW(read_events("{\"kind\":\"stylus\"}\n", recording));
}

}  // namespace
}  // namespace palpate::plugin
