#pragma once

/// Every device that there is a driver for, as a fake in this process on a clock of its own, held by a hand: what a
/// session, the table of faults and the check of the axes need of it.

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "device/device_type.h"
#include "device/safety/guardian.h"
#include "device/simulated/hand_path.h"
#include "device/stylus.h"

namespace palpate::device {

/// A guardian that lives in this process, and lives while time goes by.
struct FakeGuardian {
  GuardianBeat beat;
  bool lives = true, proves = true;

  /// For LinkStylusOptions::start_guardian.
  std::unique_ptr<Guardian> start();
};

/// A function that is empty is a fault that this device cannot have.
struct FakeRig {
  const DeviceType* type = nullptr;
  std::shared_ptr<Stylus> stylus;
  std::function<double()> now;                      ///< s
  std::function<void()> exchange;                   ///< the driver's thread: one exchange, in which time goes by
  std::function<void(double)> pass;                 ///< s go by on the device, and nobody exchanges
  std::function<Vec3()> force;                      ///< N on the stylus, device frame: what the device does now
  std::function<void(const Vec3&)> fling;           ///< the hand goes on at this velocity, m/s
  std::function<void()> guardian;                   ///< what the guardian's process does to a session that stands still
  std::shared_ptr<FakeGuardian> guard;              ///< null: a kind without one
  std::function<int()> torques = [] { return 0; };  ///< commands of a torque that came

  bool guardian_looks_on = false;  ///< the guardian cannot take a force of another client away

  std::function<void()> unplug, replug, silence, shorten, halve, garble, impossible, unhome, refuse, foreign;
  std::function<void(double)> delay;  ///< s on top of every answer

  bool is_arithmetic() const { return type->find == nullptr; }
};

/// What the machine of the rigs has slept, s.
void put_rigs_to_sleep(double seconds);

/// The hand's path begins a second after the device was switched on, where it is homed; at the origin.
FakeRig make_rig(const std::string& kind, const std::vector<Waypoint>& path = {});
/// "simulated", "falcon", ...; Haply's two arms have a line each: "haply" and "minverse".
std::span<const char* const> rig_kinds();
/// As tables name it.
std::string name_of_rig(const std::string& kind);

}  // namespace palpate::device
