// Work in other threads: its result, and its end when nobody wants it any more.

#include "plugin/openigtlink/job.h"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

namespace palpate::plugin::igtl {
namespace {

template <typename Result>
Result result_of(Job<Result>& job) {
  while (!job.is_ready()) std::this_thread::yield();
  return job.take();
}

TEST(OpenIgtJob, GivesWhatItsWorkGivesOrThrows) {
  JobThreads threads;
  Job<std::string> job(threads);
  EXPECT_FALSE(job.is_busy());
  EXPECT_FALSE(job.is_ready());
  job.start([](const io::Progress& progress) { return std::string(progress(0) ? "wanted" : "not wanted"); });
  EXPECT_TRUE(job.is_busy());
  EXPECT_EQ(result_of(job), "wanted");
  EXPECT_FALSE(job.is_busy());
  job.start([](const io::Progress&) -> std::string { throw std::runtime_error("it cannot be done"); });
  try {
    result_of(job);
    FAIL() << "it threw";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "it cannot be done");
  }
}

/// Whoever gives it up goes on at once; the threads wait until it has heard of that.
TEST(OpenIgtJob, ThatIsGivenUpIsNotWaitedForAndFreesWhatItHolds) {
  std::promise<void> let_go;
  auto until = let_go.get_future().share();
  auto held = std::make_shared<int>(1);
  const std::weak_ptr<int> kept = held;
  std::atomic<bool> was_wanted{true};
  {
    JobThreads threads;
    {
      Job<int> job(threads);
      job.start([&was_wanted, until, held](const io::Progress& progress) {
        until.wait();
        was_wanted = progress(0);
        return *held;
      });
    }
    held.reset();
    EXPECT_FALSE(kept.expired()) << "it has not ended yet";
    let_go.set_value();
    while (!kept.expired()) std::this_thread::yield();
  }
  EXPECT_FALSE(was_wanted);
}

TEST(OpenIgtJob, ItsThreadsWaitForItsEnd) {
  std::atomic<bool> ended{false};
  {
    JobThreads threads;
    Job<int> job(threads);
    job.start([&ended](const io::Progress& progress) {
      while (progress(0)) std::this_thread::yield();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      ended = true;
      return 0;
    });
  }
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace palpate::plugin::igtl
