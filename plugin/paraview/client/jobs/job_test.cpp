#include "plugin/paraview/client/jobs/job.h"

#include <gmock/gmock.h>

#include <QCoreApplication>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "plugin/paraview/client/model/testing/application.h"

namespace palpate::plugin {
namespace {

using testing::application;
using testing::comes;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Works until it is let go, whether it is still wanted or not.
struct JobAsked : ::testing::TestWithParam<Job::Newer> {
  JobAsked() { application(); }
  ~JobAsked() override { goes_on = true; }
  void ask(int number) {
    job.ask(
        [this, number](const Job::Control& control) {
          ++begun;
          while (!goes_on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          control.tell([this, number] { told.push_back(number); });
          ++ended;
          return number;
        },
        [this](const auto& result, const QString&) {
          done.push_back(*result);
          busy_when_done.push_back(job.is_busy());
        });
  }
  void let_all_end(int all) {
    goes_on = true;
    ASSERT_TRUE(comes([&] { return ended == all && !job.is_busy(); }));
  }

  std::atomic<bool> goes_on{false};
  std::atomic<int> begun{0}, ended{0};
  std::vector<int> told, done;
  std::vector<bool> busy_when_done;
  Job job{GetParam()};
};

INSTANTIATE_TEST_SUITE_P(All, JobAsked, ::testing::Values(Job::Newer::cancels, Job::Newer::follows));

/// Another scan is opened while a structure of the one before is made: those of the new one are made, too.
TEST_P(JobAsked, WhatIsCancelledIsNotWaitedForAndDoesNotSpeak) {
  ask(1);
  ASSERT_TRUE(comes([&] { return begun == 1; }));
  job.cancel();
  EXPECT_FALSE(job.is_busy()) << "the first still runs, and nobody waits for it";
  ask(2);
  EXPECT_TRUE(job.is_busy());
  let_all_end(2);
  EXPECT_THAT(done, ElementsAre(2));
  EXPECT_THAT(told, ElementsAre(2));
}

TEST_P(JobAsked, ItsEndWaitsForWhatRunsAndNothingComesAfterIt) {
  ask(1);
  ASSERT_TRUE(comes([&] { return begun == 1; }));
  std::thread later([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    goes_on = true;
  });
  job.finish();
  EXPECT_EQ(ended, 1);
  later.join();
  QCoreApplication::processEvents();
  EXPECT_THAT(done, IsEmpty());
  EXPECT_THAT(told, IsEmpty());
}

TEST_P(JobAsked, AnErrorIsGivenInPlaceOfAResult) {
  QString said;
  job.ask([]() -> int { throw std::runtime_error("no such folder"); },
          [&](const auto& result, const QString& error) { said = result ? QString() : error; });
  ASSERT_TRUE(comes([&] { return !job.is_busy(); }));
  EXPECT_EQ(said.toStdString(), "no such folder");
}

/// What the work holds is let go before the answer: a volume that one thread writes and the other frees.
TEST_P(JobAsked, WhatTheWorkHoldsIsFreeWhenItsAnswerComes) {
  auto held = std::make_shared<int>(1);
  long holders = 0;
  job.ask([held] { return *held; }, [&](const auto&, const QString&) { holders = held.use_count(); });
  ASSERT_TRUE(comes([&] { return !job.is_busy(); }));
  EXPECT_EQ(holders, 1);
}

TEST_P(JobAsked, ProgressIsToldOncePerPercentAndStopsWhatIsNotWanted) {
  std::vector<double> parts;
  job.ask(
      [&](const Job::Control& control) {
        const io::Progress progress = control.progress([&](double part) { parts.push_back(part); });
        bool wanted = true;
        for (const double part : {0.0, 0.001, 0.5, 0.502, 1.0}) wanted = wanted && progress(part);
        return wanted;
      },
      [](const auto& wanted, const QString&) { EXPECT_TRUE(*wanted); });
  ASSERT_TRUE(comes([&] { return !job.is_busy(); }));
  EXPECT_THAT(parts, ElementsAre(0, 0.5, 1));

  std::atomic<bool> begun_late{false}, wanted_late{true};
  job.ask(
      [&](const Job::Control& control) {
        const io::Progress progress = control.progress([](double) {});
        begun_late = true;
        while (!goes_on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        wanted_late = progress(0.5);
        return 0;
      },
      [](const auto&, const QString&) {});
  ASSERT_TRUE(comes([&] { return begun_late.load(); }));
  job.cancel();
  goes_on = true;
  job.finish();
  EXPECT_FALSE(wanted_late);
}

struct JobFollows : JobAsked {};
INSTANTIATE_TEST_SUITE_P(Follows, JobFollows, ::testing::Values(Job::Newer::follows));

/// A drag: each picture that was begun is shown, and then that of the newest place.
TEST_P(JobFollows, TheNewestOfThoseThatWaitComesAfterTheOneThatRuns) {
  ask(1);
  ASSERT_TRUE(comes([&] { return begun == 1; }));
  ask(2);
  ask(3);
  EXPECT_EQ(begun, 1);
  let_all_end(2);
  EXPECT_THAT(done, ElementsAre(1, 3));
  EXPECT_THAT(busy_when_done, ElementsAre(true, false));
}

struct JobCancels : JobAsked {};
INSTANTIATE_TEST_SUITE_P(Cancels, JobCancels, ::testing::Values(Job::Newer::cancels));

/// An archive that does not answer keeps nobody from asking another.
TEST_P(JobCancels, TheNewerBeginsWhileTheOlderStillRuns) {
  ask(1);
  ASSERT_TRUE(comes([&] { return begun == 1; }));
  ask(2);
  ASSERT_TRUE(comes([&] { return begun == 2; }));
  EXPECT_EQ(ended, 0);
  let_all_end(2);
  EXPECT_THAT(done, ElementsAre(2));
  EXPECT_THAT(busy_when_done, ElementsAre(false));
}

}  // namespace
}  // namespace palpate::plugin
