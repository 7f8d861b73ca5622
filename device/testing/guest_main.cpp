// Runs as root in a virtual machine: plugs the fake devices into the kernel's USB and HID stack, one after the other,
// and runs an unmodified client on each.
//   device_guest CLIENT plain | udev [WORD]
// udev: with a udevd that has palpate's rules, for a user in plugdev. WORD: only scenarios with it in their names.
// Prints "N of N scenarios hold".

#include <sys/stat.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "device/link/realtime.h"
#include "device/testing/play.h"
#include "device/testing/uhid_mount.h"
#include "device/testing/usbip_mount.h"

namespace {

using namespace palpate::device;

constexpr const char* hidraw = "/dev/hidraw0";
constexpr const char* serial_port = "/dev/ttyUSB0";
constexpr int a_user = 1000;

enum class Mount { usbip, uhid };

struct Case {
  Mount mount;
  Scenario scenario;
  bool held_by_serial_driver = false;
};

std::vector<Case> cases(bool with_udev) {
  const auto one = [](Mount mount, const char* kind, const char* name) {
    return Case{mount, {.kind = kind, .name = name, .address = hidraw}};
  };
  std::vector<Case> all;
  if (with_udev) {
    for (const char* kind : {"falcon", "wooden_haptics", "space_mouse"}) {
      all.push_back(one(Mount::usbip, kind, "run"));
      all.back().scenario.user = a_user;
      all.back().scenario.in_plugdev = true;
    }
    return all;
  }
  for (const char* name : {"run", "unplug"}) {
    all.push_back(one(Mount::uhid, "space_mouse", name));
    all.back().scenario.newer_puck = true;
  }
  for (const char* name : {"run", "unplug", "sigint", "sigterm", "sigkill", "sigstop", "replug", "replug_close"}) {
    all.push_back(one(Mount::usbip, "falcon", name));
    all.push_back(one(Mount::uhid, "wooden_haptics", name));
  }
  all.push_back(one(Mount::usbip, "wooden_haptics", "run"));
  for (const char* name : {"unplug", "replug", "replug_close"}) {
    all.push_back(one(Mount::usbip, "wooden_haptics", name));
  }
  for (const char* kind : {"falcon", "wooden_haptics", "space_mouse"}) {
    all.push_back(one(Mount::usbip, kind, "denied"));
    all.back().scenario.user = a_user;
  }
  all.push_back(one(Mount::usbip, "falcon", "run"));
  all.back().held_by_serial_driver = true;
  return all;
}

std::string title_of(const Case& one) {
  return one.scenario.kind + (one.mount == Mount::usbip ? " by USB: " : " by HID: ") + one.scenario.name +
         (one.scenario.in_plugdev ? ", a user in plugdev" : "") +
         (one.held_by_serial_driver ? ", held by the kernel's serial driver" : "");
}

bool wait_until(const std::function<bool()>& holds) {
  const double start = monotonic_time();
  while (!holds()) {
    if (monotonic_time() - start > 10) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

int number_in(const std::string& file) {
  int number = 0;
  std::ifstream(file) >> number;
  return number;
}

/// The client's node for the device; empty: there is none yet.
std::string node_of(const Scenario& scenario) {
  std::string node = hidraw;
  // While a session still holds the node of before, the arm gets the next one.
  if (!std::filesystem::exists(node)) node = "/dev/hidraw1";
  if (scenario.kind == "falcon") {
    const std::string device = "/sys/bus/usb/devices/1-1";
    if (!std::filesystem::exists(device + ":1.0")) return {};
    char path[64];
    std::snprintf(path, sizeof path, "/dev/bus/usb/%03d/%03d", number_in(device + "/busnum"),
                  number_in(device + "/devnum"));
    node = path;
  }
  return std::filesystem::exists(node) ? node : std::string();
}

bool is_in_plugdev(const std::string& node) {
  struct stat status {};
  return stat(node.c_str(), &status) == 0 && status.st_gid == plugdev_group && (status.st_mode & 0777U) == 0660;
}

template <typename MountType>
bool holds(const Case& one, const std::string& client) {
  Scenario scenario = one.scenario;
  scenario.is_plugged_in = [&] { return !node_of(one.scenario).empty(); };
  Play play(scenario);
  std::string node;
  bool held = false;
  {
    const MountType mount(play);
    const auto found = [&] { return !(node = node_of(one.scenario)).empty(); };
    if (!wait_until(found)) return std::puts("no node of it") < 0;
    if (one.scenario.in_plugdev && !wait_until([&] { return is_in_plugdev(node); })) {
      return std::printf("the rules do not let plugdev have %s\n", node.c_str()) < 0;
    }
    const auto is_held = [] { return std::filesystem::exists(serial_port); };
    if (one.held_by_serial_driver && !wait_until(is_held)) return std::puts("no serial driver has it") < 0;
    held = play.run(client) == 0;
    if (one.held_by_serial_driver && !wait_until(is_held)) return std::puts("its serial driver is lost") < 0;
  }
  return wait_until([&] { return node_of(one.scenario).empty(); }) && held;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fputs("device_guest CLIENT plain | udev [WORD]\n", stderr);
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::vector<Case> all = cases(std::string(arguments[2]) == "udev");
  const std::string word = count > 3 ? arguments[3] : "";
  std::erase_if(all, [&](const Case& one) { return title_of(one).find(word) == std::string::npos; });
  std::size_t held = 0;
  try {
    for (const Case& one : all) {
      const double start = monotonic_time();
      std::printf("-- %s\n", title_of(one).c_str());
      // The driver knows no Falcon by itself, but a distribution's may.
      if (one.held_by_serial_driver) std::ofstream("/sys/bus/usb-serial/drivers/ftdi_sio/new_id") << "0403 cb48";
      const bool good =
          one.mount == Mount::usbip ? holds<UsbipMount>(one, arguments[1]) : holds<UhidMount>(one, arguments[1]);
      std::printf("%s (%.1f s)\n", good ? "holds" : "FAILS", monotonic_time() - start);
      held += good ? 1 : 0;
    }
  } catch (const std::exception& error) {
    std::printf("device_guest: %s\n", error.what());
  }
  std::printf("%zu of %zu scenarios hold\n", held, all.size());
  return held == all.size() ? 0 : 1;
}
