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

namespace palpate::device {

namespace {

struct DeviceCloser {
  void operator()(hid_device* device) const { hid_close(device); }
};

std::string narrow(const wchar_t* text) {
  std::string plain;
  for (; text != nullptr && *text != 0; ++text) plain += *text > 31 && *text < 127 ? static_cast<char>(*text) : '?';
  return plain;
}

/// A lock on a node, for as long as it is held.
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

std::vector<FoundDevice> find_hid_devices(const HidKind& wanted) {
  std::vector<FoundDevice> found;
  if (hid_init() != 0) return found;
  hid_device_info* const list = hid_enumerate(0, 0);
  for (const hid_device_info* info = list; info != nullptr; info = info->next) {
    const bool is_it = wanted.is_it({info->vendor_id, info->product_id, info->usage_page, info->usage});
    const auto same = [&](const FoundDevice& device) { return device.address == info->path; };
    if (!is_it || std::any_of(found.begin(), found.end(), same)) continue;
    FoundDevice device{wanted.kind, narrow(info->product_string), info->path, access(info->path, R_OK | W_OK) == 0, {}};
    device.note = device.accessible ? wanted.note : std::string(permission_advice());
    found.push_back(device);
  }
  hid_free_enumeration(list);
  return found;
}

std::string hid_identity(const std::string& path, const std::string& sysfs) {
  const auto slash = path.rfind('/');
  if (slash == std::string::npos) return {};
  std::ifstream about(sysfs + "/class/hidraw/" + path.substr(slash + 1) + "/device/uevent");
  std::string identity;
  for (std::string line; std::getline(about, line);) {
    for (const char* key : {"HID_ID=", "HID_NAME=", "HID_PHYS=", "HID_UNIQ="}) {
      if (line.starts_with(key)) identity += line + "\n";
    }
  }
  return identity;
}

std::unique_ptr<Link> open_hid(const HidKind& kind, const std::string& address) {
  std::vector<FoundDevice> found = find_hid_devices(kind);
  std::erase_if(found, [&](const FoundDevice& device) { return !address.empty() && device.address != address; });
  const std::string name = kind.name + (address.empty() ? std::string() : " at " + address);
  if (found.empty()) throw Refusal(say("not-found-list", name));
  if (found.size() > 1) {
    throw which_of(name, found.size());
  }
  if (!found.front().accessible) throw Refusal(say("permission-denied", name, permission_advice()));
  NodeLock lock = kind.is_held_alone ? NodeLock(found.front().address) : NodeLock();
  if (!lock.is_taken()) throw Refusal(say("arm-is-driven-by-another", name));
  hid_device* const device = hid_open_path(found.front().address.c_str());
  if (device == nullptr) {
    throw Refusal(say("cannot-be-opened-held", name, narrow(hid_error(nullptr))));
  }
  return std::make_unique<HidLink>(device, std::move(lock));
}

}  // namespace palpate::device
