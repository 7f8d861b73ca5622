#include "device/link/realtime.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <ctime>
#include <stdexcept>

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

}  // namespace
}  // namespace palpate::device
