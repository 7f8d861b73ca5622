#include "device/safety/guardian.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "device/falcon/falcon.h"
#include "device/force_dimension/force_dimension.h"
#include "device/haply/haply.h"
#include "device/link/realtime.h"
#include "device/safety/zero_force.h"
#include "device/testing/fake_libdrd.h"
#include "device/testing/shared_device.h"
#include "device/testing/test_files.h"
#include "device/touch/touch.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A Force Dimension's fake library, whose device lies in a file: the guardian stops it there.
struct Guarded {
  TestFiles files;
  std::string file = files.write("drd", "");
  SharedDevice<FakeDrd> device{file};
  std::unique_ptr<Guardian> guardian;

  Guarded() {
    setenv("PALPATE_FAKE_DRD", file.c_str(), 1);
    setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
    guardian = start_guardian({guardian_program(), "force_dimension", ""});
  }
  ~Guarded() {
    guardian.reset();
    unsetenv("PALPATE_FAKE_DRD");
    unsetenv("PALPATE_LIBDRD");
  }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

  /// However busy the machine, it comes, or the test is ended by its limit.
  void wait_until_stopped() const {
    while (device->stopped == 0) std::this_thread::sleep_for(milliseconds(1));
  }
};

/// Looks that are 20 ms apart or more see no session stand still for ten looks that beats within 0.2 s. On a machine
/// that keeps this test waiting for longer, its session does stand still.
TEST(Guardian, SendsZerosWhereASessionStandsStillWhileItPushes) {
  ::testing::internal::CaptureStderr();
  Guarded node;
  ASSERT_TRUE(node.guardian);
  node.guardian->prove();
  node.guardian->reach();
  double longest = 0;  // s between two beats
  for (double begun = monotonic_time(), before = begun; before - begun < 0.5;) {
    node.guardian->beat(OnDevice::pushing);
    std::this_thread::sleep_for(milliseconds(10));
    const double now = monotonic_time();
    longest = std::max(longest, now - before);
    before = now;
  }
  if (longest < 0.19) {
    EXPECT_EQ(node.device->stopped, 0) << "while it lives it is left alone";
  }
  node.wait_until_stopped();
  node.guardian->dismiss();
  EXPECT_NE(::testing::internal::GetCapturedStderr().find(
                "palpate-guardian: the session hangs while it pushes; zero force was sent"),
            std::string::npos);
}

TEST(Guardian, LeavesADeviceAloneThatWasClosed) {
  const Guarded node;
  node.guardian->beat(OnDevice::zero_taken);
  node.guardian->dismiss();  // returns when it has ended
  EXPECT_EQ(node.device->stopped, 0);
}

TEST(Guardian, SendsZerosToADeviceThatComesBack) {
  const Guarded node;
  node.device->devices = 0;
  node.guardian->hand_over();
  node.device->devices = 1;
  node.wait_until_stopped();
}

/// It shows what it is and what it can do, and lives for its session to see.
TEST(Guardian, ProvesItselfAndLives) {
  const Guarded node;
  node.guardian->prove();
  EXPECT_EQ(node.guardian->reach(), GuardianReach::once_free);
  EXPECT_EQ(node.guardian->describe(),
            "its guardian takes the force away within 100 ms after the program ends; a program that only hangs "
            "may keep the device");
  const GuardianBeat& shared = node.guardian->shared();
  for (const std::uint32_t before = shared.lives; shared.lives < before + 5;) {
    std::this_thread::sleep_for(milliseconds(1));
  }
}

/// A program that stands still is noticed later than one that has ended, by the time of the looks. What reaches no
/// device says no time.
TEST(Guardian, SaysWithinWhatTimeTheForceIsGone) {
  for (const unsigned ms : {1U, 100U, 250U}) {
    const auto said = [&](GuardianReach reach) -> std::string {
      GuardianBeat beat;
      beat.reach = reach;
      beat.zero_within_ms = ms;
      return Guardian(0, -1, &beat).describe();
    };
    const std::string ended = " within " + std::to_string(ms) + " ms after the program ends";
    const std::string stopped = " and " + std::to_string(ms + 200) + " ms after it hangs";
    EXPECT_THAT(said(GuardianReach::at_any_time), AllOf(HasSubstr(ended), HasSubstr(stopped)));
    EXPECT_THAT(said(GuardianReach::once_free), AllOf(HasSubstr(ended), Not(HasSubstr(stopped))));
    EXPECT_THAT(said(GuardianReach::looks_on), Not(HasSubstr(" ms ")));
    for (const GuardianReach nothing : {GuardianReach::untold, GuardianReach::none}) EXPECT_EQ(said(nothing), "");
  }
}

/// Another program, one that has ended, and a guardian of another version are no guardians.
TEST(Guardian, WhatProvesNothingIsRefused) {
  const auto refusal = [](const Guardian& guardian) -> std::string {
    try {
      guardian.prove(0.05);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const auto mute = start_guardian({.program = "/bin/cat", .kind = "-", .address = "-"});
  EXPECT_NE(refusal(*mute).find("/bin/cat does not answer as a guardian of this version does"), std::string::npos);
  const auto ended = start_guardian({.program = "/bin/false", .kind = "falcon", .address = ""});
  siginfo_t info{};
  waitid(P_PID, static_cast<id_t>(ended->pid()), &info, WEXITED | WNOWAIT);
  EXPECT_NE(refusal(*ended).find("/bin/false ended at once"), std::string::npos);
  GuardianBeat beat;
  beat.challenge = 5;
  const Guardian other(0, -1, &beat);
  for (const std::uint32_t proof : {0U, 5U, proof_for(4)}) {
    beat.proof = proof;
    EXPECT_NE(refusal(other), "") << proof;
  }
  beat.proof = proof_for(5);
  EXPECT_EQ(refusal(other), "");
  EXPECT_ANY_THROW(other.reach(0.01)) << "it has not looked yet";
  beat.reach = GuardianReach::none;
  EXPECT_ANY_THROW(other.reach(0.01));
  beat.reach = GuardianReach::looks_on;
  EXPECT_EQ(other.reach(0.01), GuardianReach::looks_on);
}

TEST(Guardian, IsMissedWhenItLivesNoMore) {
  MissedGuardian missed;
  missed.start(7, 10);
  EXPECT_EQ(missed.silent_for(7, 10), 0);
  EXPECT_NEAR(missed.silent_for(7, 10.4), 0.4, 1e-9);
  EXPECT_EQ(missed.silent_for(8, 10.5), 0);
  EXPECT_NEAR(missed.silent_for(8, 11.5), 1.0, 1e-9);
}

/// One that is stuck, in a maker's library or wherever, is ended after 2 s. Where a force may be left it is not: it has
/// its word, and goes on when it can.
TEST(Guardian, ItsEndIsNotWaitedForWithoutLimit) {
  for (const bool lost : {false, true}) {
    const auto guardian = start_guardian({.program = "/bin/sleep", .kind = "30", .address = "1"});
    const pid_t pid = guardian->pid();
    const double begun = monotonic_time();
    lost ? guardian->hand_over() : guardian->dismiss();
    const double took = monotonic_time() - begun;
    EXPECT_GT(took, 1.5);
    EXPECT_LT(took, Guardian::end_within_s + 0.5);
    EXPECT_EQ(kill(pid, 0) == 0, lost);
    if (!lost) continue;
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
}

/// Files that this process has open, but for the folder that tells them.
long open_files() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator()) - 1;
}

/// The count of exchanges, where this process shares one.
bool has_shared_memory() {
  std::ifstream maps("/proc/self/maps");
  return std::string(std::istreambuf_iterator<char>(maps), {}).find("palpate-beat") != std::string::npos;
}

TEST(Guardian, EndsOnceAndLeavesNothingOpen) {
  const long before = open_files();
  for (const bool lost : {false, true}) {
    // A program that reads its input to the end, and one that has ended before it is told anything.
    for (const char* const program : {"/bin/cat", "/bin/true"}) {
      auto guardian = start_guardian({.program = program, .kind = "-", .address = "-"});
      EXPECT_EQ(open_files(), before + 1) << "the pipe's end";
      guardian->beat(OnDevice::pushing);
      siginfo_t ended{};
      if (program == std::string("/bin/true")) {
        waitid(P_PID, static_cast<id_t>(guardian->pid()), &ended, WEXITED | WNOWAIT);
      }
      lost ? guardian->hand_over() : guardian->dismiss();
      EXPECT_EQ(open_files(), before);
      // The number of the pipe's end is taken by another file, which a second end must leave alone.
      const int others[] = {dup(STDERR_FILENO), dup(STDERR_FILENO), dup(STDERR_FILENO)};
      guardian->dismiss();
      guardian.reset();
      for (const int other : others) EXPECT_EQ(close(other), 0);
      EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a process is left";
    }
  }
  EXPECT_ANY_THROW(start_guardian({.program = "/absent", .kind = "falcon", .address = ""}));
  EXPECT_EQ(open_files(), before);
  EXPECT_FALSE(has_shared_memory());
  EXPECT_EQ(start_guardian({}), nullptr);
}

TEST(Guardian, OneThatCannotBeStartedLeavesNoMemory) {
  const auto fail_often = [] {
    for (int n = 0; n < 20; ++n) {
      EXPECT_ANY_THROW(start_guardian({.program = "/absent", .kind = "falcon", .address = ""}));
    }
    return mallinfo2().uordblks;
  };
  fail_often();  // what is kept for the next time is there from now on
  const std::size_t before = fail_often();
  EXPECT_LT(fail_often(), before + 20 * 64);
}

/// Ctrl-C in a terminal ends all processes of the session's group.
TEST(Guardian, IsInAGroupOfItsOwn) {
  const TestFiles files;
  const std::string told = files.write("group", "");
  start_guardian({.program = "/bin/sh", .kind = "-c", .address = "cut -d ' ' -f 5 /proc/$$/stat > " + told})->dismiss();
  pid_t group = 0;
  std::ifstream(told) >> group;
  EXPECT_GT(group, 0);
  EXPECT_NE(group, getpgrp());
}

/// A guardian that first notes what it is told.
class NotedGuardian {
 public:
  NotedGuardian() {
    const std::string program = files_.write(
        "guardian", "#!/bin/sh\necho \"$1 $2\" > '" + told_ + "'\nexec '" + guardian_program() + "' \"$@\"\n");
    chmod(program.c_str(), 0755);
    setenv("PALPATE_GUARDIAN", program.c_str(), 1);
  }
  NotedGuardian(const NotedGuardian&) = delete;
  NotedGuardian& operator=(const NotedGuardian&) = delete;
  ~NotedGuardian() { unsetenv("PALPATE_GUARDIAN"); }

  /// Of a stylus that is not there.
  std::string told_by(const std::unique_ptr<Stylus>& stylus) const {
    files_.write("told", "");
    EXPECT_ANY_THROW(stylus->open());
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a guardian of nothing is left";
    std::ifstream told(told_);
    return {std::istreambuf_iterator<char>(told), {}};
  }

 private:
  TestFiles files_;
  std::string told_ = files_.write("told", "");
};

/// Each kind tells its guardian its own name and which device to look after; a stylus that is not there leaves none.
TEST(Guardian, IsToldWhichDeviceItIsAndEndsWithARefusal) {
  setenv("PALPATE_LIBHD", "/absent/libHD.so", 1);
  setenv("PALPATE_LIBDRD", "/absent/libdrd.so", 1);
  WoodenHapticsSettings arm = wooden_haptics_preset("2015");
  arm.address = "/dev/hidraw999";
  const NotedGuardian noted;
  for (const bool guarded : {true, false}) {
    const auto only_then = [&](const char* told) { return guarded ? std::string(told) + "\n" : std::string(); };
    arm.guarded = guarded;
    EXPECT_EQ(noted.told_by(make_wooden_haptics(arm)), only_then("wooden_haptics /dev/hidraw999"));
    EXPECT_EQ(noted.told_by(make_falcon({.address = "999:999", .guarded = guarded})), only_then("falcon 999:999"));
    EXPECT_EQ(noted.told_by(make_haply({.address = "049D", .port = 1, .guarded = guarded})),
              only_then("haply 049D@localhost:1"));
    EXPECT_EQ(noted.told_by(make_touch({.address = "Left", .guarded = guarded})), only_then("touch Left"));
    EXPECT_EQ(noted.told_by(make_force_dimension({.address = "1234", .guarded = guarded})),
              only_then("force_dimension 1234"));
  }
  unsetenv("PALPATE_LIBHD");
  unsetenv("PALPATE_LIBDRD");
}

}  // namespace
}  // namespace palpate::device
