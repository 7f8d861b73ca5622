#pragma once

/// 3D Systems Touch, Touch X and their ancestors (PHANTOM Omni, Desktop) through the maker's own library, libHD.so of
/// OpenHaptics, if it is installed. Written from its public declarations and tested against a library of the same C
/// interface: never run on hardware.

#include <memory>
#include <string>
#include <vector>

#include "device/axis_signs.h"
#include "device/found_devices.h"
#include "device/stylus.h"

namespace palpate::device {

struct TouchSettings {
  std::string address;       ///< the name given to it in the maker's set-up ("Default Device"); empty: the default one
  double maximum_force = 0;  ///< N; 0: the device's own figure, which is never exceeded
  double stiffness_limit = 0;  ///< N/m; 0: that of its model; never above the device's own figure
  /// Whether a model without automatic calibration or inkwell may take its position at open() as its reset position.
  bool may_reset_encoders = false;
  bool guarded = true;  ///< start a guardian process if palpate-guardian is found
  AxisSigns signs;
};

TouchSettings read_touch(const std::string& json_file);

/// The stylus is not open yet. open() throws std::runtime_error if the library or the device is missing, or the library
/// has another version. The state is State::homing until the device is calibrated, by its inkwell if the model has one.
std::unique_ptr<Stylus> make_touch(const TouchSettings& settings = {});

/// One entry if the library is installed: the library names its device only after it was opened.
std::vector<FoundDevice> find_touch();

}  // namespace palpate::device
