// Work on several threads: each index once, failures passed on, progress told in order.
#include "io/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "io/errors.h"

namespace palpate::io::internal {
namespace {

TEST(ParallelFor, DoesEachIndexOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    for (const std::size_t count : {0U, 1U, 2U, 3U, 100U}) {
      std::vector<std::atomic<int>> times(count);
      parallel_for(
          count, [&](std::size_t n) { ++times[n]; }, {}, threads);
      for (const auto& one : times) EXPECT_EQ(one, 1) << threads << ' ' << count;
    }
  }
}

TEST(ParallelFor, OfOneThreadIsTheCallersInOrder) {
  std::vector<std::size_t> order;
  parallel_for(
      5,
      [&, caller = std::this_thread::get_id()](std::size_t n) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        order.push_back(n);
      },
      {}, 1);
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

// The first failure is told, no more work is begun, and all threads have stopped by then.
TEST(ParallelFor, PassesAFailureOn) {
  for (const int threads : {1, 4}) {
    std::atomic<int> running = 0, begun = 0;
    try {
      parallel_for(
          100000,
          [&](std::size_t n) {
            ++begun;
            ++running;
            const std::unique_ptr<std::atomic<int>, void (*)(std::atomic<int>*)> ends(
                &running, [](std::atomic<int>* r) { --*r; });
            if (n == 3) throw std::runtime_error("third");
            if (n > 3 && threads == 1) throw std::runtime_error("a later one");
          },
          {}, threads);
      ADD_FAILURE() << "not thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::string("third"));
    }
    EXPECT_EQ(running, 0);
    if (threads == 1) {
      EXPECT_EQ(begun, 4);
    }
  }
}

TEST(ParallelFor, TellsItsProgressFromZeroToOne) {
  for (const int threads : {1, 3}) {
    for (const std::size_t count : {0U, 1U, 4U, 50U}) {
      std::vector<double> told;
      const auto caller = std::this_thread::get_id();
      const Progress progress = [&](double done) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        told.push_back(done);
        return true;
      };
      parallel_for(
          count, [](std::size_t) {}, progress, threads);
      ASSERT_GE(told.size(), 2U);
      EXPECT_EQ(told.front(), 0);
      EXPECT_EQ(told.back(), 1);
      EXPECT_EQ(std::ranges::count(told, 1.0), 1);
      EXPECT_TRUE(std::ranges::is_sorted(told));
      if (threads == 1 && count == 4) {
        EXPECT_EQ(told, (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
      }
    }
  }
}

// At its start, in its midst and at its end.
TEST(ParallelFor, EndsWhereItsProgressSaysSo) {
  for (const auto& [stops_at, done_then] : {std::pair{0.0, 0}, {0.25, 1}, {0.75, 3}, {1.0, 4}}) {
    int done = 0;
    EXPECT_THROW(parallel_for(
                     4, [&](std::size_t) { ++done; }, [stop = stops_at](double part) { return part < stop; }, 1),
                 Cancelled);
    EXPECT_EQ(done, done_then) << stops_at;
  }
}

}  // namespace
}  // namespace palpate::io::internal
