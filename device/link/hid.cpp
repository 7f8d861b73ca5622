#include "device/link/hid.h"

#include <fcntl.h>
#include <hidapi.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "device/link/realtime.h"
#include "device/messages.h"
#include "device/space_mouse/space_mouse_driver.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"

namespace palpate::device {

namespace {

constexpr unsigned short multi_axis_page = 0x0001;
constexpr unsigned short multi_axis_usage = 0x0008;
constexpr unsigned short wooden_page = 0xffab;
constexpr unsigned short wooden_usage = 0x0200;

struct DeviceCloser {
  void operator()(hid_device* device) const { hid_close(device); }
};

std::string narrow(const wchar_t* text) {
  std::string plain;
  for (; text != nullptr && *text != 0; ++text) plain += *text > 31 && *text < 127 ? static_cast<char>(*text) : '?';
  return plain;
}

/// Empty where the device is none that there is a driver for.
std::string kind_of(const hid_device_info& info) {
  if (is_space_mouse(info.vendor_id, info.product_id) && info.usage_page == multi_axis_page &&
      info.usage == multi_axis_usage) {
    return "space_mouse";
  }
  const bool generic = (info.vendor_id == 0x1234 && info.product_id == 0x0006) ||
                       (info.vendor_id == 0x16c0 && info.product_id == 0x0486);
  if (generic && info.usage_page == wooden_page && info.usage == wooden_usage) return "wooden_haptics";
  return {};
}

/// A lock on a node, for as long as it is held. The kernel lets any number of programs write to an arm.
class NodeLock {
 public:
  NodeLock() = default;
  explicit NodeLock(const std::string& path) : node_(open(path.c_str(), O_RDWR | O_CLOEXEC)) {
    is_taken_ = node_ < 0 || flock(node_, LOCK_EX | LOCK_NB) == 0;
  }
  NodeLock(NodeLock&& other) noexcept
      : node_(std::exchange(other.node_, -1)), is_taken_(std::exchange(other.is_taken_, true)) {}
  NodeLock& operator=(NodeLock&&) = delete;
  ~NodeLock() {
    if (node_ >= 0) close(node_);
  }
  bool is_taken() const noexcept { return is_taken_; }

 private:
  int node_ = -1;
  bool is_taken_ = true;
};

class HidLink final : public Link {
 public:
  HidLink(hid_device* device, NodeLock lock) : device_(device), lock_(std::move(lock)) {}

  double now() noexcept override { return monotonic_time(); }
  bool lost() const noexcept override { return lost_; }
  bool flush(double /*timeout*/) noexcept override { return !lost_; }

  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    if (lost_) return 0;
    const int milliseconds = static_cast<int>(std::ceil(timeout * 1e3));
    errno = 0;
    const int size = hid_read_timeout(device_.get(), packet.data(), packet.size(), milliseconds);
    // A signal that is handled meanwhile is no unplugging.
    if (size < 0 && errno != EINTR) lost_ = true;
    return size > 0 ? static_cast<std::size_t>(size) : 0;
  }

  bool send(std::span<const std::uint8_t> packet) noexcept override {
    std::array<std::uint8_t, 65> report{};  // the first byte is the report's number: none
    if (lost_ || packet.size() >= report.size()) return false;
    std::copy(packet.begin(), packet.end(), report.begin() + 1);
    const bool sent = hid_write(device_.get(), report.data(), packet.size() + 1) >= 0;
    // A write that fails once may be a stall; a device that is gone shows when it is read.
    return sent;
  }

 private:
  std::unique_ptr<hid_device, DeviceCloser> device_;
  NodeLock lock_;
  bool lost_ = false;
};

}  // namespace

std::vector<FoundDevice> find_hid_devices(const std::string& wanted) {
  std::vector<FoundDevice> found;
  if (hid_init() != 0) return found;
  hid_device_info* const list = hid_enumerate(0, 0);
  for (const hid_device_info* info = list; info != nullptr; info = info->next) {
    const std::string kind = kind_of(*info);
    const auto same = [&](const FoundDevice& device) { return device.address == info->path; };
    if (kind != wanted || std::any_of(found.begin(), found.end(), same)) continue;
    FoundDevice device{kind, narrow(info->product_string), info->path, access(info->path, R_OK | W_OK) == 0, {}};
    if (!device.accessible) {
      device.note = permission_advice();
    } else if (kind == "wooden_haptics") {
      device.note = "its USB ids are shared by other devices: make sure that it is one before naming it";
    }
    found.push_back(device);
  }
  hid_free_enumeration(list);
  return found;
}

std::string hid_identity(const std::string& path) {
  const auto slash = path.rfind('/');
  if (slash == std::string::npos) return {};
  std::ifstream about("/sys/class/hidraw/" + path.substr(slash + 1) + "/device/uevent");
  std::string identity;
  for (std::string line; std::getline(about, line);) {
    for (const char* key : {"HID_ID=", "HID_NAME=", "HID_PHYS=", "HID_UNIQ="}) {
      if (line.starts_with(key)) identity += line + "\n";
    }
  }
  return identity;
}

std::unique_ptr<Link> open_hid(const std::string& kind, const std::string& address) {
  std::vector<FoundDevice> found = find_hid_devices(kind);
  std::erase_if(found, [&](const FoundDevice& device) { return !address.empty() && device.address != address; });
  const std::string name = (kind == "wooden_haptics" ? "WoodenHaptics" : "SpaceMouse") +
                           (address.empty() ? std::string() : " at " + address);
  if (found.empty()) throw Refusal(say("not-found-list", name));
  if (found.size() > 1) {
    throw which_of(name, found.size());
  }
  if (!found.front().accessible) throw Refusal(say("permission-denied", name, permission_advice()));
  NodeLock lock = kind == "wooden_haptics" ? NodeLock(found.front().address) : NodeLock();
  if (!lock.is_taken()) throw Refusal(say("arm-is-driven-by-another", name));
  hid_device* const device = hid_open_path(found.front().address.c_str());
  if (device == nullptr) {
    throw Refusal(say("cannot-be-opened-held", name, narrow(hid_error(nullptr))));
  }
  return std::make_unique<HidLink>(device, std::move(lock));
}

std::unique_ptr<Stylus> make_wooden_haptics(const WoodenHapticsSettings& settings) {
  if (settings.address.empty()) {
    throw Refusal(say("woodenhaptics-name-its-address"));
  }
  LinkStylusOptions options;
  if (settings.guarded) options.guardian = {guardian_program(), "wooden_haptics", settings.address};
  options.signs = settings.signs;
  options.stays_awake = true;
  return make_wooden_haptics_on(
      settings, [address = settings.address] { return open_hid("wooden_haptics", address); }, options);
}

std::unique_ptr<Stylus> make_space_mouse(const SpaceMouseSettings& settings) {
  return make_space_mouse_on(settings, [address = settings.address] { return open_hid("space_mouse", address); }, {});
}

}  // namespace palpate::device
