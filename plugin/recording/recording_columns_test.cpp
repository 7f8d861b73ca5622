/// The scenes in a recording: as columns of a table, as felt frames, as registrations.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <istream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugin/recording/recording.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

using testing::fresh_path;

/// The next row of a table as RFC 4180 has it: what stands in quotes may hold commas, lines, and quotes that are
/// doubled.
bool next_row(std::istream& table, std::vector<std::string>& cells) {
  cells.assign(1, "");
  bool quoted = false;
  for (int c = table.get(); c != EOF; c = table.get()) {
    if (c == '"' && quoted && table.peek() == '"') {
      cells.back() += static_cast<char>(table.get());
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c == '\n' && !quoted) {
      return true;
    } else {
      cells.back() += static_cast<char>(c);
    }
  }
  return false;
}

/// A table has a column for each structure of any scene, in the order in which they come, and a tick's distance where
/// its scene has it; numbers read back to the last bit.
TEST(RecordingColumns, ATableHasAColumnForEachStructureOfAnyScene) {
  std::mt19937_64 random(5);
  Recording recording;
  const std::vector<std::vector<std::string>> structures{
      {"liver", "a \"b\""},
      {},
      {"kidney, left", "liver"},
      {"1", ",", "\"", "two\nlines", ";", "\",\"", "7", "kidney, left"}};
  const std::vector<std::string> columns{"liver",      "a \"b\"", "kidney, left", "1", ",", "\"",
                                         "two\nlines", ";",       "\",\"",        "7"};
  for (std::uint32_t n = 0; n < 4; ++n) {
    recording.scenes.push_back({.epoch = 2 * n, .structures = structures[n]});
    if (n % 2 == 0) recording.scenes.back().frame = ScanFrame{static_cast<int>(n) + 3, 9};
  }
  for (std::uint32_t n = 0; n < 10; ++n) {  // 8 and 9: of no scene that is known
    TickRecord tick;
    tick.scene_epoch = n;
    for (double& mm : tick.distance_mm) mm = static_cast<double>(random()) / 7e15;
    const bool is_known = n < 8 && n % 2 == 0;  // a session tells nothing after the scene's last
    for (std::size_t at = is_known ? structures[n / 2].size() : 8; at < 8; ++at) tick.distance_mm[at] = std::nan("");
    recording.ticks.push_back(tick);
  }
  const auto file = fresh_path("structures.csv");
  write_csv(recording, file);
  std::ifstream stream(file);
  std::vector<std::string> names, cells;
  ASSERT_TRUE(next_row(stream, names));
  const auto first = static_cast<std::size_t>(std::ranges::find(names, "distance_mm liver") - names.begin());
  ASSERT_EQ(names.size(), first + columns.size());
  EXPECT_EQ(names[first - 1], "scan_frame");
  EXPECT_EQ(names[first - 2], "known_to_mm");
  for (std::size_t n = 0; n < columns.size(); ++n) EXPECT_EQ(names[first + n], "distance_mm " + columns[n]);
  for (const TickRecord& tick : recording.ticks) {
    ASSERT_TRUE(next_row(stream, cells));
    ASSERT_EQ(cells.size(), names.size());
    const bool is_known = tick.scene_epoch < 8 && tick.scene_epoch % 2 == 0;
    const std::size_t scene = tick.scene_epoch / 2;
    EXPECT_EQ(cells[first - 1], is_known && scene % 2 == 0 ? std::to_string(scene + 3) : "");
    EXPECT_EQ(cells[first - 2], "nan") << "not recorded";
    for (std::size_t n = 0; n < columns.size(); ++n) {
      std::size_t at = 8;
      if (is_known) {
        const auto found = std::ranges::find(structures[scene], columns[n]);
        if (found != structures[scene].end()) at = static_cast<std::size_t>(found - structures[scene].begin());
      }
      if (at == 8) {
        EXPECT_EQ(cells[first + n], "nan");
      } else {
        EXPECT_EQ(std::stod(cells[first + n]), tick.distance_mm[at]) << tick.scene_epoch << columns[n];
      }
    }
  }
  EXPECT_FALSE(next_row(stream, cells));
  const auto nowhere = fresh_path("no_such_folder") / "r.csv";
  try {
    write_csv(recording, nowhere);
    FAIL() << "written";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("cannot write " + nowhere.string() + ": "), 0U) << error.what();
  }
}

/// A table for which there is no room is refused, whether it is small or larger than any buffer.
TEST(RecordingColumns, ATableOnAFullDiskIsRefused) {
  for (const std::size_t ticks : {1U, 20000U}) {
    Recording recording;
    recording.ticks.resize(ticks);
    try {
      write_csv(recording, "/dev/full");
      FAIL() << "written";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(),
                   "cannot write /dev/full: cannot write to file: No space left on device (is the disk full?)");
    }
  }
}

/// What was felt of a series, and by which registrations: each once, in the order in which it came.
TEST(RecordingColumns, FramesAndRegistrationsAreToldOnce) {
  Recording recording;
  EXPECT_TRUE(scan_frames_of(recording).empty());
  EXPECT_TRUE(registered_of(recording).empty());
  const auto registered = [](const std::string& name, double x) {
    RegisteredStructure one{.structure = name, .file_hash = "h", .motion = {}};
    one.motion.shift.x = x;
    return one;
  };
  recording.scenes = {{.registered = {registered("a", 1), registered("b", 1)}, .frame = ScanFrame{5, 8}},
                      {.registered = {registered("b", 1), registered("a", 2)}},
                      {.registered = {registered("a", 1)}, .frame = ScanFrame{0, 8}},
                      {.frame = ScanFrame{5, 8}},
                      {.frame = ScanFrame{5, 9}}};
  EXPECT_EQ(scan_frames_of(recording), (std::vector<ScanFrame>{{5, 8}, {0, 8}, {5, 9}}));
  EXPECT_EQ(registered_of(recording),
            (std::vector<RegisteredStructure>{registered("a", 1), registered("b", 1), registered("a", 2)}));
}

}  // namespace
}  // namespace palpate::plugin
