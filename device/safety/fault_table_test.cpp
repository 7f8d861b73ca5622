// Every fault on every device, through the one safety filter and the link: what becomes of the force on the device, and
// how fast. The rows of signals are in the tests device.usb.*, which need a process to end.

#include "device/testing/fault_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "device/testing/fake_rigs.h"

namespace palpate::device {
namespace {

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
    events.insert(row.event);
  }
  const bool has_motors = GetParam() != std::string("space_mouse");
  const bool is_arithmetic = GetParam() == std::string("simulated");
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
