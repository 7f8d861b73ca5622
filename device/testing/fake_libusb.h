#pragma once

/// Replaces libusb by a fake USB bus that follows libusb's documentation: transfers end while events are handled, and
/// their callbacks are called there. While no FakeUsb exists, libusb itself is called.

#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

namespace palpate::device {

class FakeFalcon;

struct FakeUsbDevice {
  std::uint16_t vendor = 0x0403, product = 0xcb48;  ///< a Falcon's
  std::uint8_t bus = 1, number = 2;
  std::vector<std::uint8_t> ports{3};                         ///< ports from the bus on
  int open_fails = 0, claim_fails = 0, descriptor_fails = 0;  ///< libusb's error
};

/// The result of a transfer from the device: libusb's status, and the received bytes.
struct FakeUsbInput {
  std::vector<std::uint8_t> bytes;
  int status = 0;
};

struct FakeUsbRequest {
  int type, request, value, index, length;
  unsigned timeout_ms;
  bool operator==(const FakeUsbRequest&) const = default;
};

/// Only one may exist at a time.
class FakeUsb {
 public:
  FakeUsb();
  FakeUsb(const FakeUsb&) = delete;
  FakeUsb& operator=(const FakeUsb&) = delete;
  ~FakeUsb();

  std::vector<FakeUsbDevice> devices{1};
  int init_fails = 0;              ///< libusb's error
  int list_fails = 0;              ///< the same
  int submit_fails = 0;            ///< the same
  int control_result = 0;          ///< of each control request
  std::deque<FakeUsbInput> input;  ///< results of the next transfers from the device
  std::deque<int> output;          ///< status of the next transfers to the device; empty: completed
  bool takes = true;               ///< whether data can be sent
  int slow_cancels = 0;            ///< how often events are handled before a cancelled transfer ends
  FakeFalcon* falcon = nullptr;    ///< the mounted device, by the clock
  std::function<void()> on_write;  ///< called after data was sent, in the thread that handles events

  // The calls so far.
  std::vector<std::vector<std::uint8_t>> written;
  std::vector<unsigned> timeouts_ms;  ///< of each transfer to the device
  std::vector<FakeUsbRequest> requests;
  std::vector<double> waits;  ///< s, for events
  int most_read = 0;          ///< bytes, of a transfer from the device
  int opened = -1;            ///< the latest opened device
  bool detaches = false;      ///< whether the kernel's driver was detached
  int misuses = 0;            ///< calls without a context, and unfinished transfers that were freed

  // Open resources.
  int contexts = 0, lists = 0, handles = 0, transfers = 0, claims = 0;
  bool holds_nothing() const { return contexts + lists + handles + transfers + claims == 0; }
};

}  // namespace palpate::device
