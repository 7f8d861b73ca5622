#pragma once

/// Clocks for servos in tests: with them no test depends on how busy its machine is.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "plugin/session/servo_clock.h"

namespace palpate::plugin::testing {

/// A time that only a test advances. One thread advances it, and one servo uses it.
class DrivenTime {
 public:
  /// Lets the servo tick n times, and returns when the last of them has ended.
  void advance(std::uint64_t n) {
    std::unique_lock lock(mutex_);
    allowed_ += n;
    changed_.notify_all();
    changed_.wait(lock, [this] { return ended_ == allowed_; });
  }
  /// The next tick comes n deadlines too late.
  void skip(std::uint64_t n) {
    const std::scoped_lock lock(mutex_);
    skipped_ += n;
  }

  /// The servo's side of it.
  std::unique_ptr<ServoClock> clock() { return std::make_unique<Clock>(*this); }

 private:
  struct Clock : ServoClock {
    explicit Clock(DrivenTime& its_time) : time(its_time) {}
    Deadline wait(std::uint64_t) noexcept override { return time.wait(); }
    DrivenTime& time;
  };

  ServoClock::Deadline wait() {
    std::unique_lock lock(mutex_);
    ended_ = begun_;
    changed_.notify_all();
    // Now and then without a deadline, so that the servo sees when it is to stop.
    if (!changed_.wait_for(lock, std::chrono::milliseconds(1), [this] { return begun_ < allowed_; }))
      return {.due = false};
    ++begun_;
    return {.skipped = std::exchange(skipped_, 0)};
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t allowed_ = 0, begun_ = 0, ended_ = 0, skipped_ = 0;
};

/// About as fast as the computer's clock, but a tick is never late, even on a busy machine.
class UnhurriedClock : public ServoClock {
 public:
  /// Whether time goes on while the controlling thread is too busy for a heartbeat.
  enum class WithoutHeartbeat { goes_on, stands_still };

  explicit UnhurriedClock(double period_s, WithoutHeartbeat then = WithoutHeartbeat::stands_still)
      : period_(period_s), then_(then) {}

  Deadline wait(std::uint64_t heartbeats) noexcept override {
    std::this_thread::sleep_for(period_);
    if (heartbeats != heartbeats_) {
      heartbeats_ = heartbeats;
      without_ = 0;
    }
    constexpr int most_without = 300;  // of the 2000 that a servo allows at 1 kHz
    return {.due = ++without_ < most_without || then_ == WithoutHeartbeat::goes_on};
  }

 private:
  std::chrono::duration<double> period_;
  WithoutHeartbeat then_;
  std::uint64_t heartbeats_ = 0;
  int without_ = 0;
};

}  // namespace palpate::plugin::testing
