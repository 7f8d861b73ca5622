#pragma once

/// A driver's knowledge of its device's packets and geometry: no thread, no clock, no USB.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "device/link/link.h"
#include "device/stylus.h"
#include "solver/text/message.h"

namespace palpate::device {

/// The reason for which a driver stopped, until it is opened again.
enum class LinkFault : std::uint8_t {
  none,
  unplugged,
  silent,
  slow,
  unreachable_pose,
  unhomed,
  held_up,         ///< this process was stopped, or its thread was delayed
  slept,           ///< the machine was suspended
  forces_refused,  ///< the device takes no forces, or does not exert them
  own_safety,      ///< the device's own safety took the force away
  foreign_force,   ///< a force acts on it that this program did not send
  unguarded        ///< the guardian ended or does not respond
};
const char* name_of(LinkFault fault);
/// In a sentence: what happened and what to do. Empty for `none`.
Text advice_for(LinkFault fault);

struct ProtocolStatus {
  State state = State::disconnected;  ///< homing, idle or fault
  LinkFault fault = LinkFault::none;
  Vec3 position{0};  ///< m, device frame; always finite
  std::uint32_t buttons = 0;
  std::uint64_t news = 0;  ///< the number of poses so far
  glm::dquat orientation{1, 0, 0, 0};
  /// The last poses were impossible. The link holds the last force for LinkStylusOptions::force_age, lets it fall to
  /// zero, and ramps it up when the doubt ends.
  bool doubtful = false;
  bool withheld = false;  ///< Protocol::step() sent zeros in place of the requested force
  /// N: Protocol::step() sends no more, whatever is requested, as to a device that is on trial.
  double most_force = std::numeric_limits<double>::infinity();
};

class Protocol {
 public:
  Protocol() = default;
  Protocol(const Protocol&) = delete;
  Protocol& operator=(const Protocol&) = delete;
  virtual ~Protocol() = default;

  /// Brings the device into its working state. Throws std::runtime_error naming it and what to do.
  virtual void connect(Link& link) = 0;
  /// Called before the link is closed. `lost`: the device is gone already.
  virtual void disconnected(bool /*lost*/) noexcept {}
  /// As Driver::forget_home().
  virtual void forget_home() noexcept {}
  /// A packet that arrived.
  virtual void receive(std::span<const std::uint8_t> packet, double now) noexcept = 0;
  /// After all packets that arrived: the packet to send now (its size; 0 if none is due), for this force (N).
  virtual std::size_t step(const Vec3& force, double now, std::span<std::uint8_t> packet) noexcept = 0;
  virtual const ProtocolStatus& status() const noexcept = 0;
  /// s without a new pose after which the device counts as dead.
  virtual double longest_silence() const noexcept { return 0.100; }
  /// The largest packet, bytes.
  virtual std::size_t packet_size() const noexcept { return 64; }
  /// Adds what the connected device reports about itself.
  virtual void describe(Specification& /*specification*/) const {}
};

}  // namespace palpate::device
