#pragma once

/// One scenario played to an unmodified client, a process of its own that uses the real libusb and hidapi. The mount
/// carries bytes between the two; what the device is and what has to hold at the end is the same behind every mount.

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "device/testing/fake_falcon.h"
#include "device/testing/fake_hid.h"
#include "device/testing/test_files.h"

namespace palpate::device {

struct Scenario {
  std::string kind;  ///< falcon, wooden_haptics or space_mouse
  /// run, unplug, sigint, sigterm, sigkill, sigstop, or denied: a user who may not open it. replug: unplugged while it
  /// pushes, and plugged in again after a second, with the session that holds it still there; replug_close: with the
  /// session gone.
  std::string name;
  std::string address;        ///< of a WoodenHaptics arm: the hidraw path that it will have
  bool newer_puck = false;    ///< a SpaceMouse that has translation and rotation in one report
  int user = -1;              ///< the client's user and group; -1: as this process
  bool in_plugdev = false;    ///< and its one other group
  double zero_within = 0.4;   ///< s after the client is gone; below the 0.5 s in which an arm helps itself
  double unplug_after = 2.0;  ///< s after the client first touches it
  double replug_after = 1.0;  ///< s after that; in the scenarios of that name
  std::function<bool()> is_plugged_in = [] { return true; };  ///< whether the system has a node of it
};

/// The group that the udev rules let in; the client's second one, where it has a user of its own.
constexpr unsigned plugdev_group = 46;

/// The fake of a scenario's device, for a mount to play.
class Play {
 public:
  /// Throws std::invalid_argument for a kind that there is no fake of.
  explicit Play(const Scenario& scenario);
  Play(const Play&) = delete;
  Play& operator=(const Play&) = delete;

  // For the mount, which holds the lock while it plays. One of the two is there; times are of CLOCK_MONOTONIC, s.
  std::mutex mutex;
  std::unique_ptr<FakeFalcon> falcon;
  std::unique_ptr<FakeHid> hid;
  bool is_replugged() const { return scenario_.name.starts_with("replug"); }
  /// What the device forgets when it is unplugged.
  void lose_usb() noexcept;
  /// Of anything that the client does to the device; unplugged counts from the first time.
  void touch(double now) noexcept;
  bool unplugged(double now) const noexcept;

  /// Runs the client to its end and prints what became of it and of the device. 0 if both did what the scenario says
  /// and the last force that the fake saw is zero.
  int run(const std::string& client);

 private:
  struct Outcome;
  Outcome look();
  double wait_for_zero(double since, double patience);
  double zero_after_replug();

  Scenario scenario_;
  TestFiles files_;
  std::string file_;  // for the client: firmware or settings
  double first_touch_ = -1;
};

}  // namespace palpate::device
