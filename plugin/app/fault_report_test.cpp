#include "plugin/app/fault_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "plugin/app/live_session.h"
#include "plugin/testing/session_rig.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

/// The user's state in a folder of the test's own.
class FaultReports : public ::testing::Test {
 protected:
  FaultReports() { setenv("XDG_STATE_HOME", folder_.c_str(), 1); }
  ~FaultReports() override { unsetenv("XDG_STATE_HOME"); }
  std::filesystem::path folder_ = std::filesystem::absolute(testing::fresh_path("state"));
};

TEST_F(FaultReports, TheSecondBeforeAFaultIsKeptAndFoundAgain) {
  EXPECT_FALSE(last_fault());
  const auto held = testing::stylus(testing::hold());
  Session session(testing::snapshot("ct-skin-and-bone", testing::slab()), held);
  for (int n = 0; n < 3000; ++n) session.tick();
  session.collect();
  EXPECT_TRUE(session.fault_ticks().empty());
  held->inject(device::SimulatedFault::unplugged);
  const double at_fault_s = 3.0;
  for (int n = 0; n < 200; ++n) session.tick();
  session.collect();
  ASSERT_EQ(session.faults(), 1);
  session.collect();
  EXPECT_EQ(session.faults(), 1) << "counted once";
  const auto& ticks = session.fault_ticks();
  ASSERT_EQ(ticks.size(), device::FaultLog::capacity);
  const auto& first = ticks[ticks.size() - device::FaultLog::ticks_after_fault - 1];
  EXPECT_EQ(first.result.fault, device::Fault::device_lost);
  EXPECT_NEAR(first.input.time, at_fault_s, 1e-9);
  EXPECT_GT((&first - 1)->result.force.y, 0.1) << "it pushed";

  const auto kept = keep_fault(ticks, "a stylus");
  ASSERT_TRUE(kept);
  const auto found = last_fault();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->stylus, "a stylus");
  EXPECT_EQ(found->fault, "device lost");
  EXPECT_EQ(found->time, kept->time);
  EXPECT_NEAR(found->strongest_n, kept->strongest_n, 1e-3);
  EXPECT_EQ(found->file, folder_ / "palpate" / "last-fault.csv");
  std::ifstream stream(found->file);
  std::string line;
  int rows = 0;
  while (std::getline(stream, line)) rows += line.ends_with(",device lost") ? 1 : 0;
  EXPECT_EQ(rows, 101);
  // "The last fault, {}, {}: {}. Until then the stylus moved at up to {} m/s and got up to {} N; the second before it:
  // {}"
  const std::string said = describe(*found);
  EXPECT_THAT(said, ::testing::HasSubstr(", a stylus: device lost. Until then the stylus moved at up to "));
  EXPECT_THAT(said, ::testing::HasSubstr(" N; the second before it: " + found->file.string()));
}

TEST_F(FaultReports, ASessionThatIsHeldKeepsItsFaultByItself) {
  LiveSession live;
  live.set_scan(std::make_shared<const io::Volume>(
                    testdata::scan(testdata::make_sphere(25), testdata::make_geometry({.size = glm::ivec3(40)}))),
                modes::load_scene("ct-skin-and-bone"));
  const auto held = testing::stylus(testing::hold());
  live.connect(held);
  const auto comes = [&](const auto& holds) {
    for (int n = 0; n < 2000 && !holds(); ++n) {
      live.heartbeat();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return holds();
  };
  ASSERT_TRUE(comes([&] { return live.ticks()->written() > 100; }));
  EXPECT_FALSE(live.last_fault());
  held->inject(device::SimulatedFault::not_a_number);
  ASSERT_TRUE(comes([&] { return live.last_fault().has_value(); }));
  EXPECT_EQ(live.last_fault()->fault, "pose not finite");
  EXPECT_TRUE(last_fault());
}

TEST_F(FaultReports, WhatIsNoReportIsNone) {
  std::filesystem::create_directories(folder_ / "palpate");
  std::ofstream(folder_ / "palpate" / "last-fault.csv") << "# fastest: nonsense\n# fault: device lost\n";
  EXPECT_FALSE(last_fault());
  EXPECT_FALSE(keep_fault({}, "a stylus"));
}

}  // namespace
}  // namespace palpate::plugin
