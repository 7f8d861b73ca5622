#pragma once

/// Haply Inverse3, Inverse3x and Minverse, with or without a VerseGrip: three axes of force through the maker's
/// service, JSON over a WebSocket on this machine. Written from the maker's public documents and tested against a fake
/// of the service: never run on hardware.

#include <memory>
#include <string>

#include "device/axis_signs.h"
#include "device/stylus.h"

namespace palpate::device {

struct HaplySettings {
  std::string address;             ///< the device's id ("049D"), as FoundDevice::address; empty: the only one
  std::string host = "localhost";  ///< of the service
  int port = 10001;                ///< its simulation channel
  int events_port = 10020;         ///< its events: of its emergency brake; 0: not read
  std::string preset = "arm_front_centered";  ///< puts the origin in the middle of the workspace
  double maximum_force = 3;                   ///< N; the maker publishes none
  double stiffness_limit = 400;               ///< N/m, likewise
  bool guarded = true;                        ///< start a guardian process if palpate-guardian is found
  AxisSigns signs;
};

/// Throws std::runtime_error naming the file, the key and what is wrong with it. Absent keys keep their defaults.
HaplySettings read_haply(const std::string& json_file);

/// The stylus is not open yet. open() throws std::runtime_error if service or device is missing, or several match.
std::unique_ptr<Stylus> make_haply(const HaplySettings& settings = {});

}  // namespace palpate::device
