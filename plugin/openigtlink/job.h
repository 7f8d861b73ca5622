#pragma once

/// Work in other threads. The controlling thread starts it and takes its result, and never waits for it: a session
/// without a heartbeat stops.

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include "io/progress.h"

namespace palpate::plugin::igtl {

/// The threads of jobs, also of cancelled ones until they have ended. Its destructor waits for them.
class JobThreads {
 public:
  template <typename Work>
  void run(Work work) {
    std::erase_if(running_,
                  [](const auto& one) { return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
    running_.push_back(std::async(std::launch::async, std::move(work)));
  }

 private:
  std::vector<std::future<void>> running_;
};

/// One piece of work at a time. Its destructor cancels it without waiting for its end.
template <typename Result>
class Job {
 public:
  /// `progress` returns false as soon as nobody wants the result.
  using Work = std::function<Result(const io::Progress& progress)>;

  /// The threads must outlive it.
  explicit Job(JobThreads& threads) : threads_(threads) {}
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;
  ~Job() {
    if (wanted_) *wanted_ = false;
  }

  /// The result of earlier work must have been taken.
  void start(Work work) {
    wanted_ = std::make_shared<std::atomic<bool>>(true);
    std::packaged_task<Result()> task([work = std::move(work), wanted = wanted_] {
      return work([wanted](double /*done*/) { return wanted->load(); });
    });
    result_ = task.get_future();
    threads_.run([task = std::move(task)]() mutable {
      task();
      task = {};  // what nobody takes is freed here
    });
  }
  /// Whether a result is still to come or to be taken.
  bool is_busy() const { return result_.valid(); }
  bool is_ready() const { return is_busy() && result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
  /// Throws what the work threw.
  Result take() { return result_.get(); }

 private:
  JobThreads& threads_;
  std::shared_ptr<std::atomic<bool>> wanted_;
  std::future<Result> result_;
};

}  // namespace palpate::plugin::igtl
