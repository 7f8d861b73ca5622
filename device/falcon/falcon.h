#pragma once

/// Novint Falcon: three axes, about 9 N, USB 0403:cb48. Written from public knowledge of its protocol and tested
/// against a fake of it: never run on hardware.
///
/// The Falcon forgets its firmware when it is switched off. The firmware is Novint's: it is not part of this program
/// and never fetched by it; name the file that came with your device.

#include <memory>
#include <string>

#include "device/falcon/falcon_kinematics.h"
#include "device/stylus.h"

namespace palpate::device {

struct FalconSettings {
  std::string address;        ///< "bus:device" as FoundDevice::address; empty: the only Falcon there is
  std::string firmware_file;  ///< uploaded where the Falcon has none yet
  FalconGeometry geometry;
  /// Motor command per N m. libnifalcon's number, which nobody calibrated: with the largest command it means 16.6 N on
  /// z where the vendor says 9 N, so a force may come out as little as half as strong as asked.
  double motor_gain = 10000;
  double maximum_force = 8;  ///< N
  bool guarded = true;       ///< start a guardian process where palpate-guardian is found
};

/// Not open yet. open() throws std::runtime_error naming the Falcon and what to do: no device, permission denied, no
/// firmware, an upload that is not echoed. After open() the state is State::homing until the user has pulled the grip
/// all the way out and pushed it in again; the force is zero until then.
std::unique_ptr<Stylus> make_falcon(const FalconSettings& settings = {});

}  // namespace palpate::device
