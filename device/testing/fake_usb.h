#pragma once

/// The fake devices as seen by a host controller: descriptors, control requests, endpoints.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/testing/play.h"

namespace palpate::device {

/// The eight bytes before a control transfer.
struct UsbSetup {
  std::uint8_t type = 0;  ///< bmRequestType
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;
};

using UsbBytes = std::vector<std::uint8_t>;

/// A full-speed device of one interface with one IN and one OUT endpoint. The caller holds the play's lock; times in s.
class FakeUsb {
 public:
  FakeUsb() = default;
  FakeUsb(const FakeUsb&) = delete;
  FakeUsb& operator=(const FakeUsb&) = delete;
  virtual ~FakeUsb() = default;

  virtual UsbBytes device_descriptor() const = 0;
  /// Includes the descriptors of the interface and of its endpoints.
  virtual UsbBytes configuration_descriptor() const = 0;
  virtual std::string name() const = 0;
  /// A request that is not a standard one. Nothing: the endpoint stalls.
  virtual std::optional<UsbBytes> control(const UsbSetup& setup, std::span<const std::uint8_t> data, double now) = 0;
  virtual void write(std::span<const std::uint8_t> packet, double now) = 0;
  /// The IN packet available now: its size.
  virtual std::optional<std::size_t> read(std::span<std::uint8_t> packet, double now) = 0;
};

/// The device of a play; the play outlives it.
std::unique_ptr<FakeUsb> make_fake_usb(Play& play);

/// Answers the requests that are common to all devices, and passes the others to `device`.
std::optional<UsbBytes> answer_control(FakeUsb& device, const UsbSetup& setup, std::span<const std::uint8_t> data,
                                       double now);

}  // namespace palpate::device
