#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device/found_devices.h"
#include "device/link/link.h"

namespace palpate::device {

/// Never throws: no USB is no Falcons.
std::vector<FoundDevice> find_falcons();

/// Opens the Falcon at "bus:device", or the only one. Throws std::runtime_error naming it and what to do.
std::unique_ptr<FalconLink> open_falcon_usb(const std::string& address);

}  // namespace palpate::device
