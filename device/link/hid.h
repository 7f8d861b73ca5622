#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device/found_devices.h"
#include "device/link/link.h"

namespace palpate::device {

/// The devices of a kind: WoodenHaptics arms or SpaceMouse pucks. Never throws; empty where HID does not work.
std::vector<FoundDevice> find_hid_devices(const std::string& wanted);

/// What the kernel says of the device at a hidraw path beside its number: its ids, its socket, its serial number. Empty
/// where there is none.
std::string hid_identity(const std::string& path);

/// Opens the device of a kind at a hidraw path, or the only one. Throws std::runtime_error naming it and what to do.
std::unique_ptr<Link> open_hid(const std::string& kind, const std::string& address);

}  // namespace palpate::device
