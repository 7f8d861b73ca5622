#pragma once

#include <memory>
#include <vector>

#include "device/found_devices.h"
#include "device/haply/haply_driver.h"

namespace palpate::device {

/// Connects to the service. Throws std::runtime_error naming it and what to do.
std::unique_ptr<HaplyLink> open_haply_service(const HaplySettings& settings);

/// What the service on this machine has. Never throws: no service is no devices.
std::vector<FoundDevice> find_haply();

}  // namespace palpate::device
