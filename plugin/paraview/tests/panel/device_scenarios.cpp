// Styluses that are plugged in and out, are lost while they push, or have no guardian: a Force Dimension library with a
// fake device.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QComboBox>
#include <QDir>
#include <QFile>
#include <QPushButton>
#include <QTemporaryDir>
#include <QThread>
#include <QTreeWidget>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>

#include "device/testing/fake_libdrd.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// The device in the library, for as long as it is plugged in.
class PluggedDevice {
 public:
  PluggedDevice() {
    qputenv("PALPATE_PLUGGED", folder_.path().toLocal8Bit());
    qunsetenv("PALPATE_LIBDRD");
  }
  ~PluggedDevice() {
    for (const char* name : {"PALPATE_PLUGGED", "PALPATE_LIBDRD", "PALPATE_GUARDIAN"}) qunsetenv(name);
  }
  void plug_in() {
    qputenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD);
    QFile node(folder_.filePath("1-2"));
    expect(node.open(QIODevice::WriteOnly), "something is plugged in");
  }
  void unplug() {
    qunsetenv("PALPATE_LIBDRD");
    QFile::remove(folder_.filePath("1-2"));
  }
  static FakeDrd& device() {
    void* const library = dlopen(PALPATE_FAKE_LIBDRD, RTLD_NOW | RTLD_NODELETE);
    expect(library != nullptr, "the fake library is loaded");
    return *reinterpret_cast<FakeDrd* (*)()>(dlsym(library, "fake_drd"))();
  }

 private:
  QTemporaryDir folder_;
};

int place_of(const char* kind) {
  auto& box = find<QComboBox>("palpateDevice");
  for (int n = 0; n < box.count(); ++n) {
    if (box.itemData(n).toString().startsWith(QLatin1String(kind))) return n;
  }
  return -1;
}

void plug_in(PluggedDevice& plugged) {
  plugged.plug_in();
  wait_for(
      "the stylus is in the list", [] { return place_of("force_dimension") > 0; }, 20);
}

/// The one that is plugged in, without a force.
void connect_plugged() {
  find<QComboBox>("palpateDevice").setCurrentIndex(place_of("force_dimension"));
  click("palpateConnect");
  wait_for(
      "it is ready", [] { return label("palpateState").startsWith("Ready"); }, 20);
}

/// Nothing is pressed: the list follows what is plugged in, and the choice stays.
void styluses_come_and_go() {
  PluggedDevice plugged;
  scan_is_shown();
  connect_stylus();
  plug_in(plugged);
  expect(find<QComboBox>("palpateDevice").currentData().toString() == "simulated", "what is held stays chosen");
  plugged.unplug();
  wait_for(
      "it has gone", [] { return place_of("force_dimension") < 0; }, 20);
  expect(find<QComboBox>("palpateDevice").currentData().toString() == "simulated", "and stays");
  expect(forces_are_on(), "the session went on");
}

/// A stylus that is lost while forces are on comes back by one press, without a force.
void a_lost_stylus_comes_back() {
  PluggedDevice plugged;
  scan_is_shown();
  plug_in(plugged);
  qputenv("PALPATE_GUARDIAN", "");
  PluggedDevice::device().has_wrist = 1;
  connect_plugged();
  expect(label("palpateOwnLimits").contains("No guardian was found"), "that there is no guardian is said");
  expect(label("palpateOwnLimits").contains("torque stays zero"), "that torque stays zero is said");
  expect(label("palpateOwnLimits").contains("protocol-tested, never run on hardware"), "how it was tested is said");
  turn_forces_on();
  wait_ms(500);
  save_screen("wrist");
  PluggedDevice::device().unplugged = 1;
  wait_for(
      "the loss is told",
      [] {
        return label("palpateState").startsWith("Stopped: ") &&
               label("palpateState").contains("The stylus was unplugged") &&
               find<QPushButton>("palpateFeel").text() == "Open the stylus again";
      },
      20);
  save_screen("lost");
  PluggedDevice::device().unplugged = 0;
  click("palpateFeel");
  wait_for(
      "it is back, without a force", [] { return label("palpateState").startsWith("Ready: no force"); }, 20);
  expect(find<QPushButton>("palpateFeel").text() == "Feel", "only Feel turns the force on");
  wait_ms(500);  // at rest
  PluggedDevice::device().unplugged = 1;
  wait_for(
      "a loss at rest is told, too",
      [] {
        return label("palpateState").startsWith("Stopped: The stylus was unplugged") &&
               find<QPushButton>("palpateFeel").text() == "Open the stylus again" &&
               find<QPushButton>("palpateFeel").isEnabled();
      },
      20);
  PluggedDevice::device().unplugged = 0;
  click("palpateFeel");
  wait_for(
      "it is back again", [] { return label("palpateState").startsWith("Ready: no force"); }, 20);
  turn_forces_on();
}

/// The stylus' second button marks and leaves the force; its third takes the force away.
void buttons_of_the_stylus() {
  PluggedDevice plugged;
  scan_is_shown();
  plug_in(plugged);
  qputenv("PALPATE_GUARDIAN", "");
  connect_plugged();
  turn_forces_on();
  const auto press = [](unsigned button) {
    PluggedDevice::device().buttons = button;
    wait_ms(150);
    PluggedDevice::device().buttons = 0;
    wait_ms(150);
  };
  auto& list = find<QTreeWidget>("palpateMarkList");
  press(2);
  wait_for(
      "the second button marks", [&] { return list.topLevelItemCount() == 1; }, 10);
  expect(label("palpateState").startsWith("Feeling"), "and leaves the force");
  PluggedDevice::device().buttons = 4;  // held until it acts, as a hand does: marks are being drawn meanwhile
  wait_for(
      "the third takes the force away", [] { return label("palpateState").startsWith("Ready"); }, 10);
  PluggedDevice::device().buttons = 0;
  wait_ms(150);
  expect(list.topLevelItemCount() == 1, "and marks nothing");
  press(5);
  expect(list.topLevelItemCount() == 1, "nor does the first");
}

/// The panel is busy as long as the third button is pressed: it takes the force away all the same.
void a_short_press_counts() {
  PluggedDevice plugged;
  scan_is_shown();
  plug_in(plugged);
  connect_plugged();
  turn_forces_on();
  PluggedDevice::device().buttons = 4;
  QThread::msleep(60);
  PluggedDevice::device().buttons = 0;
  wait_for(
      "the force is taken away", [] { return label("palpateState").startsWith("Ready"); }, 10);
}

/// The arm is led as a hand does, along each axis there and back, until a force of 0.2 N lasts.
bool is_led_to_a_force(FakeDrd& device) {
  for (double& coordinate : device.place) {
    for (int n = 0; n < 240; ++n) {
      coordinate = 0.05 * std::sin(n * std::acos(-1.) / 120);  // m: within what the arm reaches
      wait_ms(15);
      if (number("palpateForce") < 0.2) continue;
      wait_ms(500);
      if (number("palpateForce") >= 0.2) return true;  // it lasts
    }
  }
  return false;
}

/// A child that stops this program while the device pushes, and lets it go on once somebody has stopped the device, or
/// after 5 s. It is made before a force acts: to copy a program takes longer than a force may go unrenewed.
class Stopper {
 public:
  /// Of the device in this file.
  explicit Stopper(const QByteArray& file) {
    expect(pipe(pipe_) == 0, "there is a pipe");
    child_ = fork();
    if (child_ == 0) stop_when_told(file.constData());
  }
  void begin() const { expect(write(pipe_[1], "s", 1) == 1, "the child is told"); }
  bool has_ended() { return waitpid(child_, &status_, WNOHANG) == child_; }
  /// Whether the device was stopped while this program stood still. Once it goes on it stops the device too.
  bool saw_it_stopped() const { return WIFEXITED(status_) && WEXITSTATUS(status_) == 0; }

 private:
  static bool is_pushing(const volatile FakeDrd& device) {
    return device.forces_on != 0 && (device.force[0] != 0 || device.force[1] != 0 || device.force[2] != 0);
  }
  static void pause() {
    const timespec briefly{0, 10'000'000};
    nanosleep(&briefly, nullptr);
  }

  [[noreturn]] void stop_when_told(const char* file) const {
    char word = 0;
    if (read(pipe_[0], &word, 1) != 1) _exit(1);
    const int node = open(file, O_RDONLY);
    const auto& device =
        *static_cast<const volatile FakeDrd*>(mmap(nullptr, sizeof(FakeDrd), PROT_READ, MAP_SHARED, node, 0));
    for (int tries = 0; tries < 6000; ++tries, pause()) {
      if (!is_pushing(device)) continue;  // a busy program's session takes its force away by itself
      kill(getppid(), SIGSTOP);
      pause();
      const bool pushes = is_pushing(device);
      const int stopped = device.stopped;
      for (int n = 0; pushes && n < 500 && device.stopped == stopped; ++n) pause();
      const bool is_stopped = device.stopped != stopped && device.forces_on == 0;
      kill(getppid(), SIGCONT);
      if (pushes) _exit(is_stopped ? 0 : 1);
    }
    _exit(1);
  }

  int pipe_[2] = {-1, -1};
  int status_ = 0;
  pid_t child_ = -1;
};

/// The program hangs while it pushes: the guardian that the panel's plug-in found takes the force away.
void the_guardian_takes_the_force() {
  const QTemporaryDir folder;
  const QByteArray file = folder.filePath("device").toLocal8Bit();
  qputenv("PALPATE_FAKE_DRD", file);
  Stopper stopper(file);
  PluggedDevice plugged;
  scan_is_shown();
  plug_in(plugged);
  connect_plugged();
  expect(!label("palpateOwnLimits").contains("No guardian"), "there is a guardian");
  turn_forces_on();
  expect(is_led_to_a_force(PluggedDevice::device()), "a force acts");
  stopper.begin();
  wait_for("this program was stopped and goes on", [&] {
    const bool ended = stopper.has_ended();
    if (!ended && label("palpateState").startsWith("Stopped:")) turn_forces_on();
    return ended;
  });
  expect(stopper.saw_it_stopped(), "the guardian stops it while this program stands still");
  wait_for(
      "the panel says why", [] { return label("palpateState").startsWith("Stopped:"); }, 20);
  expect(PluggedDevice::device().forces_on == 0, "and nobody has turned its force on again");
  save_screen("guardian");
  qunsetenv("PALPATE_FAKE_DRD");
}

}  // namespace

const Scenarios& device_scenarios() {
  static const Scenarios scenarios{{"styluses_come_and_go", styluses_come_and_go},
                                   {"a_lost_stylus_comes_back", a_lost_stylus_comes_back},
                                   {"buttons_of_the_stylus", buttons_of_the_stylus},
                                   {"a_short_press_counts", a_short_press_counts},
                                   {"the_guardian_takes_the_force", the_guardian_takes_the_force}};
  return scenarios;
}
