#include "device/testing/umockdev_hid.h"

#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "device/link/realtime.h"

namespace palpate::device {

struct UmockdevHid::Parts {
  explicit Parts(Play& p) : play(p), device(*p.hid), identity(p.hid->identity()) {}

  Play& play;
  FakeHid& device;
  HidIdentity identity;

  bool unplugged() const { return play.unplugged(monotonic_time()); }

  // Each returns the result of the call, or -errno.
  int ioctl(unsigned long request, UMockdevIoctlData* argument) const {
    if (unplugged()) return -ENODEV;
    const std::vector<std::uint8_t>& bytes = identity.report_descriptor;
    if (request == HIDIOCGRDESCSIZE) {
      UMockdevIoctlData* size = umockdev_ioctl_data_resolve(argument, 0, sizeof(int), nullptr);
      if (size == nullptr) return -EFAULT;
      *reinterpret_cast<int*>(size->data) = static_cast<int>(bytes.size());
      return 0;
    }
    if (request == HIDIOCGRDESC) {
      UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(hidraw_report_descriptor), nullptr);
      if (data == nullptr) return -EFAULT;
      std::copy(bytes.begin(), bytes.end(), reinterpret_cast<hidraw_report_descriptor*>(data->data)->value);
      return 0;
    }
    return -ENOTTY;
  }

  int read(std::span<std::uint8_t> into) {
    if (unplugged()) return -EIO;
    const double now = monotonic_time();
    play.touch(now);
    std::array<std::uint8_t, 64> report{};
    // poll() always finds this node readable; a kernel's would wait.
    const auto size = device.read(report, now);
    if (!size) return -EAGAIN;
    const std::size_t fits = std::min(*size, into.size());
    std::copy_n(report.begin(), fits, into.begin());
    return static_cast<int>(fits);
  }

  int write(std::span<const std::uint8_t> bytes) {
    if (unplugged()) return -EIO;
    if (bytes.empty()) return -EINVAL;
    // The kernel takes the report's number off where reports have none.
    device.write(bytes.subspan(identity.numbers_reports ? 0 : 1), monotonic_time());
    return static_cast<int>(bytes.size());
  }
};

namespace {

template <typename Answer>
gboolean complete(UMockdevIoctlClient* client, void* parts, Answer answer) {
  auto& self = *static_cast<UmockdevHid::Parts*>(parts);
  const std::lock_guard lock(self.play.mutex);
  const int result = answer(self, umockdev_ioctl_client_get_arg(client));
  umockdev_ioctl_client_complete(client, result < 0 ? -1 : result, result < 0 ? -result : 0);
  return TRUE;
}

std::span<std::uint8_t> bytes_of(UMockdevIoctlData* data) {
  return {reinterpret_cast<std::uint8_t*>(data->data), static_cast<std::size_t>(data->data_len)};
}

gboolean on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, void* parts) {
  const gulong request = umockdev_ioctl_client_get_request(client);
  return complete(client, parts,
                  [&](const UmockdevHid::Parts& self, UMockdevIoctlData* data) { return self.ioctl(request, data); });
}

gboolean on_read(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, void* parts) {
  return complete(client, parts,
                  [](UmockdevHid::Parts& self, UMockdevIoctlData* data) { return self.read(bytes_of(data)); });
}

gboolean on_write(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, void* parts) {
  return complete(client, parts,
                  [](UmockdevHid::Parts& self, UMockdevIoctlData* data) { return self.write(bytes_of(data)); });
}

std::string hexadecimal(unsigned value, int digits) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%0*x", digits, value);
  return text.data();
}

/// The chain that hidapi follows: USB device, interface, HID device, hidraw node (a regular file: a terminal would
/// never be readable).
std::string record_of(const HidIdentity& who) {
  const std::string vendor = hexadecimal(who.vendor, 4);
  const std::string product = hexadecimal(who.product, 4);
  std::string descriptor;
  for (const std::uint8_t byte : who.report_descriptor) descriptor += hexadecimal(byte, 2);
  const std::string usb = "/devices/usb1/1-2";
  const std::string hid_name = "0003:" + vendor + ":" + product + ".0001";
  const std::string hid = usb + "/1-2:1.0/" + hid_name;
  return "P: " + usb +
         "\nN: bus/usb/001/003\nE: DEVNAME=/dev/bus/usb/001/003\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\n" +
         "E: BUSNUM=001\nE: DEVNUM=003\nA: idVendor=" + vendor + "\\n\nA: idProduct=" + product +
         "\\n\nA: product=" + who.name +
         "\\n\nA: manufacturer=fake\\n\nA: bcdDevice=0100\\n\nA: busnum=1\\n\nA: devnum=3\\n\n\n" + "P: " + usb +
         "/1-2:1.0\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\\n\n\n" + "P: " + hid +
         "\nE: SUBSYSTEM=hid\nE: HID_ID=0003:0000" + vendor + ":0000" + product + "\nE: HID_NAME=" + who.name +
         "\nE: HID_UNIQ=1\nE: HID_PHYS=fake\nH: report_descriptor=" + descriptor + "\n\nP: " + hid +
         "/hidraw/hidraw0\nN: hidraw0=00\nE: SUBSYSTEM=hidraw\nL: device=../../../" + hid_name +
         "\nE: DEVNAME=/dev/hidraw0\nE: MAJOR=246\nE: MINOR=0\n\n";
}

}  // namespace

UmockdevHid::UmockdevHid(Play& play) : parts_(std::make_unique<Parts>(play)) {}

UmockdevHid::~UmockdevHid() = default;

void UmockdevHid::attach(UMockdevTestbed* testbed, GError** error) {
  UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
  g_signal_connect_after(handler, "handle-ioctl", G_CALLBACK(on_ioctl), parts_.get());
  g_signal_connect_after(handler, "handle-read", G_CALLBACK(on_read), parts_.get());
  g_signal_connect_after(handler, "handle-write", G_CALLBACK(on_write), parts_.get());
  if (umockdev_testbed_attach_ioctl(testbed, "/dev/hidraw0", handler, error) == 0) return;
  umockdev_testbed_add_from_string(testbed, record_of(parts_->identity).c_str(), error);
}

}  // namespace palpate::device
