// Every fault on every device, through the one safety filter and the link: what becomes of the force on the device, and
// how fast. The rows of signals need a process to end: device/testing/guest_main.cpp plays them.

#include "device/testing/fault_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "device/testing/fake_rigs.h"

namespace palpate::device {
namespace {

/// What the page says of an event on a device; nothing where it has no such row or column.
std::optional<std::string> cell_of_page(const std::string& device, const std::string& event) {
  static const std::vector<std::vector<std::string>> lines = [] {
    std::vector<std::vector<std::string>> cells;
    std::ifstream page(std::string(PALPATE_SOURCES) + "/plugin/docs/safety.md");
    for (std::string line; std::getline(page, line);) {
      if (!line.starts_with("| ")) continue;
      std::istringstream parts(line.substr(2));
      cells.emplace_back();
      for (std::string cell; std::getline(parts, cell, '|');) {
        cell.erase(0, cell.find_first_not_of(' '));
        cell.erase(cell.find_last_not_of(' ') + 1);
        cells.back().push_back(cell);
      }
    }
    return cells;
  }();
  const auto header = std::ranges::find_if(lines, [](const auto& cells) { return cells.front() == "event"; });
  if (header == lines.end()) return {};
  const auto column = std::ranges::find(*header, device) - header->begin();
  const auto row = std::find_if(header, lines.end(), [&](const auto& cells) { return cells.front() == event; });
  if (row == lines.end() || column >= static_cast<std::ptrdiff_t>(row->size())) return {};
  return (*row)[static_cast<std::size_t>(column)];
}

class FaultTable : public ::testing::TestWithParam<const char*> {};

TEST_P(FaultTable, NoEventRaisesAForceStepsItOrLeavesIt) {
  const std::vector<FaultRow> rows = fault_table(GetParam());
  std::set<std::string> events;
  for (const FaultRow& row : rows) {
    EXPECT_EQ(missed_goal(row), "") << row.device << ": " << row.event;
    EXPECT_GT(row.before_n, 1) << row.device << ": " << row.event;
    if (row.event == "stopped, and no guardian") {
      EXPECT_EQ(row.left_n, 0) << row.device << ": the program goes on, and knows that it was stopped";
    }
    EXPECT_EQ(cell_of_page(row.device, row.event), brief(row))
        << row.device << ": " << row.event
        << ": plugin/docs/safety.md has another table than `palpate-faults --markdown`";
    events.insert(row.event);
  }
  const FakeRig rig = make_rig(GetParam());
  const bool has_motors = rig.type->has_force, is_arithmetic = rig.is_arithmetic();
  EXPECT_EQ(events.size(), rows.size());
  const std::size_t fewest = !has_motors ? 0 : is_arithmetic ? 11 : 18;
  EXPECT_GE(rows.size(), fewest);
}

INSTANTIATE_TEST_SUITE_P(EachDevice, FaultTable, ::testing::ValuesIn(rig_kinds()),
                         [](const auto& kind) { return std::string(kind.param); });

/// A table that finds nothing is one that looks at nothing: each goal is missed by a row that misses it alone.
TEST(FaultTableGoals, EachIsMissedByARowThatMissesIt) {
  const FaultRow good{.device = "device",
                      .event = "event",
                      .ended_by = EndedBy::program,
                      .seen_after_s = 0.1,
                      .before_n = 2,
                      .allowed_n = 2,
                      .largest_after_n = 2,
                      .zero_taken_s = 0.2,
                      .largest_step_n = 1,
                      .allowed_step_n = 1};
  EXPECT_EQ(missed_goal(good), "");
  FaultRow row = good;
  row.largest_after_n = 2.01;
  EXPECT_NE(missed_goal(row), "");
  row = good;
  row.largest_step_n = 1.01;
  EXPECT_NE(missed_goal(row), "");
  row = good;
  row.zero_taken_s = 0.201;
  EXPECT_NE(missed_goal(row), "");
  row.zero_taken_s.reset();
  EXPECT_NE(missed_goal(row), "");
  row.ended_by = EndedBy::device;
  EXPECT_EQ(missed_goal(row), "") << "nobody can reach it";
  row.ended_by = EndedBy::nobody;
  EXPECT_EQ(missed_goal(row), "");
  row.zero_taken_s = 0.1;
  EXPECT_NE(missed_goal(row), "") << "it should go on";
  row = good;
  row.torques = 1;
  EXPECT_NE(missed_goal(row), "");
  row = good;
  row.ended_by = EndedBy::guardian;
  row.zero_taken_s = 0.29;
  EXPECT_EQ(missed_goal(row), "");
  row.zero_taken_s = 0.31;
  EXPECT_NE(missed_goal(row), "");
}

}  // namespace
}  // namespace palpate::device
