#pragma once

/// 3D Systems Touch, Touch X and their ancestors (PHANTOM Omni, Desktop) through the maker's own library, libHD.so of
/// OpenHaptics, which is loaded where it is installed. Written from its public declarations and tested against a
/// library of the same C interface: never run on hardware.

#include <memory>
#include <string>
#include <vector>

#include "device/found_devices.h"
#include "device/stylus.h"

namespace palpate::device {

struct TouchSettings {
  std::string address;       ///< the name given to it in the maker's set-up ("Default Device"); empty: the default one
  double maximum_force = 0;  ///< N; 0: what the device says of itself
  double stiffness_limit = 0;  ///< N/m; 0: of its model
};

TouchSettings read_touch(const std::string& json_file);

/// Not open yet. open() throws std::runtime_error: no library, another version of it, no device. State::homing until
/// the device is calibrated, which the user does by its inkwell where the model has one.
std::unique_ptr<Stylus> make_touch(const TouchSettings& settings = {});

/// One entry where the library is installed; which devices it drives it tells only when one is opened.
std::vector<FoundDevice> find_touch();

}  // namespace palpate::device
