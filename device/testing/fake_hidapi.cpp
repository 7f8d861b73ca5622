#include "device/testing/fake_hidapi.h"

#include <dlfcn.h>
#include <hidapi.h>

#include <algorithm>
#include <cerrno>
#include <span>

#include "device/link/driver_clock.h"
#include "device/link/realtime.h"

struct hid_device_ {
  palpate::device::FakeHid* device;
};

namespace {

palpate::device::FakeHidApi* hid = nullptr;

/// Loaded with the program: a test may leave no file to be opened later.
void* const library = dlopen("libhidapi-hidraw.so.0", RTLD_NOW);

template <typename Function>
Function real_hid(const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

}  // namespace

namespace palpate::device {

FakeHidApi::FakeHidApi() {
  hid = this;
}

FakeHidApi::~FakeHidApi() {
  hid = nullptr;
}

}  // namespace palpate::device

extern "C" {

int hid_init() {
  if (hid == nullptr) return real_hid<decltype(&hid_init)>("hid_init")();
  return hid->starts ? 0 : -1;
}
hid_device_info* hid_enumerate(unsigned short vendor, unsigned short product) {
  if (hid == nullptr) return real_hid<decltype(&hid_enumerate)>("hid_enumerate")(vendor, product);
  ++hid->lists;
  hid_device_info* first = nullptr;
  for (auto node = hid->nodes.rbegin(); node != hid->nodes.rend(); ++node) {
    // As hidapi's header says, a number that is not zero is asked for.
    if ((vendor != 0 && vendor != node->vendor) || (product != 0 && product != node->product)) continue;
    auto* const info = new hid_device_info{};
    info->path = node->path.data();
    info->vendor_id = node->vendor;
    info->product_id = node->product;
    info->product_string = node->name.empty() ? nullptr : node->name.data();
    info->usage_page = node->page;
    info->usage = node->usage;
    info->next = first;
    first = info;
  }
  return first;
}
void hid_free_enumeration(hid_device_info* list) {
  if (hid == nullptr) return real_hid<decltype(&hid_free_enumeration)>("hid_free_enumeration")(list);
  --hid->lists;
  while (list != nullptr) {
    hid_device_info* const next = list->next;
    delete list;
    list = next;
  }
}
hid_device* hid_open_path(const char* path) {
  if (hid == nullptr) return real_hid<decltype(&hid_open_path)>("hid_open_path")(path);
  const auto node =
      std::find_if(hid->nodes.begin(), hid->nodes.end(), [&](const auto& one) { return one.path == path; });
  if (node == hid->nodes.end() || !node->opens) return nullptr;
  ++hid->handles;
  hid->opened = path;
  return new hid_device_{node->device};
}
void hid_close(hid_device* device) {
  if (hid == nullptr) return real_hid<decltype(&hid_close)>("hid_close")(device);
  --hid->handles;
  delete device;
}
const wchar_t* hid_error(hid_device* device) {
  if (hid == nullptr) return real_hid<decltype(&hid_error)>("hid_error")(device);
  return L"a fault of the f\u00e4ke\n";
}
int hid_read_timeout(hid_device* device, unsigned char* data, std::size_t length, int milliseconds) {
  if (hid == nullptr)
    return real_hid<decltype(&hid_read_timeout)>("hid_read_timeout")(device, data, length, milliseconds);
  hid->waits_ms.push_back(milliseconds);
  if (device->device != nullptr) {
    using palpate::device::monotonic_time;
    const double end = monotonic_time() + 1e-3 * milliseconds;
    for (;;) {
      const auto size = device->device->read(std::span(data, length), monotonic_time());
      if (size || monotonic_time() >= end) return static_cast<int>(size.value_or(0));
      palpate::device::sleep_seconds(50e-6);
    }
  }
  if (hid->input.empty()) return 0;
  const palpate::device::FakeHidInput input = hid->input.front();
  hid->input.pop_front();
  if (input.failed != 0) {
    if (input.failed != palpate::device::FakeHidInput::without_errno) errno = input.failed;
    return -1;
  }
  const std::size_t size = std::min(input.bytes.size(), length);
  std::copy_n(input.bytes.begin(), size, data);
  return static_cast<int>(size);
}
int hid_write(hid_device* device, const unsigned char* data, std::size_t length) {
  if (hid == nullptr) return real_hid<decltype(&hid_write)>("hid_write")(device, data, length);
  if (!hid->takes) return -1;
  hid->written.emplace_back(data, data + length);
  if (device->device != nullptr && length > 1) {
    device->device->write(std::span(data, length).subspan(1), palpate::device::monotonic_time());
  }
  if (hid->on_write) hid->on_write();
  return static_cast<int>(length);
}
}
