#pragma once

/// The choice of a stylus: its kind, its address if several are plugged in, and the settings of its kind.

#include <cstdint>
#include <memory>
#include <string>

#include "device/device_type.h"
#include "device/stylus.h"

namespace palpate::plugin {

struct StylusChoice {
  std::string device = "simulated";
  std::string firmware;  ///< Falcon: Novint's file
  std::string settings;  ///< a JSON file of the device's settings
  std::uint64_t seed = 1;
  double rate_hz = 1000;  ///< of the simulated one
};

/// Throws WrongUsage for an unknown kind, and names the kinds that exist.
const device::DeviceType& type_of(const StylusChoice& choice);

/// Makes the stylus; it is not open yet. Drivers of real devices start a guardian when they are opened. Throws
/// WrongUsage for an unknown kind, and what the drivers throw for their settings.
std::shared_ptr<device::Stylus> make_stylus(const StylusChoice& choice);

}  // namespace palpate::plugin
