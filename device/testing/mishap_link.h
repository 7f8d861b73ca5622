#pragma once

#include <functional>
#include <utility>

#include "device/testing/fake_falcon_link.h"

namespace palpate::device {

using Packet = std::span<const std::uint8_t>;

/// A Falcon's serial chip with an event that happens during a write.
class MishapLink final : public FalconLink {
 public:
  MishapLink(FakeFalconBench& bench, std::function<bool(Packet)> takes)
      : bench_(bench), link_(bench), takes_(std::move(takes)) {}

  double now() noexcept override { return link_.now(); }
  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    return link_.receive(packet, timeout);
  }
  bool send(Packet packet) noexcept override { return takes_(packet) && link_.send(packet); }
  bool flush(double timeout) noexcept override { return link_.flush(timeout); }
  bool lost() const noexcept override { return link_.lost(); }
  bool control(std::uint8_t request, std::uint16_t value) noexcept override {
    return !bench_.unplugged && link_.control(request, value);
  }

 private:
  FakeFalconBench& bench_;
  FakeFalconLink link_;
  std::function<bool(Packet)> takes_;
};

}  // namespace palpate::device
