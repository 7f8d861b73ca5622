// The guardian's part with systemd, over a real bus of the test's own, on which this test plays logind and systemd
// after their documentation (org.freedesktop.login1, org.freedesktop.systemd1).

#include "device/safety/login_manager.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "device/link/driver_clock.h"
#include "device/safety/guardian.h"
#include "device/testing/fake_libdrd.h"
#include "device/testing/shared_device.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

/// A bus, and on it what logind and the user's systemd answer.
class FakeSystemd {
 public:
  FakeSystemd() {
    const std::string socket = files_.write("bus", "");
    unlink(socket.c_str());
    const std::string config =
        files_.write("bus.conf", "<busconfig><type>session</type><listen>unix:path=" + socket +
                                     "</listen><policy context=\"default\"><allow send_destination=\"*\"/><allow "
                                     "receive_sender=\"*\"/><allow own=\"*\"/></policy></busconfig>");
    daemon_ = fork();
    if (daemon_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // also where the test is ended by its limit
      const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
      dup2(nowhere, STDOUT_FILENO);  // else CTest waits for the daemon, too
      dup2(nowhere, STDERR_FILENO);  // it says which limits it may not raise
      execlp("dbus-daemon", "dbus-daemon", ("--config-file=" + config).c_str(), "--nofork", "--nopidfile", nullptr);
      _exit(127);
    }
    const std::string address = "unix:path=" + socket;
    setenv("DBUS_SYSTEM_BUS_ADDRESS", address.c_str(), 1);
    setenv("DBUS_SESSION_BUS_ADDRESS", address.c_str(), 1);
    // The socket is there a moment before anybody listens.
    while (sd_bus_open_system(&bus_) < 0 && waitpid(daemon_, nullptr, WNOHANG) == 0) sleep_seconds(1e-3);
    if (bus_ == nullptr) throw std::runtime_error("no bus: dbus-daemon is needed");
    for (const char* name : {"org.freedesktop.login1", "org.freedesktop.systemd1"}) {
      EXPECT_GE(sd_bus_request_name(bus_, name, 0), 0);
    }
    for (const char* path : {"/org/freedesktop/login1", "/org/freedesktop/systemd1"}) {
      sd_bus_add_object(bus_, nullptr, path, &FakeSystemd::answer, this);
    }
  }
  FakeSystemd(const FakeSystemd&) = delete;
  FakeSystemd& operator=(const FakeSystemd&) = delete;
  ~FakeSystemd() {
    sd_bus_close_unref(bus_);
    if (lock_ >= 0) close(lock_);
    kill(daemon_, SIGKILL);
    waitpid(daemon_, nullptr, 0);
    unsetenv("DBUS_SYSTEM_BUS_ADDRESS");
    unsetenv("DBUS_SESSION_BUS_ADDRESS");
  }

  std::string asked;  ///< of Inhibit: what, mode
  int locks = 0;      ///< that were given
  std::string scope;
  std::uint32_t scope_pid = 0;

  void announce_sleep(bool near) {
    sd_bus_emit_signal(bus_, "/org/freedesktop/login1", "org.freedesktop.login1.Manager", "PrepareForSleep", "b", near);
    sd_bus_flush(bus_);
  }
  /// Whether somebody holds the lock that was given last: the other end of its pipe is open.
  bool is_locked() const {
    pollfd end{lock_, POLLIN, 0};
    return lock_ >= 0 && poll(&end, 1, 0) == 0;
  }
  /// Plays on until it holds. However busy the machine, it comes, or the test is ended by its limit.
  void play_until(const std::function<bool()>& holds) {
    while (!holds()) {
      while (sd_bus_process(bus_, nullptr) > 0) {
      }
      sleep_seconds(1e-3);
    }
  }

 private:
  static int answer(sd_bus_message* message, void* self, sd_bus_error* /*error*/) {
    auto& fake = *static_cast<FakeSystemd*>(self);
    if (sd_bus_message_is_method_call(message, "org.freedesktop.login1.Manager", "Inhibit") > 0) {
      const char *what = "", *who = "", *why = "", *mode = "";
      sd_bus_message_read(message, "ssss", &what, &who, &why, &mode);
      fake.asked = std::string(what) + ", " + mode;
      std::array<int, 2> ends{};
      EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
      if (fake.lock_ >= 0) close(fake.lock_);
      fake.lock_ = ends[0];
      ++fake.locks;
      sd_bus_reply_method_return(message, "h", ends[1]);
      close(ends[1]);
      return 1;
    }
    if (sd_bus_message_is_method_call(message, "org.freedesktop.systemd1.Manager", "StartTransientUnit") > 0) {
      const char *name = "", *mode = "", *key = "", *text = "";
      sd_bus_message_read(message, "ss", &name, &mode);
      fake.scope = name;
      sd_bus_message_enter_container(message, 'a', "(sv)");
      sd_bus_message_read(message, "(sv)", &key, "s", &text);
      unsigned count = 1;
      sd_bus_message_read(message, "(sv)", &key, "au", count, &fake.scope_pid);
      sd_bus_reply_method_return(message, "o", "/org/freedesktop/systemd1/job/1");
      return 1;
    }
    return 0;
  }

  TestFiles files_;
  pid_t daemon_ = 0;
  sd_bus* bus_ = nullptr;
  int lock_ = -1;
};

TEST(LoginManager, HoldsALockUntilNothingIsPushedAndTakesAnotherAfterTheSleep) {
  FakeSystemd systemd;
  LoginManager manager;
  const auto look_until = [&](const std::function<bool()>& holds) {
    systemd.play_until([&] {
      manager.look();
      return holds();
    });
  };
  look_until([&] { return manager.holds_lock() && !systemd.scope.empty(); });
  EXPECT_EQ(systemd.asked, "sleep, delay");
  EXPECT_TRUE(systemd.is_locked());
  EXPECT_EQ(systemd.scope, "palpate-guardian-" + std::to_string(getpid()) + ".scope");
  EXPECT_EQ(systemd.scope_pid, static_cast<std::uint32_t>(getpid()));
  EXPECT_FALSE(manager.sleep_is_near());
  systemd.announce_sleep(true);
  look_until([&] { return manager.sleep_is_near(); });
  EXPECT_TRUE(systemd.is_locked()) << "it waits";
  manager.let_sleep();
  EXPECT_FALSE(systemd.is_locked());
  systemd.announce_sleep(false);
  look_until([&] { return !manager.sleep_is_near() && manager.holds_lock(); });
  EXPECT_EQ(systemd.locks, 2);
  EXPECT_TRUE(systemd.is_locked());
}

TEST(LoginManager, WithoutABusNothingHappens) {
  setenv("DBUS_SYSTEM_BUS_ADDRESS", "unix:path=/absent", 1);
  setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/absent", 1);
  LoginManager manager;
  for (int n = 0; n < 10; ++n) manager.look();
  EXPECT_FALSE(manager.holds_lock());
  EXPECT_FALSE(manager.sleep_is_near());
  unsetenv("DBUS_SYSTEM_BUS_ADDRESS");
  unsetenv("DBUS_SESSION_BUS_ADDRESS");
}

/// The whole: a guardian's process delays the sleep until its session has seen a zero taken; where the session stands
/// still, until the guardian has taken the force away itself.
TEST(LoginManager, AGuardianLetsTheMachineSleepOnceNoForceIsLeft) {
  for (const bool session_lives : {true, false}) {
    FakeSystemd systemd;
    const TestFiles files;
    const std::string file = files.write("drd", "");
    const SharedDevice<FakeDrd> device(file);
    setenv("PALPATE_FAKE_DRD", file.c_str(), 1);
    setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
    const auto guardian = start_guardian({guardian_program(), "force_dimension", ""});
    guardian->prove();
    guardian->reach();
    OnDevice on_device = OnDevice::pushing;
    const auto beat_until = [&](const std::function<bool()>& holds, bool beats) {
      systemd.play_until([&] {
        if (beats) guardian->beat(on_device);
        return holds();
      });
    };
    beat_until([&] { return systemd.is_locked(); }, true);
    systemd.announce_sleep(true);
    beat_until([&] { return guardian->shared().sleep_is_near.load(); }, true);
    EXPECT_TRUE(systemd.is_locked()) << "a force lies on the device";
    if (session_lives) on_device = OnDevice::zero_taken;
    beat_until([&] { return !systemd.is_locked(); }, session_lives);
    EXPECT_EQ(device->stopped != 0, !session_lives);
    guardian->dismiss();
    unsetenv("PALPATE_FAKE_DRD");
    unsetenv("PALPATE_LIBDRD");
  }
}

}  // namespace
}  // namespace palpate::device
