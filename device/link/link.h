#pragma once

/// Carries packets between a driver's protocol and its device: USB, HID, or a fake in the same process.

#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::device {

/// Used by one thread at a time. Nothing here throws: a device that is gone is lost() and stays so.
class Link {
 public:
  Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  virtual ~Link() = default;

  /// The link's own time, s; never decreasing. With it a fake can run faster than the clock.
  virtual double now() noexcept = 0;
  /// Waits at most `timeout` s for the next packet. Returns its size; 0 if none has come.
  virtual std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept = 0;
  /// Hands a packet over without waiting; false if the previous one has not been sent yet.
  virtual bool send(std::span<const std::uint8_t> packet) noexcept = 0;
  /// Waits at most `timeout` s until everything handed over has been sent.
  virtual bool flush(double timeout) noexcept = 0;
  virtual bool lost() const noexcept = 0;
};

/// A link through the Falcon's serial chip (FTDI FT232R).
class FalconLink : public Link {
 public:
  /// A vendor request without data (bmRequestType 0x40, wIndex 0).
  virtual bool control(std::uint8_t request, std::uint16_t value) noexcept = 0;
};

}  // namespace palpate::device
