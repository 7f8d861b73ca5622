#include "device/link/realtime.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include "device/messages.h"

namespace palpate::device {

namespace {

constexpr std::int64_t second = 1'000'000'000;

std::int64_t clock_ns(clockid_t clock) noexcept {
  timespec time{};
  clock_gettime(clock, &time);
  return time.tv_sec * second + time.tv_nsec;
}

std::int64_t now_ns() noexcept {
  return clock_ns(CLOCK_MONOTONIC);
}

}  // namespace

bool make_thread_realtime(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

RealtimeStatus become_realtime(int priority) {
  RealtimeStatus status;
  status.scheduled = make_thread_realtime(priority);
  // As pages are touched: a whole scan need not be fetched for it.
  status.memory_locked = mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
  if (!status.scheduled || !status.memory_locked) {
    status.advice = realtime_advice(status.scheduled, status.memory_locked);
  }
  return status;
}

Text realtime_advice(bool scheduled, bool memory_locked) {
  return say("no-real-time", std::string(scheduled ? "" : "real-time scheduling") +
                                 (scheduled || memory_locked ? "" : " and ") + (memory_locked ? "" : "locked memory"));
}

Metronome::Metronome(double period) : period_(0), deadline_(0) {
  if (!(period >= 10e-6 && period <= 1)) throw std::logic_error("a tick has to last between 10 us and 1 s");
  period_ = std::llround(period * 1e9);
  deadline_ = now_ns();
}

double Metronome::wait() noexcept {
  deadline_ += period_;
  const std::int64_t late = now_ns() - deadline_;
  if (late >= period_) {
    const std::int64_t passed = late / period_;
    missed_ += static_cast<std::uint64_t>(passed);
    deadline_ += passed * period_;
  }
  const timespec until{deadline_ / second, deadline_ % second};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  ++ticks_;
  return static_cast<double>(now_ns() - deadline_) * 1e-9;
}

double monotonic_time() noexcept {
  return static_cast<double>(now_ns()) * 1e-9;
}

double time_asleep() noexcept {
  return time_asleep_by(clock_ns);
}

double time_asleep_by(std::int64_t (*read_ns)(clockid_t)) noexcept {
  return static_cast<double>(read_ns(CLOCK_BOOTTIME) - read_ns(CLOCK_MONOTONIC)) * 1e-9;
}

}  // namespace palpate::device
