#pragma once

/// Which stylus is held: a kind, an address where several are plugged in, and what that kind needs.

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
  bool is_simulated() const { return device == "simulated"; }
};

/// Throws WrongUsage, naming those that there are, for a kind that there is not.
const device::DeviceType& type_of(const StylusChoice& choice);

/// Not open yet; drivers of real ones start a guardian when they are opened. Throws WrongUsage for a kind that there is
/// not, and what the drivers throw for their settings.
std::shared_ptr<device::Stylus> make_stylus(const StylusChoice& choice);

}  // namespace palpate::plugin
