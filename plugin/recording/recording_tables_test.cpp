/// A recording's file as seen with HDF5 alone: written in parts, flushed, abandoned, truncated and damaged.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "io/testing/file_bytes.h"
#include "io/testing/short_files.h"
#include "plugin/recording/recording.h"
#include "plugin/recording/recording_rows.h"
#include "plugin/recording/recording_writer.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using testing::fresh_path;

/// Any numbers in all that a tick and its shares hold.
Recording any_numbers(std::mt19937_64& random, std::size_t ticks) {
  Recording recording;
  recording.header = {
      .palpate_version = "9.8.7", .device = "über", .scan_hash = "0123456789abcdef", .seed = 0.1, .rate_hz = 1e3 / 7};
  for (std::size_t n = 0; n < ticks; ++n) {
    TickRecord tick;
    std::vector<unsigned char> bytes(sizeof tick);
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random());
    std::memcpy(static_cast<void*>(&tick), bytes.data(), sizeof tick);
    tick.share_count = static_cast<std::uint32_t>(random() % 4);
    for (std::uint32_t share = 0; share < tick.share_count; ++share) {
      recording.shares.push_back({.tick = random(),
                                  .mode = share,
                                  .type = 2,
                                  .strength_n = std::ldexp(1, static_cast<int>(random() % 90)),
                                  .force_n = {1, 2, 3}});
    }
    recording.ticks.push_back(tick);
    recording.known_to_mm.push_back(static_cast<double>(random() % 1000) / 7);
  }
  return recording;
}

template <typename T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// What is left of a session that did not end stays, also if its file is recorded anew.
TEST(RecordingTables, WhatIsLeftOfASessionStays) {
  const auto file = fresh_path("again.h5");
  std::mt19937_64 random(2);
  const Recording whole = any_numbers(random, 100);
  std::vector<fs::path> left;
  for (int n = 0; n < 3; ++n) {
    RecordingWriter ended_early(file, whole.header);
    ended_early.append(whole.ticks, whole.shares, {});
    ended_early.flush();
    EXPECT_EQ(std::ranges::count(left, ended_early.partial()), 0);
    left.push_back(ended_early.partial());
  }
  RecordingWriter writer(file, whole.header);
  writer.append(whole.ticks, whole.shares, {});
  writer.finish();
  EXPECT_TRUE(fs::exists(file));
  for (const fs::path& partial : left) EXPECT_EQ(read_recording(partial).ticks.size(), whole.ticks.size()) << partial;
  for (const fs::path& partial : left) fs::remove(partial);
  fs::remove(file);
}

/// In whatever parts it is appended, and wherever it is flushed, the file holds the same.
TEST(RecordingTables, GrowInAnyParts) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 6; ++n) {
    const Recording whole = any_numbers(random, 2600);
    const auto file = fresh_path("parts.h5");
    RecordingWriter writer(file, whole.header);
    EXPECT_EQ(writer.partial(), file.string() + ".partial");
    std::size_t share = 0;
    for (std::size_t begin = 0; begin < whole.ticks.size();) {
      const std::size_t count = std::min<std::size_t>(random() % 1500, whole.ticks.size() - begin);
      std::size_t shares = 0;
      for (std::size_t of = begin; of < begin + count; ++of) shares += whole.ticks[of].share_count;
      writer.append(std::span(whole.ticks).subspan(begin, count), std::span(whole.shares).subspan(share, shares),
                    std::span(whole.known_to_mm).subspan(begin, count));
      if (random() % 3 == 0) writer.flush();
      begin += count;
      share += shares;
    }
    EXPECT_FALSE(fs::exists(file));
    writer.finish();
    EXPECT_TRUE(fs::exists(file));
    EXPECT_FALSE(fs::exists(writer.partial()));
    const Recording read = read_recording(file);
    EXPECT_TRUE(read.complete);
    EXPECT_TRUE(same_bytes(read.ticks, whole.ticks));
    EXPECT_TRUE(same_bytes(read.shares, whole.shares));
    EXPECT_TRUE(same_bytes(read.known_to_mm, whole.known_to_mm));
    EXPECT_EQ(read.header.palpate_version, whole.header.palpate_version);
    EXPECT_EQ(read.header.device, whole.header.device);
    EXPECT_EQ(read.header.scan_hash, whole.header.scan_hash);
    EXPECT_EQ(read.header.seed, whole.header.seed) << "to the last bit";
    EXPECT_EQ(read.header.rate_hz, whole.header.rate_hz);
  }
}

/// What was appended before a flush is there when the writer dies after it: ticks, shares, what is known, and events.
TEST(RecordingTables, WhatWasFlushedSurvives) {
  std::mt19937_64 random(2);
  const Recording whole = any_numbers(random, 40);
  const auto file = fresh_path("flushed.h5"), left = fresh_path("left.h5");
  RecordingWriter writer(file, whole.header);
  writer.append(SceneRecord{.epoch = 4, .scene = "{}", .scan_hash = "x"});
  writer.append(StylusRecord{.epoch = 2, .name = "falcon"});
  writer.append(Gap{.first_tick = 7, .ticks = 3});
  writer.append(whole.ticks, whole.shares, whole.known_to_mm);
  writer.flush();
  fs::copy_file(writer.partial(), left);
  const Recording read = read_recording(left);
  EXPECT_FALSE(read.complete);
  EXPECT_TRUE(same_bytes(read.ticks, whole.ticks));
  EXPECT_TRUE(same_bytes(read.shares, whole.shares));
  EXPECT_TRUE(same_bytes(read.known_to_mm, whole.known_to_mm));
  ASSERT_EQ(read.scenes.size(), 1U);
  EXPECT_EQ(read.scenes[0].epoch, 4U);
  ASSERT_EQ(read.styluses.size(), 1U);
  EXPECT_EQ(read.styluses[0].name, "falcon");
  ASSERT_EQ(read.gaps.size(), 1U);
  EXPECT_EQ(read.gaps[0].ticks, 3U);
}

/// What is not finished stays as it was flushed last, to the byte: the writer that goes writes nothing more.
TEST(RecordingTables, WhatIsNotFinishedStaysAsItWasFlushed) {
  std::mt19937_64 random(6);
  const Recording whole = any_numbers(random, 40);
  for (const std::size_t count : {40U, 2500U}) {  // the second is more than HDF5 keeps for itself
    const Recording more = any_numbers(random, count);
    const auto file = fresh_path("unfinished" + std::to_string(count)), left = fresh_path("left.h5");
    std::string flushed;
    {
      RecordingWriter writer(file, whole.header);
      writer.append(whole.ticks, whole.shares, whole.known_to_mm);
      writer.flush();
      flushed = io::internal::bytes_of(writer.partial());
      writer.append(more.ticks, more.shares, more.known_to_mm);
      writer.append(Gap{.first_tick = 7, .ticks = 3});
    }
    EXPECT_FALSE(fs::exists(file));
    fs::copy_file(file.string() + ".partial", left);
    if (count == 40) {
      EXPECT_TRUE(io::internal::bytes_of(left) == flushed);
    }
    const Recording read = read_recording(left);
    EXPECT_FALSE(read.complete);
    ASSERT_GE(read.ticks.size(), whole.ticks.size());
    EXPECT_LT(read.ticks.size(), whole.ticks.size() + more.ticks.size());
    EXPECT_EQ(std::memcmp(read.ticks.data(), whole.ticks.data(), whole.ticks.size() * sizeof(TickRecord)), 0);
  }
}

/// What is finished is closed: a copy is whole while the writer is still there.
TEST(RecordingTables, WhatIsFinishedIsClosed) {
  std::mt19937_64 random(7);
  const Recording whole = any_numbers(random, 40);
  const auto file = fresh_path("finished.h5"), copy = fresh_path("copy.h5");
  RecordingWriter writer(file, whole.header);
  writer.append(whole.ticks, whole.shares, whole.known_to_mm);
  writer.finish();
  fs::copy_file(file, copy);  // HDF5 would look into the writer's own memory
  const Recording read = read_recording(copy);
  EXPECT_TRUE(read.complete);
  EXPECT_TRUE(same_bytes(read.ticks, whole.ticks));
}

std::string why_unwritten(const std::function<void()>& write) {
  try {
    write();
    return "written";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

/// A recording gets its name only when all of it is on the disk. Where there is no room for the rest it says so, and
/// what was flushed stays; what was to be written at once leaves nothing.
TEST(RecordingTables, OnAFullDiskARecordingGetsNoName) {
  std::mt19937_64 random(8);
  const Recording whole = any_numbers(random, 40), more = any_numbers(random, 500);
  const auto file = fresh_path("full.h5"), left = fresh_path("left.h5"), at_once = fresh_path("at_once.h5");
  const auto full = [](const fs::path& of) {
    return "cannot write the recording " + of.string() + ": HDF5 cannot write (is the disk full?)";
  };
  std::string said, said_at_once;
  {
    RecordingWriter writer(file, whole.header);
    writer.append(whole.ticks, whole.shares, whole.known_to_mm);
    writer.flush();
    writer.append(more.ticks, more.shares, more.known_to_mm);
    const io::testing::ShortFiles disk(fs::file_size(writer.partial()));
    said = why_unwritten([&] { writer.finish(); });
    said_at_once = why_unwritten([&] { write_recording(more, at_once); });
  }
  EXPECT_EQ(said, full(file));
  EXPECT_FALSE(fs::exists(file));
  fs::copy_file(file.string() + ".partial", left);
  const Recording read = read_recording(left);
  EXPECT_FALSE(read.complete);
  EXPECT_TRUE(same_bytes(read.ticks, whole.ticks));
  EXPECT_EQ(said_at_once, full(at_once));
  EXPECT_FALSE(fs::exists(at_once));
  EXPECT_FALSE(fs::exists(at_once.string() + ".partial"));
}

/// Of ticks whose shares are cut off, only those count that have them all.
TEST(RecordingTables, ATickWithoutAllItsSharesIsLeftOut) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 20; ++n) {
    Recording recording = any_numbers(random, 30);
    const Recording whole = recording;
    recording.shares.resize(random() % (recording.shares.size() + 1));
    recording.known_to_mm.resize(random() % 31);
    std::size_t ticks = 0, shares = 0;
    while (ticks < 30 && shares + whole.ticks[ticks].share_count <= recording.shares.size())
      shares += whole.ticks[ticks++].share_count;
    const auto file = fresh_path("cut.h5");
    write_recording(recording, file);
    const Recording read = read_recording(file);
    ASSERT_EQ(read.ticks.size(), ticks);
    ASSERT_EQ(read.shares.size(), shares);
    ASSERT_EQ(read.known_to_mm.size(), ticks);
    for (std::size_t of = 0; of < ticks; ++of) {
      if (of < recording.known_to_mm.size()) {
        EXPECT_EQ(read.known_to_mm[of], whole.known_to_mm[of]);
      } else {
        EXPECT_TRUE(std::isnan(read.known_to_mm[of])) << "not known";
      }
    }
  }
}

/// Every table is shuffled and packed, in chunks that fit into HDF5's cache of 1 MiB for each table.
TEST(RecordingTables, ArePackedInChunksThatHdf5Holds) {
  std::mt19937_64 random(4);
  const auto file = fresh_path("packed.h5");
  Recording still = any_numbers(random, 1);
  still.ticks.assign(20000, still.ticks.front());
  still.shares.clear();
  still.known_to_mm.clear();
  for (std::size_t n = 0; n < still.ticks.size(); ++n) {
    still.ticks[n].index = n;
    still.ticks[n].share_count = 0;
  }
  write_recording(still, file);
  EXPECT_LT(fs::file_size(file), 20000 * sizeof(TickRecord) / 20) << "columns that hardly change take little room";
  const hid_t input = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(input, 0);
  for (const char* const name : {"frames", "shares", "known_to_mm", "events"}) {
    const hid_t data = H5Dopen2(input, name, H5P_DEFAULT), type = H5Dget_type(data), made = H5Dget_create_plist(data);
    hsize_t rows = 0;
    EXPECT_EQ(H5Pget_chunk(made, 1, &rows), 1) << name;
    EXPECT_LE(rows * H5Tget_size(type), 1U << 20U) << name;
    EXPECT_GE(rows, 1000U) << name << ": a second";
    EXPECT_EQ(H5Pget_nfilters(made), 2) << name;
    std::vector<H5Z_filter_t> filters;
    for (unsigned n = 0; n < 2; ++n)
      filters.push_back(H5Pget_filter2(made, n, nullptr, nullptr, nullptr, 0, nullptr, nullptr));
    EXPECT_EQ(filters, (std::vector<H5Z_filter_t>{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE})) << name;
    H5Pclose(made);
    H5Tclose(type);
    H5Dclose(data);
  }
  for (const char* const name : {"palpate_version", "device", "scan_hash", "seed", "rate_hz"}) {
    const hid_t data = H5Dopen2(input, name, H5P_DEFAULT), type = H5Dget_type(data);
    EXPECT_EQ(H5Tget_class(type), H5T_STRING) << name;
    EXPECT_EQ(H5Tget_cset(type), H5T_CSET_UTF8) << name;
    H5Tclose(type);
    H5Dclose(data);
  }
  H5Fclose(input);
}

}  // namespace
}  // namespace palpate::plugin
