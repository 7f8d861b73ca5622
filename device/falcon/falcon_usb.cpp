#include "device/falcon/falcon_usb.h"

#include <libusb.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "device/falcon/falcon.h"
#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_protocol.h"
#include "device/link/realtime.h"
#include "device/messages.h"

namespace palpate::device {

namespace {

constexpr std::uint16_t vendor = 0x0403;
constexpr std::uint16_t product = 0xcb48;
constexpr std::uint8_t endpoint_out = 0x02;
constexpr std::uint8_t endpoint_in = 0x81;
constexpr int packet_size = 64;
constexpr int status_size = 2;  // the serial chip's own, in front of every packet
constexpr int errors_in_a_row = 20;

struct ContextDeleter {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
struct HandleDeleter {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
struct TransferDeleter {
  void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
};
using Context = std::unique_ptr<libusb_context, ContextDeleter>;
using Handle = std::unique_ptr<libusb_device_handle, HandleDeleter>;
using Transfer = std::unique_ptr<libusb_transfer, TransferDeleter>;

Context open_context() {
  libusb_context* context = nullptr;
  const int failed = libusb_init(&context);
  if (failed != 0) throw Refusal(say("usb-cannot-be-used-here", libusb_strerror(failed)));
  return Context(context);
}

std::string node_of(libusb_device* device) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%03u:%03u", libusb_get_bus_number(device),
                libusb_get_device_address(device));
  return text.data();
}

/// The socket that it is plugged into ("1-2.3": bus 1, port 2, port 3 of the hub there), which stays the same when it
/// is plugged in again; the kernel's number does not.
std::string address_of(libusb_device* device) {
  std::array<std::uint8_t, 7> ports{};  // as deep as USB goes
  const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  if (depth <= 0) return node_of(device);
  std::string address = std::to_string(libusb_get_bus_number(device));
  for (int i = 0; i < depth; ++i) address += (i == 0 ? '-' : '.') + std::to_string(ports[static_cast<std::size_t>(i)]);
  return address;
}

bool is_at(libusb_device* device, const std::string& address) {
  return address.empty() || address_of(device) == address || node_of(device) == address;
}

/// Calls visit(device) for every Falcon.
template <typename Visit>
void visit_falcons(libusb_context* context, Visit visit) {
  libusb_device** devices = nullptr;
  const ssize_t count = libusb_get_device_list(context, &devices);
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(devices[i], &descriptor) == 0 && descriptor.idVendor == vendor &&
        descriptor.idProduct == product) {
      visit(devices[i]);
    }
  }
  if (count >= 0) libusb_free_device_list(devices, 1);
}

Handle open_handle(libusb_context* context, const std::string& address) {
  Handle handle;
  int failed = 0;
  int matching = 0;
  visit_falcons(context, [&](libusb_device* device) {
    if (!is_at(device, address)) return;
    libusb_device_handle* opened = nullptr;
    if (++matching == 1) failed = libusb_open(device, &opened);
    handle = opened != nullptr ? Handle(opened) : std::move(handle);
  });
  const std::string name = "Novint Falcon" + (address.empty() ? "" : " at " + address);
  if (matching == 0) throw Refusal(say("not-found", name));
  if (matching > 1) {
    throw which_of(name, static_cast<std::size_t>(matching));
  }
  if (failed == LIBUSB_ERROR_ACCESS) {
    throw Refusal(say("permission-denied", name, permission_advice()));
  }
  if (failed != 0) throw Refusal(say("cannot-be-opened-replug", name, libusb_strerror(failed)));
  return handle;
}

class FalconUsb final : public FalconLink {
 public:
  explicit FalconUsb(const std::string& address)
      : context_(open_context()),
        handle_(open_handle(context_.get(), address)),
        in_(libusb_alloc_transfer(0)),
        out_(libusb_alloc_transfer(0)) {
    // ftdi_sio may have taken it for a serial port.
    libusb_set_auto_detach_kernel_driver(handle_.get(), 1);
    const int failed = libusb_claim_interface(handle_.get(), 0);
    if (failed != 0) {
      throw Refusal(say("novint-falcon-another-program-holds", libusb_strerror(failed)));
    }
    libusb_fill_bulk_transfer(in_.get(), handle_.get(), endpoint_in, in_bytes_.data(), packet_size,
                              &FalconUsb::received, this, 0);
    submit_read();
  }

  ~FalconUsb() override {
    closing_ = true;
    if (reading_) libusb_cancel_transfer(in_.get());
    if (sending_) libusb_cancel_transfer(out_.get());
    const double start = now();
    while ((reading_ || sending_) && now() - start < 1.0) handle_events(0.01);
    libusb_release_interface(handle_.get(), 0);
    // libusb still owns a transfer that never came back: leaking it is the lesser evil.
    if (reading_) static_cast<void>(in_.release());
    if (sending_) static_cast<void>(out_.release());
  }

  double now() noexcept override { return monotonic_time(); }
  bool lost() const noexcept override { return lost_; }

  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    const double start = now();
    double left = timeout;
    do {
      if (waiting_size_ == 0) handle_events(std::max(left, 0.0));
      left = timeout - (now() - start);
    } while (waiting_size_ == 0 && left > 0 && !lost_);
    const std::size_t size = std::min(packet.size(), waiting_size_);
    std::copy_n(waiting_.begin(), size, packet.begin());
    std::copy(waiting_.begin() + static_cast<std::ptrdiff_t>(size),
              waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_size_), waiting_.begin());
    waiting_size_ -= size;
    return size;
  }

  bool send(std::span<const std::uint8_t> packet) noexcept override {
    if (sending_) handle_events(0);
    if (sending_ || lost_ || packet.size() > out_bytes_.size()) return false;
    std::copy(packet.begin(), packet.end(), out_bytes_.begin());
    libusb_fill_bulk_transfer(out_.get(), handle_.get(), endpoint_out, out_bytes_.data(),
                              static_cast<int>(packet.size()), &FalconUsb::sent, this, 1000);
    sending_ = submit(out_.get());
    return sending_;
  }

  bool flush(double timeout) noexcept override {
    const double start = now();
    while (sending_ && !lost_ && now() - start < timeout) handle_events(0.001);
    return !sending_ && !lost_;
  }

  bool control(std::uint8_t request, std::uint16_t value) noexcept override {
    constexpr std::uint8_t vendor_request_out = 0x40;
    const int result = libusb_control_transfer(handle_.get(), vendor_request_out, request, value, 0, nullptr, 0, 1000);
    if (result == LIBUSB_ERROR_NO_DEVICE) lost_ = true;
    if (request == ftdi_reset && value == ftdi_purge_received) waiting_size_ = 0;
    return result >= 0;
  }

 private:
  static void LIBUSB_CALL received(libusb_transfer* transfer) {
    auto& self = *static_cast<FalconUsb*>(transfer->user_data);
    self.reading_ = false;
    if (!self.note(transfer)) return;
    if (transfer->status == LIBUSB_TRANSFER_COMPLETED && transfer->actual_length > status_size) {
      const auto size = static_cast<std::size_t>(transfer->actual_length - status_size);
      // Nobody reads: the oldest goes, since only the newest pose matters.
      if (self.waiting_size_ + size > self.waiting_.size()) self.waiting_size_ = 0;
      std::copy_n(transfer->buffer + status_size, size, self.waiting_.begin() + static_cast<long>(self.waiting_size_));
      self.waiting_size_ += size;
    }
    self.submit_read();
  }

  static void LIBUSB_CALL sent(libusb_transfer* transfer) {
    auto& self = *static_cast<FalconUsb*>(transfer->user_data);
    self.sending_ = false;
    self.note(transfer);
  }

  /// Whether the device is still worth asking.
  bool note(const libusb_transfer* transfer) noexcept {
    if (transfer->status == LIBUSB_TRANSFER_COMPLETED) {
      errors_ = 0;
    } else if (transfer->status == LIBUSB_TRANSFER_NO_DEVICE || ++errors_ >= errors_in_a_row) {
      lost_ = true;
    }
    return !lost_ && !closing_;
  }

  void submit_read() noexcept { reading_ = submit(in_.get()); }

  bool submit(libusb_transfer* transfer) noexcept {
    const int failed = libusb_submit_transfer(transfer);
    if (failed != 0) lost_ = true;
    return failed == 0;
  }

  void handle_events(double timeout) noexcept {
    timeval wait{};
    wait.tv_sec = static_cast<time_t>(timeout);
    wait.tv_usec = static_cast<suseconds_t>((timeout - static_cast<double>(wait.tv_sec)) * 1e6);
    libusb_handle_events_timeout_completed(context_.get(), &wait, nullptr);
  }

  Context context_;
  Handle handle_;
  Transfer in_;
  Transfer out_;
  std::array<std::uint8_t, packet_size> in_bytes_{};
  std::array<std::uint8_t, packet_size> out_bytes_{};
  std::array<std::uint8_t, 4096> waiting_{};  // received, without status bytes, not yet asked for
  std::size_t waiting_size_ = 0;
  int errors_ = 0;
  bool reading_ = false;
  bool sending_ = false;
  bool closing_ = false;
  bool lost_ = false;
};

}  // namespace

std::vector<FoundDevice> find_falcons() {
  std::vector<FoundDevice> found;
  libusb_context* opened_context = nullptr;
  if (libusb_init(&opened_context) != 0) return found;
  const Context context(opened_context);
  visit_falcons(context.get(), [&](libusb_device* device) {
    libusb_device_handle* opened = nullptr;
    const int failed = libusb_open(device, &opened);
    const Handle handle(opened);
    found.push_back(
        {"falcon", "Novint Falcon", address_of(device), failed == 0,
         failed == 0 ? ""
                     : (failed == LIBUSB_ERROR_ACCESS ? std::string(permission_advice()) : libusb_strerror(failed))});
  });
  return found;
}

std::unique_ptr<FalconLink> open_falcon_usb(const std::string& address) {
  return std::make_unique<FalconUsb>(address);
}

bool take_falcon_and_send_zeros(const std::string& address) noexcept {
  libusb_context* opened_context = nullptr;
  if (libusb_init(&opened_context) != 0) return false;
  const Context context(opened_context);
  bool sent = false;
  visit_falcons(context.get(), [&](libusb_device* device) {
    if (!is_at(device, address)) return;
    std::array<char, 32> path{};
    std::snprintf(path.data(), path.size(), "/dev/bus/usb/%03u/%03u", libusb_get_bus_number(device),
                  libusb_get_device_address(device));
    sent = take_falcon_at_and_send_zeros(path.data()) || sent;
  });
  return sent;
}

std::unique_ptr<Stylus> make_falcon(const FalconSettings& settings) {
  LinkStylusOptions options;
  if (settings.guarded) options.guardian = {guardian_program(), "falcon", settings.address};
  options.signs = settings.signs;
  options.stays_awake = true;
  return make_falcon_on(
      settings, [address = settings.address] { return open_falcon_usb(address); }, options);
}

}  // namespace palpate::device
