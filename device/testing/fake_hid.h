#pragma once

/// Shared by the fake HID devices, with their mount in the same process.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/link/link.h"

namespace palpate::device {

/// The data of a device that the host gets when it is plugged in.
struct HidIdentity {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;
  std::vector<std::uint8_t> report_descriptor;
  bool numbers_reports = false;  ///< every report begins with its number
};

class FakeHid {
 public:
  FakeHid() = default;
  FakeHid(const FakeHid&) = delete;
  FakeHid& operator=(const FakeHid&) = delete;
  virtual ~FakeHid() = default;

  virtual HidIdentity identity() const = 0;
  /// The input report available now, with its number first if it has one.
  virtual std::optional<std::size_t> read(std::span<std::uint8_t> report, double now) = 0;
  /// Takes an output report, without its number.
  virtual void write(std::span<const std::uint8_t> report, double now) = 0;
  virtual bool is_pushing(double now) const = 0;
};

/// The clock outlives the link, so a test can examine the device after the driver has gone.
struct FakeHidBench {
  double time = 0;
  bool unplugged = false;
  bool takes = true;  ///< whether reports can be written
};

/// On a clock that advances only during waits.
class FakeHidLink final : public Link {
 public:
  FakeHidLink(FakeHid& device, FakeHidBench& bench) : device_(device), bench_(bench) {}

  double now() noexcept override { return bench_.time; }
  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override;
  bool send(std::span<const std::uint8_t> packet) noexcept override;
  bool flush(double /*timeout*/) noexcept override { return !bench_.unplugged; }
  bool lost() const noexcept override { return bench_.unplugged; }

 private:
  FakeHid& device_;
  FakeHidBench& bench_;
};

}  // namespace palpate::device
