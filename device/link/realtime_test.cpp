#include "device/link/realtime.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <ctime>
#include <random>
#include <stdexcept>
#include <string>

namespace palpate::device {
namespace {

void sleep_for(double seconds) {
  const timespec pause{static_cast<time_t>(seconds), static_cast<long>((seconds - static_cast<time_t>(seconds)) * 1e9)};
  nanosleep(&pause, nullptr);
}

TEST(Metronome, KeepsItsRateAndAccountsForEveryDeadline) {
  Metronome metronome(1e-3);
  const double start = monotonic_time();
  for (int i = 0; i < 300; ++i) EXPECT_GE(metronome.wait(), 0);
  const double deadlines = static_cast<double>(metronome.ticks() + metronome.missed());
  EXPECT_EQ(metronome.ticks(), 300U);
  // Lateness never adds up: however late single ticks were, the count of deadlines is the time that went by.
  EXPECT_NEAR((monotonic_time() - start) * 1e3, deadlines, 0.02 * deadlines + 50);
}

TEST(Metronome, CountsWhatItMissedAndNeverMakesUpForIt) {
  Metronome metronome(1e-3);
  metronome.wait();
  const std::uint64_t before = metronome.missed();
  sleep_for(0.050);
  metronome.wait();
  EXPECT_GE(metronome.missed() - before, 48U);
  const double start = monotonic_time();
  for (int i = 0; i < 5; ++i) metronome.wait();
  EXPECT_GT(monotonic_time() - start, 3e-3) << "no burst of ticks after a pause";
}

TEST(Metronome, RefusesPeriodsThatNoServoHas) {
  EXPECT_THROW(Metronome(0), std::logic_error);
  EXPECT_THROW(Metronome(-1), std::logic_error);
  EXPECT_THROW(Metronome(5), std::logic_error);
}

TEST(Realtime, SaysWhatIsRefusedAndGoesOn) {
  // In a process of its own, which gives its rights away where it has any.
  const pid_t child = fork();
  if (child == 0) {
    const bool unprivileged = setgid(65534) == 0 && setuid(65534) == 0;
    const RealtimeStatus status = become_realtime();
    const bool says_so = status.scheduled && status.memory_locked ? status.advice.empty()
                                                                  : status.advice.find("limits.d") != std::string::npos;
    const bool plausible = !unprivileged || !status.scheduled;
    _exit(says_so && plausible ? 0 : 1);
  }
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

/// Where the system allows it, the thread gets the priority that is meant, and nothing is said to be refused.
TEST(Realtime, TakesThePriorityThatItIsAllowed) {
  const pid_t child = fork();
  if (child == 0) {
    sched_param parameters{};
    parameters.sched_priority = 50;
    const bool allowed = sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
    parameters.sched_priority = 0;
    sched_setscheduler(0, SCHED_OTHER, &parameters);
    const RealtimeStatus status = become_realtime();
    sched_getparam(0, &parameters);
    const bool taken = sched_getscheduler(0) == SCHED_FIFO && parameters.sched_priority == 50;
    const bool all = status.scheduled && status.memory_locked;
    _exit(status.scheduled == allowed && taken == allowed && status.advice.empty() == all ? 0 : 1);
  }
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

/// One is named alone, both with an "and" between them.
TEST(Realtime, NamesWhatWasRefused) {
  const struct {
    bool scheduled, memory_locked;
    const char* refused;
  } cases[] = {{false, true, "real-time scheduling"},
               {true, false, "locked memory"},
               {false, false, "real-time scheduling and locked memory"}};
  for (const auto& one : cases) {
    const std::string advice = realtime_advice(one.scheduled, one.memory_locked);
    EXPECT_EQ(advice.substr(0, advice.find(';')), std::string("not allowed here: ") + one.refused);
  }
}

/// By the two clocks, of which one stands still in a sleep.
TEST(Realtime, TheTimeAsleepIsWhatOneClockLacks) {
  timespec boot{}, awake{};
  clock_gettime(CLOCK_BOOTTIME, &boot);
  clock_gettime(CLOCK_MONOTONIC, &awake);
  const double asleep_s = static_cast<double>(boot.tv_sec - awake.tv_sec);
  EXPECT_NEAR(time_asleep(), asleep_s, 1.1);
}

/// The clocks of a machine that sleeps and wakes: one counts what it was awake, the other the sleeps, too. Each sleep
/// makes the time asleep longer by what it lasted, and nothing else does.
TEST(Realtime, TheTimeAsleepGrowsByEachSleep) {
  static std::int64_t awake_ns, slept_ns;
  awake_ns = slept_ns = 0;
  const auto clock_ns = [](clockid_t clock) { return clock == CLOCK_BOOTTIME ? awake_ns + slept_ns : awake_ns; };
  std::mt19937_64 random(1);
  double before = time_asleep_by(clock_ns);
  EXPECT_EQ(before, 0);
  for (int n = 0; n < 200; ++n) {
    awake_ns += static_cast<std::int64_t>(random() % 3'600'000'000'000);
    EXPECT_EQ(time_asleep_by(clock_ns), before);
    const auto sleep_ns = static_cast<std::int64_t>(random() % 36'000'000'000'000);
    slept_ns += sleep_ns;
    EXPECT_NEAR(time_asleep_by(clock_ns) - before, static_cast<double>(sleep_ns) * 1e-9, 1e-6);
    before = time_asleep_by(clock_ns);
  }
}

}  // namespace
}  // namespace palpate::device
