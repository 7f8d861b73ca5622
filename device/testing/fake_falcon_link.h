#pragma once

/// The fake Falcon in the same process, on a clock that advances only during waits.

#include <memory>

#include "device/link/link.h"
#include "device/testing/fake_falcon.h"

namespace palpate::device {

/// The fake and its clock outlive the link, so a test can examine them after the driver has gone.
struct FakeFalconBench {
  explicit FakeFalconBench(const FakeFalconOptions& options = {}) : falcon(options) {}
  FakeFalcon falcon;
  double time = 0;  ///< s
  bool unplugged = false;
};

class FakeFalconLink final : public FalconLink {
 public:
  explicit FakeFalconLink(FakeFalconBench& bench) : bench_(bench) {}

  double now() noexcept override { return bench_.time; }
  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override;
  bool send(std::span<const std::uint8_t> packet) noexcept override;
  bool flush(double timeout) noexcept override;
  bool lost() const noexcept override { return bench_.unplugged; }
  bool control(std::uint8_t request, std::uint16_t value) noexcept override;

 private:
  FakeFalconBench& bench_;
};

}  // namespace palpate::device
