#pragma once

#include "device/link/hid.h"
#include "device/link/link_stylus.h"
#include "device/link/protocol.h"
#include "device/space_mouse/space_mouse.h"

namespace palpate::device {

extern const HidKind space_mouse_hid;

/// The same stylus as make_space_mouse()'s, on any link.
std::unique_ptr<LinkStylus> make_space_mouse_on(const SpaceMouseSettings& settings, LinkStylus::LinkMaker make_link,
                                                const LinkStylusOptions& options);

class SpaceMouseProtocol final : public Protocol {
 public:
  explicit SpaceMouseProtocol(const SpaceMouseSettings& settings) : settings_(settings) {}

  void connect(Link& link) override;
  void receive(std::span<const std::uint8_t> packet, double now) noexcept override;
  std::size_t step(const Vec3& force, double now, std::span<std::uint8_t> packet) noexcept override;
  const ProtocolStatus& status() const noexcept override { return status_; }
  /// A puck at rest sends nothing.
  double longest_silence() const noexcept override;

 private:
  SpaceMouseSettings settings_;
  ProtocolStatus status_;
  Vec3 deflection_{0};  // -1 to 1, device's axes
  double time_ = 0;
  double told_ = 0;  // s: the time of the last report of motion
};

}  // namespace palpate::device
