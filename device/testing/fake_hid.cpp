#include "device/testing/fake_hid.h"

#include <algorithm>

namespace palpate::device {

std::size_t FakeHidLink::receive(std::span<std::uint8_t> packet, double timeout) noexcept {
  const double end = timeout > 0 ? bench_.time + std::max(timeout, 1e-6) : bench_.time;
  while (!bench_.unplugged) {
    if (const auto size = device_.read(packet, bench_.time)) return *size;
    if (bench_.time >= end) return 0;
    bench_.time = std::min(bench_.time + 50e-6, end);
  }
  bench_.time = end;
  return 0;
}

bool FakeHidLink::send(std::span<const std::uint8_t> packet) noexcept {
  if (bench_.unplugged || !bench_.takes) return false;
  device_.write(packet, bench_.time);
  return true;
}

}  // namespace palpate::device
