// Sessions that die or are stopped while they push, as processes of their own, on devices that outlive them: a fake
// library's device lies in a file, a fake service in this process. What is told is the force on the device.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <iterator>
#include <string>
#include <thread>

#include "device/safety/guardian.h"
#include "device/testing/fake_libdrd.h"
#include "device/testing/fake_libhd.h"
#include "device/testing/haply_server.h"
#include "device/testing/shared_device.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

using std::chrono::milliseconds;

/// Whether it comes to hold within 15 s.
bool comes(const std::function<bool()>& holds) {
  for (int ms = 0; ms < 15000; ++ms) {
    if (holds()) return true;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return false;
}

class GuardianOfProcess : public ::testing::Test {
 protected:
  GuardianOfProcess() {
    for (const char* name : {"PALPATE_LIBHD", "PALPATE_LIBDRD", "PALPATE_HAPLY", "PALPATE_GUARDIAN"}) unsetenv(name);
    setenv("PALPATE_FAKE_HD", hd_file.c_str(), 1);
    setenv("PALPATE_FAKE_DRD", drd_file.c_str(), 1);
    prctl(PR_SET_CHILD_SUBREAPER, 1);  // what the session leaves behind is this process's to wait for
  }
  ~GuardianOfProcess() override {
    end();
    // Guardians that wait for a device that does not come back.
    std::ifstream children("/proc/self/task/" + std::to_string(getpid()) + "/children");
    for (pid_t child = 0; children >> child;) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
    prctl(PR_SET_CHILD_SUBREAPER, 0);
    for (const char* name : {"PALPATE_FAKE_HD", "PALPATE_FAKE_DRD", "PALPATE_LIBHD", "PALPATE_LIBDRD", "PALPATE_HAPLY",
                             "PALPATE_GUARDIAN"}) {
      unsetenv(name);
    }
  }
  /// A session that pushes for a second and then ends as the scenario says; of "push", until it is ended from here.
  /// When a busy machine lets a force act for how long is nobody's to say, so what needs one waits for it.
  void start(const char* kind, const char* scenario) {
    client_ = fork();
    if (client_ != 0) return;
    const int said = open(said_.c_str(), O_WRONLY | O_APPEND);
    dup2(said, STDOUT_FILENO);
    dup2(said, STDERR_FILENO);
    execl(PALPATE_DEVICE_CLIENT, PALPATE_DEVICE_CLIENT, kind, scenario, nullptr);
    _exit(127);
  }
  /// The session's process, where it still is.
  void end() {
    if (client_ <= 0) return;
    kill(client_, SIGKILL);
    waitpid(client_, nullptr, 0);
    client_ = 0;
  }
  /// Stops or kills a session that was started with "push" while a force acts. False where none comes.
  bool end_while_it_pushes(const std::function<double()>& force_n, int signal) {
    constexpr double enough_n = 0.2;
    for (int tries = 0; tries < 20; ++tries) {
      if (!comes([&] { return force_n() > enough_n; })) return false;
      kill(client_, signal);
      int status = 0;
      waitpid(client_, &status, WUNTRACED);
      if (signal == SIGKILL) client_ = 0;
      if (signal == SIGKILL || force_n() > enough_n) return true;
      kill(client_, SIGCONT);  // held up just then, it had taken the force away by itself
    }
    return false;
  }
  pid_t client() const { return client_; }
  std::string said() const {
    std::ifstream file(said_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  TestFiles files;
  std::string hd_file = files.write("hd", ""), drd_file = files.write("drd", "");
  SharedDevice<FakeHd> hd{hd_file};
  SharedDevice<FakeDrd> drd{drd_file};

 private:
  std::string said_ = files.write("said", "");
  pid_t client_ = 0;
};

TEST_F(GuardianOfProcess, TakesTheForceFromATouchWhoseSessionIsKilled) {
  setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
  start("touch", "push");
  ASSERT_TRUE(end_while_it_pushes([&] { return hd->force[1]; }, SIGKILL)) << said();
  EXPECT_TRUE(comes([&] { return hd->force[1] == 0; })) << "the device itself holds its last force";
}

TEST_F(GuardianOfProcess, TakesTheForceFromATouchWhoseSessionIsStopped) {
  setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
  start("touch", "push");
  ASSERT_TRUE(end_while_it_pushes([&] { return hd->force[1]; }, SIGSTOP)) << said();
  EXPECT_TRUE(comes([&] { return hd->force[1] == 0; }));
}

TEST_F(GuardianOfProcess, TriesUntilATouchOfAStoppedSessionCanBeReached) {
  setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
  start("touch", "push");
  ASSERT_TRUE(comes([&] { return hd->force[1] > 0; })) << said();
  hd->present = 0;
  ASSERT_TRUE(end_while_it_pushes([&] { return hd->force[1]; }, SIGSTOP)) << said();
  ASSERT_TRUE(comes([&] { return said().find("COULD NOT BE REACHED") != std::string::npos; })) << said();
  EXPECT_GT(hd->force[1], 0);
  hd->error = 0;
  hd->present = 1;
  EXPECT_TRUE(comes([&] { return hd->force[1] == 0; }));
  EXPECT_TRUE(comes([&] { return said().find("zero force was sent") != std::string::npos; })) << said();
}

TEST_F(GuardianOfProcess, WithoutAGuardianATouchKeepsItsForce) {
  setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
  setenv("PALPATE_GUARDIAN", "", 1);
  start("touch", "push");
  ASSERT_TRUE(end_while_it_pushes([&] { return hd->force[1]; }, SIGSTOP)) << said();
  end();
  while (waitpid(-1, nullptr, 0) > 0) {
  }
  EXPECT_GT(hd->force[1], 0) << "what the other tests see goes by the guardian alone";
}

/// The session may open the device again at once. One that is there has its zeros by then, and nobody else opens it.
TEST_F(GuardianOfProcess, ADeviceThatIsThereIsZeroedBeforeTheSessionGoesOn) {
  setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
  hd->force[1] = 1;
  start_guardian({guardian_program(), "touch", ""})->hand_over();
  EXPECT_EQ(hd->force[1], 0);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "no child of it is left";
}

TEST_F(GuardianOfProcess, ADeviceThatIsGoneIsWaitedForWhileTheSessionGoesOn) {
  setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
  hd->force[1] = 1;
  hd->present = 0;
  start_guardian({guardian_program(), "touch", ""})->hand_over();
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), 0) << "a child of it waits";
  EXPECT_EQ(hd->force[1], 1);
  hd->present = 1;
  EXPECT_TRUE(comes([&] { return hd->force[1] == 0; }));
}

TEST_F(GuardianOfProcess, StopsAForceDimensionWhoseSessionIsKilled) {
  setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
  start("force_dimension", "push");
  ASSERT_TRUE(end_while_it_pushes([&] { return drd->force[2]; }, SIGKILL)) << said();
  EXPECT_TRUE(comes([&] { return drd->stopped == 1 && drd->forces_on == 0; })) << "beside its firmware's watchdog";
}

/// A program that only looks like a guardian, and one that ends at once: nothing is opened, and it says why.
TEST_F(GuardianOfProcess, WhatProvesNothingIsNoGuardian) {
  setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
  setenv("PALPATE_GUARDIAN", "/bin/false", 1);
  start("force_dimension", "run");
  EXPECT_TRUE(comes([&] { return said().find("/bin/false ended at once") != std::string::npos; })) << said();
  end();
  const std::string mute = files.write("mute", "#!/bin/sh\nwhile read line; do :; done\n");
  chmod(mute.c_str(), 0755);
  setenv("PALPATE_GUARDIAN", mute.c_str(), 1);
  start("force_dimension", "run");
  EXPECT_TRUE(comes([&] { return said().find(mute + " does not answer as a guardian") != std::string::npos; }))
      << said();
  EXPECT_EQ(drd->forces_on, 0);
}

/// A guardian that dies while the stylus pushes is a fault, and the force goes.
TEST_F(GuardianOfProcess, ItsDeathIsAFault) {
  setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
  start("force_dimension", "unplug");  // pushes until there is a fault
  ASSERT_TRUE(comes([&] { return drd->force[2] > 0.2; })) << said();
  std::ifstream children("/proc/" + std::to_string(client()) + "/task/" + std::to_string(client()) + "/children");
  pid_t guardian = 0;
  for (pid_t child = 0; children >> child;) {
    std::string name;
    std::ifstream("/proc/" + std::to_string(child) + "/comm") >> name;
    if (name.starts_with("palpate-guard")) guardian = child;
  }
  ASSERT_GT(guardian, 0);
  kill(guardian, SIGKILL);
  EXPECT_TRUE(comes([&] { return drd->force[2] == 0; }));
  EXPECT_TRUE(comes([&] { return said().find("its guardian is gone") != std::string::npos; })) << said();
}

TEST_F(GuardianOfProcess, SaysOfAHaplyWhetherTheServiceTookTheForceAway) {
  for (const bool service_ends_it : {true, false}) {
    FakeHaply service;
    service.idle_after = service_ends_it ? 0.25 : 60;  // longer than a busy machine needs to see it stopped
    HaplyServer server(service);
    setenv("PALPATE_HAPLY", ("localhost:" + std::to_string(server.port())).c_str(), 1);
    start("haply", "push");
    ASSERT_TRUE(end_while_it_pushes([&] { return glm::length(server.acting()); }, SIGSTOP)) << said();
    const std::string told = service_ends_it ? "hangs while it pushes; zero force was sent"
                                             : "THE STYLUS COULD NOT BE REACHED: switch it off";
    EXPECT_TRUE(comes([&] { return said().find(told) != std::string::npos; })) << said();
    EXPECT_EQ(server.acting() == Vec3(0), service_ends_it);
    end();
  }
}

}  // namespace
}  // namespace palpate::device
