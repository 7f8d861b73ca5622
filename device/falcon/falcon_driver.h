#pragma once

#include <functional>
#include <string>
#include <vector>

#include "device/falcon/falcon.h"
#include "device/falcon/falcon_protocol.h"
#include "device/link/link_stylus.h"
#include "device/link/lock_step.h"
#include "device/link/pose_doubt.h"
#include "device/link/protocol.h"

namespace palpate::device {

/// The vendor request of FTDI that resets a buffer of the chip, and the value that empties the receive buffer.
constexpr std::uint8_t ftdi_reset = 0;
constexpr std::uint16_t ftdi_purge_received = 1;

Specification falcon_specification(const FalconSettings& settings);

/// A message about a motor gain that no Falcon has; empty if it may be right.
Text wrong_gain(const FalconSettings& settings);

/// The same stylus as make_falcon()'s, on any link.
std::unique_ptr<LinkStylus> make_falcon_on(const FalconSettings& settings, LinkStylus::LinkMaker make_link,
                                           const LinkStylusOptions& options);

/// Starts the serial chip, then the firmware in run mode. Uploads the firmware first if it is not loaded. Throws
/// std::runtime_error.
void connect_falcon(FalconLink& link, const std::string& firmware_file);

/// For the guardian: sends zeros until two of them were answered. The baud rate is set first, since a chip that was
/// plugged in again has lost it. False if no answer comes.
bool zero_falcon(FalconLink& link) noexcept;

class FalconProtocol final : public Protocol {
 public:
  explicit FalconProtocol(const FalconSettings& settings);

  void connect(Link& link) override;
  void receive(std::span<const std::uint8_t> packet, double now) noexcept override;
  std::size_t step(const Vec3& force, double now, std::span<std::uint8_t> packet) noexcept override;
  const ProtocolStatus& status() const noexcept override { return status_; }

 private:
  void take(const FalconReply& reply, double now) noexcept;
  void fail(LinkFault fault) noexcept;

  FalconSettings settings_;
  ProtocolStatus status_;
  FalconReplies replies_;
  Vec3 robot_position_{0};
  PoseDoubt doubt_{1e6};    // at the edge of the reach, valid and impossible poses alternate
  double doubt_began_ = 0;  // s
  double doubted_ = 0;      // s: of the last pose in doubt
  LockStep exchange_;
};

}  // namespace palpate::device
