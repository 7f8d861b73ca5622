#pragma once

#include <limits>
#include <optional>

#include "device/link/hid.h"
#include "device/link/link_stylus.h"
#include "device/link/lock_step.h"
#include "device/link/pose_doubt.h"
#include "device/link/protocol.h"
#include "device/safety/sustained.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {

extern const HidKind wooden_haptics_hid;

/// The same stylus as make_wooden_haptics()'s, on any link.
std::unique_ptr<LinkStylus> make_wooden_haptics_on(const WoodenHapticsSettings& settings,
                                                   LinkStylus::LinkMaker make_link, const LinkStylusOptions& options);

/// Reports of 14 bytes (seven int16, little-endian; 64 bytes from a Teensy, padded) or 8 bytes (firmware of 2016). The
/// firmware sends one and waits for one: lock-step, with a zero to start it.
class WoodenHapticsProtocol final : public Protocol {
 public:
  explicit WoodenHapticsProtocol(const WoodenHapticsSettings& settings) : settings_(settings) {}

  void connect(Link& link) override;
  void disconnected(bool lost) noexcept override;
  void forget_home() noexcept override { calibrated_ = keeps_home_ = false; }
  void receive(std::span<const std::uint8_t> packet, double now) noexcept override;
  std::size_t step(const Vec3& force, double now, std::span<std::uint8_t> packet) noexcept override;
  const ProtocolStatus& status() const noexcept override { return status_; }

 private:
  void take(const std::array<int, 3>& counts, double now) noexcept;
  std::array<int, 3> within_load(std::array<int, 3> milliamperes, double elapsed) noexcept;
  void fail(LinkFault fault) noexcept;

  WoodenHapticsSettings settings_;
  ProtocolStatus status_;
  std::size_t report_size_ = 0;  // 0: not known yet
  std::array<int, 3> offset_{};
  bool calibrated_ = false;
  bool button_ = false;                                      // the calibration button's latch in the last report
  double homed_ = -std::numeric_limits<double>::infinity();  // s: when its button was last let go
  Vec3 angles_{0};
  PoseDoubt doubt_{0.25};  // reports have no checksum: many impossible ones mean that others are wrong, too
  /// The firmware waits for an output after each report. If it does not wait, the newest report is current.
  LockStep exchange_{{.overdue = 0.010, .speaks_unasked = true}};
  bool started_ = false;
  double sent_ = 0;
  std::array<SustainedLoad, 3> loads_;  // of the motors
  bool keeps_home_ = false;             // it was closed, and had power all the time: its counters went on counting
  int starts_ = 0;
};

}  // namespace palpate::device
