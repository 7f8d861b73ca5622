#pragma once

/// What is plugged in.

#include <cstddef>
#include <string>
#include <vector>

#include "solver/text/message.h"

namespace palpate::device {

struct FoundDevice {
  std::string kind;         ///< DeviceType::kind
  std::string name;         ///< as it calls itself
  std::string address;      ///< what its settings' `address` takes: "bus:device" or a hidraw path
  bool accessible = false;  ///< whether this user may open it
  std::string note;  ///< what else to know: what to type where permission is denied, that it may be another device
};

/// Of every kind that this build has a driver for. Devices that cannot be opened are listed, too.
std::vector<FoundDevice> find_devices();

/// What to throw where several devices match and one is meant.
Refusal which_of(const std::string& name, std::size_t matching);

/// The lines to type where a device is there and permission is denied.
Text permission_advice();

}  // namespace palpate::device
