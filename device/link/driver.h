#pragma once

/// The interface through which the thread of a LinkStylus drives a device. The driver exchanges packets with it
/// (packet_driver.h), or calls its maker's library.

#include "device/link/protocol.h"
#include "device/stylus.h"

namespace palpate::device {

/// A device's answer to a force. It is judged apart from its poses: a device that refuses forces may send good poses.
enum class ForceAnswer : std::uint8_t {
  taken,     ///< the device or its wire took it; after two more poses the device has it
  waiting,   ///< nothing could be sent yet: the device still has the previous force
  withheld,  ///< the driver sent a zero in its place
  refused    ///< the device refused it: the force on the device is not known
};

/// Used by one thread at a time. Only connect() throws.
class Driver {
 public:
  Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  virtual ~Driver() = default;

  /// Opens the device and brings it into its working state. Throws std::runtime_error naming it and what to do.
  virtual void connect() = 0;
  /// Called after the zeros have been given. May be called without connect().
  virtual void disconnect() noexcept = 0;
  /// The device may have been switched off meanwhile: if it does not know its home by itself, it is to be homed again.
  /// May be called while it is not connected.
  virtual void forget_home() noexcept {}
  /// s, never decreasing; only while connected.
  virtual double now() noexcept = 0;
  /// Takes the newest pose into status(), waiting for one at most `timeout` s.
  virtual void take(double timeout) noexcept = 0;
  /// Hands a force (N) to the device without waiting for it to act.
  virtual ForceAnswer give(const Vec3& force) noexcept = 0;
  /// Waits at most `timeout` s until everything given has been sent.
  virtual void flush(double timeout) noexcept = 0;
  /// Whether the device is gone; it stays so until the next connect().
  virtual bool lost() const noexcept = 0;
  virtual const ProtocolStatus& status() const noexcept = 0;
  /// s without a new pose after which the device counts as dead.
  virtual double longest_silence() const noexcept { return 0.100; }
  /// Adds what the connected device reports about itself.
  virtual void describe(Specification& /*specification*/) const {}
};

}  // namespace palpate::device
