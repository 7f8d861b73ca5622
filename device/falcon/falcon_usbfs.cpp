// A Falcon that another process holds and does not let go of: libusb would wait for it, the kernel takes it away.

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_usb.h"
#include "device/link/realtime.h"

namespace palpate::device {

namespace {

constexpr unsigned falcon_endpoint_out = 0x02, falcon_endpoint_in = 0x81;
constexpr unsigned usbfs_patience_ms = 100;

class UsbfsFalcon final : public FalconLink {
 public:
  explicit UsbfsFalcon(const char* path) : node_(open(path, O_RDWR | O_CLOEXEC)) {
    // Without flags the kernel takes the interface from whoever has it, a process, too.
    usbdevfs_disconnect_claim claim{};
    is_taken_ = node_ >= 0 && ioctl(node_, USBDEVFS_DISCONNECT_CLAIM, &claim) == 0;
  }
  ~UsbfsFalcon() override {
    if (node_ >= 0) close(node_);
  }

  double now() noexcept override { return monotonic_time(); }
  bool lost() const noexcept override { return !is_taken_; }
  bool flush(double /*timeout*/) noexcept override { return is_taken_; }

  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    std::array<std::uint8_t, 64> raw{};
    const auto ms = std::max(1U, static_cast<unsigned>(std::ceil(timeout * 1e3)));
    usbdevfs_bulktransfer bulk{falcon_endpoint_in, raw.size(), ms, raw.data()};
    const int size = ioctl(node_, USBDEVFS_BULK, &bulk);
    return size > 0 ? falcon_payload(std::span(raw).first(static_cast<std::size_t>(size)), packet) : 0;
  }
  bool send(std::span<const std::uint8_t> packet) noexcept override {
    std::array<std::uint8_t, 64> bytes{};
    if (packet.size() > bytes.size()) return false;
    std::copy(packet.begin(), packet.end(), bytes.begin());
    usbdevfs_bulktransfer bulk{falcon_endpoint_out, static_cast<unsigned>(packet.size()), usbfs_patience_ms,
                               bytes.data()};
    return ioctl(node_, USBDEVFS_BULK, &bulk) >= 0;
  }
  bool control(std::uint8_t request, std::uint16_t value) noexcept override {
    usbdevfs_ctrltransfer transfer{0x40, request, value, 0, 0, usbfs_patience_ms, nullptr};
    return ioctl(node_, USBDEVFS_CONTROL, &transfer) >= 0;
  }

 private:
  int node_;
  bool is_taken_ = false;
};

}  // namespace

std::size_t falcon_payload(std::span<const std::uint8_t> raw, std::span<std::uint8_t> packet) noexcept {
  constexpr std::size_t status = 2;
  if (raw.size() <= status) return 0;
  const std::size_t taken = std::min(packet.size(), raw.size() - status);
  std::copy_n(raw.begin() + status, taken, packet.begin());
  return taken;
}

bool take_falcon_at_and_send_zeros(const char* path) noexcept {
  UsbfsFalcon falcon(path);
  return !falcon.lost() && zero_falcon(falcon);
}

}  // namespace palpate::device
