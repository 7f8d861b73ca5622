#pragma once

/// Every supported device as a fake in this process, on its own clock and held by a hand, with everything that a
/// session, the fault table and the check of the axes need.

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

/// A guardian in this process, alive while time advances.
struct FakeGuardian {
  GuardianBeat beat;
  bool lives = true, proves = true;

  /// For LinkStylusOptions::start_guardian.
  std::unique_ptr<Guardian> start();
};

/// An empty function is a fault that this device cannot have.
struct FakeRig {
  const DeviceType* type = nullptr;
  std::shared_ptr<Stylus> stylus;
  std::function<double()> now;                      ///< s
  std::function<void()> exchange;                   ///< the driver's thread: one exchange, during which time advances
  std::function<void(double)> pass;                 ///< time (s) passes on the device without exchanges
  std::function<Vec3()> force;                      ///< N on the stylus, device frame: exerted by the device now
  std::function<void(const Vec3&)> fling;           ///< sets the hand's velocity, m/s
  std::function<void()> guardian;                   ///< what the guardian's process does to a stopped session
  std::shared_ptr<FakeGuardian> guard;              ///< null: a kind without a guardian
  std::function<int()> torques = [] { return 0; };  ///< received commands of a torque

  bool guardian_looks_on = false;  ///< the guardian cannot remove a force of another client

  std::function<void()> unplug, replug, silence, shorten, halve, garble, impossible, unhome, refuse, foreign;
  std::function<void(double)> delay;  ///< s in addition to every answer

  bool is_arithmetic() const { return type->find == nullptr; }
};

/// The time that the machine of the rigs has slept, s.
void put_rigs_to_sleep(double seconds);

/// The hand's path begins at the origin, a second after the device is switched on and homed.
FakeRig make_rig(const std::string& kind, const std::vector<Waypoint>& path = {});
/// "simulated", "falcon", ...; Haply's two arms have a line each: "haply" and "minverse".
std::span<const char* const> rig_kinds();
/// The name in tables.
std::string name_of_rig(const std::string& kind);

}  // namespace palpate::device
