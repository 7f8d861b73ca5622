#include "device/testing/umockdev_falcon.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <list>
#include <memory>
#include <mutex>
#include <span>

#include "device/link/realtime.h"

namespace palpate::device {

namespace {

constexpr const char* node = "/dev/bus/usb/001/002";

// Device and configuration descriptors: full speed, 0403:cb48, one vendor interface, bulk IN 0x81 and bulk OUT 0x02.
constexpr const char* record =
    "P: /devices/usb1/1-1\nN: bus/usb/001/002\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM=002\n"
    "E: DEVNAME=/dev/bus/usb/001/002\nE: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: "
    "devnum=2\\n\n"
    "A: speed=12\\n\nH: descriptors=1201000200000040030448cb00050102030109022000010100802d0904000002ffffff00"
    "0705810240000007050202400000\n\n";

/// A transfer is that of one open node, as the kernel has it: a session and its guardian may have the node open at the
/// same time, and neither reaps or ends what the other has submitted. Nobody says that a node was closed: transfers
/// that are left hold their client, so that no later one is taken for it.
struct Urb {
  std::shared_ptr<UMockdevIoctlClient> client;
  UMockdevIoctlData* request = nullptr;
  UMockdevIoctlData* buffer = nullptr;
  bool cancelled = false;

  usbdevfs_urb& urb() const { return *reinterpret_cast<usbdevfs_urb*>(request->data); }
  std::span<std::uint8_t> bytes() const {
    return {reinterpret_cast<std::uint8_t*>(buffer->data), static_cast<std::size_t>(urb().buffer_length)};
  }
};

}  // namespace

struct UmockdevFalcon::Parts {
  explicit Parts(Play& p) : play(p), falcon(*p.falcon) {}

  Play& play;
  FakeFalcon& falcon;
  UMockdevIoctlBase* handler = nullptr;
  std::list<Urb> urbs;  // submitted, not yet reaped

  bool unplugged() const { return play.unplugged(monotonic_time()); }

  /// False if the client died in the middle of it: its memory can no longer be read.
  bool submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
    Urb submitted;
    submitted.client = {static_cast<UMockdevIoctlClient*>(g_object_ref(client)), g_object_unref};
    submitted.request = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
    if (submitted.request == nullptr) return false;
    usbdevfs_urb& urb = submitted.urb();
    submitted.buffer = umockdev_ioctl_data_resolve(submitted.request, offsetof(usbdevfs_urb, buffer),
                                                   static_cast<gsize>(urb.buffer_length), nullptr);
    if (submitted.buffer == nullptr) return false;
    const std::span<std::uint8_t> bytes = submitted.bytes();
    const double now = monotonic_time();
    if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
      if (bytes[0] == 0x40) falcon.control(bytes[1], static_cast<std::uint16_t>(bytes[2] | bytes[3] << 8), now);
      urb.actual_length = 0;
    } else if ((urb.endpoint & 0x80) == 0) {
      play.touch(now);
      falcon.write(bytes, now);
      urb.actual_length = urb.buffer_length;
    }
    urb.status = 0;
    urbs.push_back(submitted);
    return true;
  }

  /// The first transfer of this client that is through by now; of a device that is gone, any.
  std::list<Urb>::iterator completed(const UMockdevIoctlClient* client) {
    for (auto it = urbs.begin(); it != urbs.end(); ++it) {
      if (it->client.get() != client) continue;
      usbdevfs_urb& urb = it->urb();
      if (unplugged()) {
        urb.status = -ESHUTDOWN;
        return it;
      }
      if (it->cancelled) {
        urb.status = -ENOENT;
        return it;
      }
      if (urb.type == USBDEVFS_URB_TYPE_CONTROL || (urb.endpoint & 0x80) == 0) return it;
      if (const auto size = falcon.read(it->bytes(), monotonic_time())) {
        urb.actual_length = static_cast<int>(*size);
        return it;
      }
    }
    return urbs.end();
  }

  /// The result of an ioctl: 0, or -errno.
  int answer(UMockdevIoctlClient* client, unsigned long request, UMockdevIoctlData* argument) {
    if (unplugged() && request != USBDEVFS_REAPURBNDELAY) return -ENODEV;
    switch (request) {
      case USBDEVFS_GET_CAPABILITIES: {
        UMockdevIoctlData* capabilities = umockdev_ioctl_data_resolve(argument, 0, 4, nullptr);
        if (capabilities == nullptr) return -EFAULT;
        *reinterpret_cast<guint32*>(capabilities->data) =
            USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
        return 0;
      }
      case USBDEVFS_GETDRIVER:
        return -ENODATA;
      case USBDEVFS_DISCONNECT_CLAIM:
      case USBDEVFS_IOCTL:
      case USBDEVFS_CLAIMINTERFACE:
      case USBDEVFS_RELEASEINTERFACE:
      case USBDEVFS_RESET:
      case USBDEVFS_CLEAR_HALT:
        return 0;
      case USBDEVFS_SUBMITURB:
        return submit(client, argument) ? 0 : -EFAULT;
      case USBDEVFS_REAPURB:
      case USBDEVFS_REAPURBNDELAY: {
        const auto done = completed(client);
        if (done == urbs.end()) return unplugged() ? -ENODEV : -EAGAIN;
        UMockdevIoctlData* reaped = umockdev_ioctl_data_resolve(argument, 0, sizeof(void*), nullptr);
        if (reaped == nullptr) return -EFAULT;
        umockdev_ioctl_data_set_ptr(reaped, 0, done->request);
        urbs.erase(done);
        return 0;
      }
      case USBDEVFS_DISCARDURB: {
        const gulong wanted = *reinterpret_cast<gulong*>(argument->data);
        for (Urb& urb : urbs) {
          if (urb.client.get() != client || urb.request->client_addr != wanted) continue;
          urb.cancelled = true;
          return 0;
        }
        return -EINVAL;
      }
      default:
        std::fprintf(stderr, "umockdev: ioctl %lx is not known here\n", request);
        return -ENOTTY;
    }
  }
};

namespace {

gboolean on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, void* parts) {
  auto& self = *static_cast<UmockdevFalcon::Parts*>(parts);
  const std::lock_guard lock(self.play.mutex);
  const int result =
      self.answer(client, umockdev_ioctl_client_get_request(client), umockdev_ioctl_client_get_arg(client));
  umockdev_ioctl_client_complete(client, result < 0 ? -1 : 0, result < 0 ? -result : 0);
  return TRUE;
}

}  // namespace

UmockdevFalcon::UmockdevFalcon(Play& play) : parts_(std::make_unique<Parts>(play)) {}

UmockdevFalcon::~UmockdevFalcon() = default;

void UmockdevFalcon::attach(UMockdevTestbed* testbed, GError** error) {
  parts_->handler = umockdev_ioctl_base_new();
  g_signal_connect_after(parts_->handler, "handle-ioctl", G_CALLBACK(on_ioctl), parts_.get());
  if (umockdev_testbed_attach_ioctl(testbed, node, parts_->handler, error) == 0) return;
  umockdev_testbed_add_from_string(testbed, record, error);
}

}  // namespace palpate::device
