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

/// The settings where no file names others: host and port from $PALPATE_HAPLY ("localhost:10001"), if it is set.
HaplySettings haply_defaults();

/// For the guardian, "ID@HOST:PORT": a second session with the service, which sends zeros until the service tells that
/// no force acts. Forces of several sessions add up, so that it cannot take another's away: false where one stays.
/// Throws std::runtime_error.
bool send_zeros_to_haply(const std::string& address);

}  // namespace palpate::device
