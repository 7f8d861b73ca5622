#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device/found_devices.h"
#include "device/link/link.h"

namespace palpate::device {

struct HidIds {
  unsigned vendor = 0, product = 0, usage_page = 0, usage = 0;
};

/// A kind of device that is reached by HID.
struct HidKind {
  const char* kind;  ///< DeviceType::kind
  const char* name;  ///< its name in errors
  bool (*is_it)(const HidIds& ids) noexcept;
  bool is_held_alone = false;  ///< by a lock on its node, because the kernel lets any number of programs write
  const char* note = "";       ///< for each device found
};

/// The devices of a kind. Never throws; empty if HID does not work.
std::vector<FoundDevice> find_hid_devices(const HidKind& wanted);

/// The kernel's data on the device at a hidraw path: its ids, its socket, its serial number. Empty
/// if there is none. `sysfs`: where the kernel's files are.
std::string hid_identity(const std::string& path, const std::string& sysfs = "/sys");

/// Opens the device of a kind at a hidraw path, or the only one. Throws std::runtime_error naming it and what to do.
std::unique_ptr<Link> open_hid(const HidKind& kind, const std::string& address);

}  // namespace palpate::device
