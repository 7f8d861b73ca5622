#include "palpate/device/internal/fakes/fake_space_mouse.h"

#include <algorithm>

namespace palpate::device {

std::optional<std::size_t> FakeSpaceMouse::read(std::span<std::uint8_t> report, double now) {
  std::fill(report.begin(), report.end(), std::uint8_t{0});
  if (buttons_ != reported_buttons_) {
    reported_buttons_ = buttons_;
    report[0] = 3;
    for (std::size_t i = 0; i < 4; ++i) report[1 + i] = static_cast<std::uint8_t>(buttons_ >> (8 * i));
    return 5;
  }
  if (now < next_ || (deflection_ == Vec3(0) && reported_ == Vec3(0))) return std::nullopt;
  next_ = now + 8e-3;
  reported_ = deflection_;
  report[0] = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const int value = static_cast<int>(deflection_[static_cast<int>(i)]);
    report[1 + 2 * i] = static_cast<std::uint8_t>(value & 0xff);
    report[2 + 2 * i] = static_cast<std::uint8_t>((value >> 8) & 0xff);
  }
  // Rotation that must not be mistaken for anything else.
  if (together_) std::fill(report.begin() + 7, report.begin() + 13, std::uint8_t{0x55});
  return together_ ? 13 : 7;
}

}  // namespace palpate::device
