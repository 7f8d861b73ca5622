#include "device/testing/fake_falcon_link.h"

#include <algorithm>
#include <array>

namespace palpate::device {

std::size_t FakeFalconLink::receive(std::span<std::uint8_t> packet, double timeout) noexcept {
  // A wait that is too short to change the clock would be waited for again and again.
  const double end = timeout > 0 ? bench_.time + std::max(timeout, 1e-6) : bench_.time;
  while (!bench_.unplugged) {
    std::array<std::uint8_t, 64> raw{};
    const auto size = bench_.falcon.read(raw, bench_.time);
    if (size && *size > 2) {
      const std::size_t payload = std::min(*size - 2, packet.size());
      std::copy_n(raw.begin() + 2, payload, packet.begin());
      return payload;
    }
    if (bench_.time >= end) return 0;
    bench_.time = std::min(bench_.time + 50e-6, end);
  }
  bench_.time = end;
  return 0;
}

bool FakeFalconLink::send(std::span<const std::uint8_t> packet) noexcept {
  if (bench_.unplugged) return false;
  bench_.falcon.write(packet, bench_.time);
  return true;
}

bool FakeFalconLink::flush(double /*timeout*/) noexcept {
  return !bench_.unplugged;
}

bool FakeFalconLink::control(std::uint8_t request, std::uint16_t value) noexcept {
  if (bench_.unplugged) return false;
  bench_.time += 0.2e-3;
  bench_.falcon.control(request, value, bench_.time);
  return true;
}

}  // namespace palpate::device
