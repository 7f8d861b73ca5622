#pragma once

/// A driver made of a protocol and the link that carries its packets.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "device/link/driver.h"
#include "device/link/link.h"

namespace palpate::device {

/// Opens the device; throws std::runtime_error naming it and what to do.
using LinkMaker = std::function<std::unique_ptr<Link>()>;

class PacketDriver final : public Driver {
 public:
  PacketDriver(std::unique_ptr<Protocol> protocol, LinkMaker make_link);

  void connect() override;
  void disconnect() noexcept override;
  void forget_home() noexcept override { protocol_->forget_home(); }
  double now() noexcept override { return link_->now(); }
  void take(double timeout) noexcept override;
  ForceAnswer give(const Vec3& force) noexcept override;
  void flush(double timeout) noexcept override { link_->flush(timeout); }
  bool lost() const noexcept override { return link_->lost(); }
  const ProtocolStatus& status() const noexcept override { return protocol_->status(); }
  double longest_silence() const noexcept override { return protocol_->longest_silence(); }
  void describe(Specification& specification) const override { protocol_->describe(specification); }

 private:
  std::unique_ptr<Protocol> protocol_;
  LinkMaker make_link_;
  std::unique_ptr<Link> link_;
  std::vector<std::uint8_t> packet_;
};

}  // namespace palpate::device
