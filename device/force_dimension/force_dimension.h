#pragma once

/// Force Dimension's omega, delta, sigma and lambda (and the Novint Falcon) through the maker's own library, libdrd.so,
/// if it is installed. Written from its public declarations (DHD and DRD 3.17.5) and tested against a library of the
/// same C interface: never run on hardware.

#include <memory>
#include <string>
#include <vector>

#include "device/axis_signs.h"
#include "device/found_devices.h"
#include "device/stylus.h"

namespace palpate::device {

struct ForceDimensionSettings {
  std::string address;            ///< its serial number; empty: the only one
  bool may_home = false;          ///< an arm that has no home yet may move by itself to find it
  double maximum_force = 0;       ///< N; 0: the device's own figure, which is never exceeded
  double stiffness_limit = 1500;  ///< N/m
  bool guarded = true;            ///< start a guardian process if palpate-guardian is found
  AxisSigns signs;
};

ForceDimensionSettings read_force_dimension(const std::string& json_file);

/// The stylus is not open yet. open() throws std::runtime_error if the library or the device is missing, the library
/// has another version, or the arm has no home and may not move.
std::unique_ptr<Stylus> make_force_dimension(const ForceDimensionSettings& settings = {});

/// Opens and closes each device that the library finds. While this process connects, holds or disconnects one, none is
/// opened. Never throws; without the library there are none. For any thread.
std::vector<FoundDevice> find_force_dimension();

}  // namespace palpate::device
