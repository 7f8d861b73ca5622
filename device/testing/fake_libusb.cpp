#include "device/testing/fake_libusb.h"

#include <dlfcn.h>
#include <libusb.h>

#include <algorithm>
#include <list>
#include <span>

#include "device/link/driver_clock.h"
#include "device/link/realtime.h"
#include "device/testing/fake_falcon.h"

struct libusb_device {
  int index;
};
struct libusb_device_handle {
  int index;
};

namespace {

using palpate::device::FakeUsb;

FakeUsb* usb = nullptr;
std::list<libusb_device> listed;      // as long as the bus is there
std::list<libusb_transfer*> pending;  // submitted
std::list<libusb_transfer*> cancelled;

/// Loaded with the program: a test may leave no file to be opened later.
void* const library = dlopen("libusb-1.0.so.0", RTLD_NOW);

template <typename Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

bool is_from_device(const libusb_transfer* transfer) {
  return (transfer->endpoint & LIBUSB_ENDPOINT_IN) != 0;
}

/// Whether the transfer has ended by now.
bool ends(libusb_transfer* transfer) {
  const double now = palpate::device::monotonic_time();
  if (std::find(cancelled.begin(), cancelled.end(), transfer) != cancelled.end()) {
    if (usb->slow_cancels-- > 0) return false;
    usb->slow_cancels = 0;
    cancelled.remove(transfer);
    transfer->status = LIBUSB_TRANSFER_CANCELLED;
    transfer->actual_length = 0;
    return true;
  }
  const std::span bytes(transfer->buffer, static_cast<std::size_t>(transfer->length));
  if (!is_from_device(transfer)) {
    if (!usb->takes) return false;
    transfer->status = LIBUSB_TRANSFER_COMPLETED;
    if (!usb->output.empty()) {
      transfer->status = static_cast<libusb_transfer_status>(usb->output.front());
      usb->output.pop_front();
    }
    transfer->actual_length = transfer->length;
    usb->written.emplace_back(bytes.begin(), bytes.end());
    if (usb->falcon != nullptr) usb->falcon->write(bytes, now);
    if (usb->on_write) usb->on_write();
    return true;
  }
  if (usb->falcon != nullptr) {
    const auto size = usb->falcon->read(bytes, now);
    transfer->status = LIBUSB_TRANSFER_COMPLETED;
    transfer->actual_length = static_cast<int>(size.value_or(0));
    return size.has_value();
  }
  if (usb->input.empty()) return false;
  const palpate::device::FakeUsbInput input = usb->input.front();
  usb->input.pop_front();
  const std::size_t size = std::min(input.bytes.size(), bytes.size());
  std::copy_n(input.bytes.begin(), size, bytes.begin());
  transfer->actual_length = static_cast<int>(size);
  transfer->status = static_cast<libusb_transfer_status>(input.status);
  return true;
}

}  // namespace

namespace palpate::device {

FakeUsb::FakeUsb() {
  usb = this;
}

FakeUsb::~FakeUsb() {
  usb = nullptr;
  listed.clear();
  for (const libusb_transfer* left : pending) delete left;  // never ended, and so nobody else's
  pending.clear();
  cancelled.clear();
}

}  // namespace palpate::device

extern "C" {

int LIBUSB_CALL libusb_init(libusb_context** context) {
  if (usb == nullptr) return real<decltype(&libusb_init)>("libusb_init")(context);
  if (usb->init_fails != 0) return usb->init_fails;
  ++usb->contexts;
  *context = reinterpret_cast<libusb_context*>(usb);
  return 0;
}
void LIBUSB_CALL libusb_exit(libusb_context* context) {
  if (usb == nullptr) return real<decltype(&libusb_exit)>("libusb_exit")(context);
  --usb->contexts;
}
const char* LIBUSB_CALL libusb_strerror(int error) {
  return real<decltype(&libusb_strerror)>("libusb_strerror")(error);
}

ssize_t LIBUSB_CALL libusb_get_device_list(libusb_context* context, libusb_device*** list) {
  if (usb == nullptr) return real<decltype(&libusb_get_device_list)>("libusb_get_device_list")(context, list);
  usb->misuses += context == nullptr ? 1 : 0;
  if (usb->list_fails != 0) return usb->list_fails;
  ++usb->lists;
  const int count = static_cast<int>(usb->devices.size());
  *list = new libusb_device*[usb->devices.size() + 1]();
  for (int i = 0; i < count; ++i) (*list)[i] = &listed.emplace_back(libusb_device{i});
  return count;
}
void LIBUSB_CALL libusb_free_device_list(libusb_device** list, int unref) {
  if (usb == nullptr) return real<decltype(&libusb_free_device_list)>("libusb_free_device_list")(list, unref);
  usb->lists -= unref;
  delete[] list;
}
int LIBUSB_CALL libusb_get_device_descriptor(libusb_device* device, libusb_device_descriptor* descriptor) {
  if (usb == nullptr) {
    return real<decltype(&libusb_get_device_descriptor)>("libusb_get_device_descriptor")(device, descriptor);
  }
  const auto& one = usb->devices[static_cast<std::size_t>(device->index)];
  descriptor->idVendor = one.vendor;
  descriptor->idProduct = one.product;
  return one.descriptor_fails;
}
std::uint8_t LIBUSB_CALL libusb_get_bus_number(libusb_device* device) {
  if (usb == nullptr) return real<decltype(&libusb_get_bus_number)>("libusb_get_bus_number")(device);
  return usb->devices[static_cast<std::size_t>(device->index)].bus;
}
std::uint8_t LIBUSB_CALL libusb_get_device_address(libusb_device* device) {
  if (usb == nullptr) return real<decltype(&libusb_get_device_address)>("libusb_get_device_address")(device);
  return usb->devices[static_cast<std::size_t>(device->index)].number;
}
int LIBUSB_CALL libusb_get_port_numbers(libusb_device* device, std::uint8_t* ports, int most) {
  if (usb == nullptr) return real<decltype(&libusb_get_port_numbers)>("libusb_get_port_numbers")(device, ports, most);
  const auto& one = usb->devices[static_cast<std::size_t>(device->index)].ports;
  if (static_cast<int>(one.size()) > most) return LIBUSB_ERROR_OVERFLOW;
  std::copy(one.begin(), one.end(), ports);
  return static_cast<int>(one.size());
}

int LIBUSB_CALL libusb_open(libusb_device* device, libusb_device_handle** handle) {
  if (usb == nullptr) return real<decltype(&libusb_open)>("libusb_open")(device, handle);
  const int failed = usb->devices[static_cast<std::size_t>(device->index)].open_fails;
  if (failed != 0) return failed;
  ++usb->handles;
  usb->opened = device->index;
  *handle = new libusb_device_handle{device->index};
  return 0;
}
void LIBUSB_CALL libusb_close(libusb_device_handle* handle) {
  if (usb == nullptr) return real<decltype(&libusb_close)>("libusb_close")(handle);
  --usb->handles;
  delete handle;
}
int LIBUSB_CALL libusb_set_auto_detach_kernel_driver(libusb_device_handle* handle, int enable) {
  if (usb == nullptr) {
    return real<decltype(&libusb_set_auto_detach_kernel_driver)>("libusb_set_auto_detach_kernel_driver")(handle,
                                                                                                         enable);
  }
  usb->detaches = enable != 0;
  return 0;
}
int LIBUSB_CALL libusb_claim_interface(libusb_device_handle* handle, int number) {
  if (usb == nullptr) return real<decltype(&libusb_claim_interface)>("libusb_claim_interface")(handle, number);
  const int failed = usb->devices[static_cast<std::size_t>(handle->index)].claim_fails;
  if (number != 0) return LIBUSB_ERROR_NOT_FOUND;
  if (failed == 0) ++usb->claims;
  return failed;
}
int LIBUSB_CALL libusb_release_interface(libusb_device_handle* handle, int number) {
  if (usb == nullptr) return real<decltype(&libusb_release_interface)>("libusb_release_interface")(handle, number);
  if (number != 0) return LIBUSB_ERROR_NOT_FOUND;
  --usb->claims;
  return 0;
}

libusb_transfer* LIBUSB_CALL libusb_alloc_transfer(int packets) {
  if (usb == nullptr) return real<decltype(&libusb_alloc_transfer)>("libusb_alloc_transfer")(packets);
  ++usb->transfers;
  return new libusb_transfer{};
}
void LIBUSB_CALL libusb_free_transfer(libusb_transfer* transfer) {
  if (usb == nullptr) return real<decltype(&libusb_free_transfer)>("libusb_free_transfer")(transfer);
  if (std::erase(pending, transfer) > 0) ++usb->misuses;  // the library goes on to use it
  --usb->transfers;
  delete transfer;
}
int LIBUSB_CALL libusb_submit_transfer(libusb_transfer* transfer) {
  if (usb == nullptr) return real<decltype(&libusb_submit_transfer)>("libusb_submit_transfer")(transfer);
  if (usb->submit_fails != 0) return usb->submit_fails;
  if (is_from_device(transfer)) {
    usb->most_read = transfer->length;
  } else {
    usb->timeouts_ms.push_back(transfer->timeout);
  }
  pending.push_back(transfer);
  return 0;
}
int LIBUSB_CALL libusb_cancel_transfer(libusb_transfer* transfer) {
  if (usb == nullptr) return real<decltype(&libusb_cancel_transfer)>("libusb_cancel_transfer")(transfer);
  if (std::find(pending.begin(), pending.end(), transfer) == pending.end()) return LIBUSB_ERROR_NOT_FOUND;
  cancelled.push_back(transfer);
  return 0;
}
int LIBUSB_CALL libusb_handle_events_timeout_completed(libusb_context* context, timeval* wait, int* completed) {
  if (usb == nullptr) {
    return real<decltype(&libusb_handle_events_timeout_completed)>("libusb_handle_events_timeout_completed")(
        context, wait, completed);
  }
  usb->waits.push_back(static_cast<double>(wait->tv_sec) + 1e-6 * static_cast<double>(wait->tv_usec));
  for (bool any = true; any;) {
    any = false;
    for (libusb_transfer* const transfer : std::list(pending)) {
      if (!ends(transfer)) continue;
      pending.remove(transfer);
      transfer->callback(transfer);
      any = true;
    }
  }
  // A device that is mounted has its own time.
  if (usb->falcon != nullptr && usb->waits.back() > 0) palpate::device::sleep_seconds(50e-6);
  return 0;
}
int LIBUSB_CALL libusb_control_transfer(libusb_device_handle* handle, std::uint8_t type, std::uint8_t request,
                                        std::uint16_t value, std::uint16_t index, unsigned char* data,
                                        std::uint16_t length, unsigned timeout) {
  if (usb == nullptr) {
    return real<decltype(&libusb_control_transfer)>("libusb_control_transfer")(handle, type, request, value, index,
                                                                               data, length, timeout);
  }
  usb->requests.push_back({type, request, value, index, length, timeout});
  if (usb->falcon != nullptr) usb->falcon->control(request, value, palpate::device::monotonic_time());
  return usb->control_result;
}
}
