#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "device/found_devices.h"
#include "device/link/link.h"

namespace palpate::device {

/// Never throws: without USB the list is empty.
std::vector<FoundDevice> find_falcons();

/// Opens the Falcon at "bus:device", or the only one. Throws std::runtime_error naming it and what to do.
std::unique_ptr<FalconLink> open_falcon_usb(const std::string& address);

/// Takes the Falcon from the process that holds it, by force, and sends zeros: used for a session that is stopped. That
/// session then finds the Falcon unplugged. False if the Falcon cannot be reached or the kernel refuses.
bool take_falcon_and_send_zeros(const std::string& address) noexcept;

/// The same for the Falcon at this file of /dev/bus/usb.
bool take_falcon_at_and_send_zeros(const char* path) noexcept;

/// Copies what a packet of the serial chip carries: all but the two bytes of status in front. Returns the number of
/// bytes copied; what `packet` has no room for is left out.
std::size_t falcon_payload(std::span<const std::uint8_t> raw, std::span<std::uint8_t> packet) noexcept;

}  // namespace palpate::device
