#include "device/safety/zero_force.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <vector>

#include "device/link/realtime.h"
#include "device/safety/take_over.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

double waited_s = 0;
double waited_now() noexcept {
  return waited_s;
}
void wait_in_no_time(double seconds) noexcept {
  waited_s += seconds;
}
constexpr DriverClock own_clock{&waited_now, &wait_in_no_time};

/// Whenever a device comes back, it is tried within 0.1 s; however long it stays away, it is not tried without end.
TEST(ZeroForce, ADeviceThatComesBackIsTriedSoonAndALostOneIsNotAskedAllTheTime) {
  for (const double back_after : {0.0, 0.004, 0.1, 1.0, 61.0, 3600.0, 86400.0}) {
    waited_s = 0;
    int tries = 0;
    const auto try_once = [&] { return ++tries > 0 && waited_s >= back_after; };
    EXPECT_TRUE(keep_trying(
        try_once, [](double) { return false; }, own_clock));
    EXPECT_LE(waited_s - back_after, 0.1 + 1e-9) << back_after;
    EXPECT_LE(waited_s - back_after, 0.06 * back_after + 1e-3) << "at first at once";
    EXPECT_LE(tries, 110 + 10.2 * back_after) << back_after;
  }
  double before = 0;
  for (double seconds = 0; seconds < 100; seconds += 0.01) {
    EXPECT_GE(pause_after(seconds), before);
    before = pause_after(seconds);
  }
}

TEST(ZeroForce, ItIsGivenUpWhenTheUserLogsOut) {
  const TestFiles files;
  const std::string folder = files.write("login", "");
  const Login login(folder);
  const Login nobody(folder + "-absent");
  EXPECT_FALSE(login.is_over(1e9)) << "for as long as the user is there";
  EXPECT_FALSE(nobody.is_over(Login::without_login_s - 1));
  EXPECT_TRUE(nobody.is_over(Login::without_login_s)) << "where nobody logs in, as in a container";
  waited_s = 0;
  int tries = 0;
  const auto never = [&] { return ++tries < 0; };
  const auto gives_up = [&](double waited) {
    if (waited > 7200) std::filesystem::remove(folder);
    return login.is_over(waited);
  };
  EXPECT_FALSE(keep_trying(never, gives_up, own_clock));
  EXPECT_NEAR(waited_s, 7200, 0.2);
  EXPECT_GT(tries, 70000);
}

/// The folder that systemd makes for each user who logs in, and takes away with the last login.
TEST(ZeroForce, ALoginIsTheUsersOwn) {
  char folder[64];
  std::snprintf(folder, sizeof folder, "/run/user/%u", static_cast<unsigned>(getuid()));
  EXPECT_EQ(Login::own_folder(), folder);
}

/// Of a session that stands still: at once, and again until it succeeds, told once.
TEST(ZeroForce, AStoppedSessionIsRelievedOnceAndWhenItStopsAgain) {
  for (const int vain : {0, 1, 30}) {
    GuardianBeat beat;
    GuardianWatch watch(&beat);
    int tries = 0, zeroed = 0, unreachable = 0;
    TakeOver take_over([&] { return ++tries > vain; });
    double now = 0;
    for (int round = 1; round <= 2; ++round) {
      tries = 0;
      beat.on_device = OnDevice::pushing;
      ++beat.count;
      for (int look = 0; look < 500; ++look) {
        now += 1e-3 * GuardianWatch::look_every_ms;
        if (!watch.stopped()) continue;
        const TakeOver::Result result = take_over.look(watch, now);
        zeroed += result == TakeOver::Result::zeroed ? 1 : 0;
        unreachable += result == TakeOver::Result::unreachable ? 1 : 0;
      }
      EXPECT_EQ(tries, vain + 1);
      EXPECT_EQ(zeroed, round);
      EXPECT_EQ(unreachable, vain > 20 ? round : 0);
    }
  }
}

/// The session that is ending may need the processor to let go of its device.
TEST(ZeroForce, WaitsBetweenTwoTries) {
  const auto processor_time = [] {
    timespec used{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
  };
  const double before = processor_time(), begun = monotonic_time();
  EXPECT_FALSE(send_zero_force("wooden_haptics", "/absent", 0.1));
  EXPECT_GE(monotonic_time() - begun, 0.1);
  EXPECT_LT(processor_time() - before, 0.05);
}

}  // namespace
}  // namespace palpate::device
