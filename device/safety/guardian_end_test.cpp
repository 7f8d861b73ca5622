/// How a guardian ends: what it is told, and that nothing of the session's own changes by it.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "device/safety/guardian.h"
#include "device/safety/zero_force.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

std::string content(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// In place of the guardian, a shell that notes what comes through the pipe, to its end.
TEST(GuardianEnd, OneWordTellsHowItEnded) {
  const TestFiles files;
  const std::string told = files.write("told", "");
  for (const bool lost : {false, true}) {
    const auto guardian = start_guardian({.program = "/bin/sh", .kind = "-c", .address = "cat > " + told});
    lost ? guardian->hand_over() : guardian->dismiss();
    EXPECT_EQ(content(told), lost ? "w" : "q");
  }
  start_guardian({.program = "/bin/sh", .kind = "-c", .address = "cat > " + told}).reset();
  EXPECT_EQ(content(told), "q") << "one that is dropped is dismissed";
}

/// Whatever an earlier call has left behind, a guardian that has ended is not waited for again.
TEST(GuardianEnd, IsWaitedForOnce) {
  for (const int before : {0, EINTR, ECHILD}) {
    const auto guardian = start_guardian({.program = "/bin/cat", .kind = "-", .address = "-"});
    errno = before;
    guardian->dismiss();
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }
}

/// The session's own way with a broken pipe is as it was.
TEST(GuardianEnd, TheSessionsSignalsAreItsOwn) {
  struct sigaction own {};
  struct sigaction after {};
  own.sa_handler = [](int) {};
  struct sigaction usual {};
  sigaction(SIGPIPE, &own, &usual);
  start_guardian({.program = "/bin/true", .kind = "-", .address = "-"})->dismiss();
  sigaction(SIGPIPE, &usual, &after);
  EXPECT_EQ(after.sa_handler, own.sa_handler);
}

/// It finds the session's count of exchanges at its third descriptor: exchanges from none on, and whether the last of
/// them pushed.
TEST(GuardianEnd, CountsExchangesWhereTheGuardianLooks) {
  const TestFiles files;
  const std::string told = files.write("told", "");
  const auto guardian =
      start_guardian({.program = "/bin/sh", .kind = "-c", .address = "read word; od -An -tu4 <&3 > " + told + "; cat"});
  guardian->beat(OnDevice::pushing);
  guardian->beat(OnDevice::zero_taken);
  guardian->beat(OnDevice::unknown);
  guardian->dismiss();
  unsigned count = 0, on_device = 0;
  std::ifstream(told) >> count >> on_device;
  EXPECT_EQ(count, 3U);
  EXPECT_EQ(on_device, static_cast<unsigned>(OnDevice::unknown));
  const GuardianBeat fresh;
  EXPECT_EQ(fresh.count.load(), 0U);
  EXPECT_EQ(fresh.on_device.load(), OnDevice::zero_taken) << "nothing was given yet";
}

/// A kind that nobody knows, and one without motors, has nobody to send zeros to: that is said at once.
TEST(GuardianEnd, WhoHasNoMotorsGetsNoZeros) {
  EXPECT_FALSE(send_zero_force("toaster", "", 60));
  EXPECT_FALSE(send_zero_force("simulated", "", 60));
  EXPECT_FALSE(send_zero_force("space_mouse", "", 60));
  setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
  EXPECT_TRUE(send_zero_force("force_dimension", "", 0)) << "one try is always made";
  unsetenv("PALPATE_LIBDRD");
}

/// Beside the program, beside what it was loaded from, in the folders above that from the nearest on, and where it was
/// installed.
TEST(GuardianEnd, IsLookedForInThisOrder) {
  EXPECT_EQ(guardian_candidates("/p/bin/palpate", "/a/b/lib.so", "/i/palpate-guardian"),
            (std::vector<std::string>{"/p/bin/palpate-guardian", "/a/b/palpate-guardian", "/a/b/bin/palpate-guardian",
                                      "/a/b/libexec/palpate/palpate-guardian", "/a/bin/palpate-guardian",
                                      "/a/libexec/palpate/palpate-guardian", "/i/palpate-guardian"}));
}

}  // namespace
}  // namespace palpate::device
