#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace palpate::device {

/// How long this machine kept a thread from running while the meter was there: one thread on each of this process's
/// cores asks to be woken every few milliseconds.
class StallMeter {
 public:
  /// Returns when its threads run. From then on they allocate nothing, so that a test may fork: a sanitizer's allocator
  /// that another thread has locked stays locked in the child.
  StallMeter();
  StallMeter(const StallMeter&) = delete;
  StallMeter& operator=(const StallMeter&) = delete;
  ~StallMeter();
  /// The longest so far, s.
  double longest() const noexcept { return longest_; }

 private:
  void watch(int core) noexcept;

  std::atomic<bool> stop_{false};
  std::atomic<double> longest_{0};
  std::atomic<std::size_t> running_{0};
  std::vector<std::thread> threads_;
};

/// What a program of tests with real threads and real processes should end with: `result`, or, where that is a failure
/// and the machine itself stood still meanwhile, what the same program ends with when it is begun anew, at most four
/// times. Drivers, guardians and services rightly end a force on such a machine, so a failure there tells nothing.
int judged(int result, const StallMeter& meter, char** arguments);

}  // namespace palpate::device
