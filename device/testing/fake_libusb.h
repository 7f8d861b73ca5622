#pragma once

/// A USB bus of the test's own in place of libusb's, after libusb's documentation: a transfer ends where events are
/// handled, and its callback is called there. Where there is no FakeUsb, libusb itself is called.

#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

namespace palpate::device {

class FakeFalcon;

struct FakeUsbDevice {
  std::uint16_t vendor = 0x0403, product = 0xcb48;  ///< a Falcon's
  std::uint8_t bus = 1, number = 2;
  std::vector<std::uint8_t> ports{3};                         ///< from the bus on
  int open_fails = 0, claim_fails = 0, descriptor_fails = 0;  ///< libusb's error
};

/// How a transfer from the device ends: libusb's status, and the bytes that came.
struct FakeUsbInput {
  std::vector<std::uint8_t> bytes;
  int status = 0;
};

struct FakeUsbRequest {
  int type, request, value, index, length;
  unsigned timeout_ms;
  bool operator==(const FakeUsbRequest&) const = default;
};

/// One at a time.
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
  int control_result = 0;          ///< of each request
  std::deque<FakeUsbInput> input;  ///< what is received next
  std::deque<int> output;          ///< the status by which the next transfers to the device end; empty: completed
  bool takes = true;               ///< what is sent leaves
  int slow_cancels = 0;            ///< times that events are handled before what was cancelled ends
  FakeFalcon* falcon = nullptr;    ///< what is mounted, by the clock
  std::function<void()> on_write;  ///< after something was sent, in the thread that handles events

  // What was asked.
  std::vector<std::vector<std::uint8_t>> written;
  std::vector<unsigned> timeouts_ms;  ///< of each transfer to the device
  std::vector<FakeUsbRequest> requests;
  std::vector<double> waits;  ///< s, for events
  int most_read = 0;          ///< bytes, of a transfer from the device
  int opened = -1;            ///< the last device that was opened
  bool detaches = false;      ///< the kernel's driver is let go
  int misuses = 0;            ///< calls without a context, and transfers freed that have not ended

  // What is held.
  int contexts = 0, lists = 0, handles = 0, transfers = 0, claims = 0;
  bool holds_nothing() const { return contexts + lists + handles + transfers + claims == 0; }
};

}  // namespace palpate::device
