#pragma once

/// Novint Falcon: three axes, about 9 N, USB 0403:cb48. Written from public knowledge of its protocol and tested
/// against a fake of it: never run on hardware.
///
/// The Falcon loses its firmware when it is switched off. The firmware belongs to Novint: this program neither contains
/// nor downloads it. The user names the file that came with the device.

#include <memory>
#include <string>

#include "device/axis_signs.h"
#include "device/falcon/falcon_kinematics.h"
#include "device/stylus.h"

namespace palpate::device {

/// N: below the vendor's 9, because the motors' gain is not calibrated.
constexpr double falcon_force = 8;

struct FalconSettings {
  std::string address;        ///< "bus:device" as FoundDevice::address; empty: the only Falcon
  std::string firmware_file;  ///< uploaded if the Falcon has none yet
  FalconGeometry geometry;
  /// Motor command per N m: libnifalcon's number, never calibrated. With it the largest command is 16.6 N on z, but the
  /// vendor says 9 N; so a force may be half as strong as commanded. From 4000 to 25000.
  double motor_gain = 10000;
  double maximum_force = falcon_force;  ///< N
  double stiffness_limit = 1000;        ///< N/m
  bool guarded = true;                  ///< start a guardian process if palpate-guardian is found
  AxisSigns signs;
};

/// Throws std::runtime_error naming the file, the key and what is wrong with it. Absent keys keep their defaults.
FalconSettings read_falcon(const std::string& json_file);

/// The stylus is not open yet. open() throws std::runtime_error naming the Falcon and what to do: no device, permission
/// denied, no firmware, an upload that is not echoed. After open() the state is State::homing until the user has pulled
/// the grip all the way out and pushed it in again; the force is zero until then.
std::unique_ptr<Stylus> make_falcon(const FalconSettings& settings = {});

}  // namespace palpate::device
