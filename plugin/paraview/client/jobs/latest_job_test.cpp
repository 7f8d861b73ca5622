#include "plugin/paraview/client/jobs/latest_job.h"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "plugin/paraview/client/model/testing/application.h"

namespace palpate::plugin {
namespace {

using testing::application;
using testing::comes;
using ::testing::ElementsAre;

/// Works until it is let go.
struct LatestJobAsked : ::testing::Test {
  LatestJobAsked() { application(); }
  ~LatestJobAsked() override { goes_on = true; }
  void ask(int number) {
    job.ask([this, number] {
      ++begun;
      while (!goes_on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return number;
    });
  }

  std::atomic<bool> goes_on{false};
  std::atomic<int> begun{0};
  std::vector<int> done;
  std::vector<bool> busy_when_done;
  LatestJob<int> job{[this](const auto& number, const QString&) {
    done.push_back(*number);
    busy_when_done.push_back(job.is_busy());
  }};
};

TEST_F(LatestJobAsked, ItIsBusyUntilWhatWasAskedForIsThere) {
  EXPECT_FALSE(job.is_busy());
  ask(1);
  EXPECT_TRUE(job.is_busy());
  ASSERT_TRUE(comes([&] { return begun == 1; }));
  ask(2);
  ask(3);
  goes_on = true;
  ASSERT_TRUE(comes([&] { return !job.is_busy(); }));
  EXPECT_THAT(done, ElementsAre(1, 3)) << "the last of those that wait";
  EXPECT_THAT(busy_when_done, ElementsAre(true, false));
}

/// Another scan is opened while a structure of the one before is made: those of the new one are made, too.
TEST_F(LatestJobAsked, WhatIsDroppedKeepsNothingFromBeingAskedFor) {
  ask(1);
  ASSERT_TRUE(comes([&] { return begun == 1; }));
  ask(2);
  job.drop();
  EXPECT_FALSE(job.is_busy()) << "the first still runs, and nobody waits for it";
  ask(3);
  EXPECT_TRUE(job.is_busy());
  goes_on = true;
  ASSERT_TRUE(comes([&] { return !done.empty(); }));
  EXPECT_THAT(done, ElementsAre(3));
  EXPECT_FALSE(job.is_busy());
}

}  // namespace
}  // namespace palpate::plugin
