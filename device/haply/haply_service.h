#pragma once

#include <memory>
#include <vector>

#include "device/found_devices.h"
#include "device/haply/haply_driver.h"

namespace palpate::device {

/// Connects to the service. Throws std::runtime_error naming it and what to do.
std::unique_ptr<HaplyLink> open_haply_service(const HaplySettings& settings);

/// The devices of the service on this machine. Never throws: without the service the list is empty.
std::vector<FoundDevice> find_haply();

/// The settings without a file: host and port from $PALPATE_HAPLY ("localhost:10001"), if it is set.
HaplySettings haply_defaults();

/// For the guardian, "ID@HOST:PORT": a second session with the service, which sends zeros until the service reports
/// that no force acts. Forces of several sessions add up, so this cannot remove another session's force: false if one
/// remains. Throws std::runtime_error.
bool send_zeros_to_haply(const std::string& address);

}  // namespace palpate::device
