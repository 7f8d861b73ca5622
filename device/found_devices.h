#pragma once

/// The devices that are plugged in.

#include <cstddef>
#include <string>
#include <vector>

#include "solver/text/message.h"

namespace palpate::device {

struct FoundDevice {
  std::string kind;         ///< DeviceType::kind
  std::string name;         ///< as the device reports it
  std::string address;      ///< for its settings' `address`: "bus:device", a hidraw path, a serial number or an id
  bool accessible = false;  ///< whether this user may open it
  std::string note;         ///< what to type if permission is denied, or that it may be another device
};

/// Devices of all kinds, also those that cannot be opened.
std::vector<FoundDevice> find_devices();

/// What to throw if several devices match and one is needed.
Refusal which_of(const std::string& name, std::size_t matching);

/// The lines to type if a device is found but permission is denied.
Text permission_advice();

}  // namespace palpate::device
