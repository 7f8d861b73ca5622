#pragma once

/// Plays one scenario to an unmodified client, a process of its own with the real libusb and hidapi. The mount carries
/// bytes between the two; the device and the conditions at the end are the same for every mount.

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
  /// run, unplug, sigint, sigterm, sigkill, sigstop, or denied: a user without permission to open it. replug: unplugged
  /// while it pushes, and plugged in again after a second while the session still holds it; replug_close: the same
  /// after the session has closed it.
  std::string name;
  std::string address;         ///< of a WoodenHaptics arm: its future hidraw path
  bool newer_puck = false;     ///< a SpaceMouse with translation and rotation in one report
  int user = -1;               ///< the client's user and group; -1: as this process
  bool in_plugdev = false;     ///< whether plugdev is its other group
  double zero_within = 0.020;  ///< s after the client has ended, in the guest's own time
  double unplug_after = 1.4;   ///< s after the client first touches it
  double replug_after = 1.0;   ///< s after that; for the replug scenarios
  std::function<bool()> is_plugged_in = [] { return true; };  ///< whether the system has a node for it
};

/// The group that the udev rules give access; the second group of a client with a user of its own.
constexpr unsigned plugdev_group = 46;

/// The fake of a scenario's device, for a mount.
class Play {
 public:
  /// Throws std::invalid_argument for a kind without a fake.
  explicit Play(const Scenario& scenario);
  Play(const Play&) = delete;
  Play& operator=(const Play&) = delete;

  // For the mount, which holds the lock while it plays. One of the two devices exists; times are of CLOCK_MONOTONIC, s.
  std::mutex mutex;
  std::unique_ptr<FakeFalcon> falcon;
  std::unique_ptr<FakeHid> hid;
  bool is_replugged() const { return scenario_.name.starts_with("replug"); }
  /// Loses the state that an unplugged device loses.
  void lose_usb() noexcept;
  /// To be called at any access of the client to the device; the time to unplugging counts from the first one.
  void touch(double now) noexcept;
  bool unplugged(double now) const noexcept;

  /// Runs the client to its end and prints the results of client and device. Returns 0 if both are as the scenario
  /// requires and the last force at the fake is zero.
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
