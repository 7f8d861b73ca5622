#include "device/testing/fake_space_mouse.h"

#include <algorithm>

namespace palpate::device {

HidIdentity FakeSpaceMouse::identity() const {
  // A multi-axis controller. Report 1: X, Y, Z, and on newer pucks Rx, Ry, Rz. On others these are report 2.
  std::vector<std::uint8_t> descriptor{0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, 0x16, 0xa2, 0xfe, 0x26, 0x5e,
                                       0x01, 0x75, 0x10, 0x85, 0x01, 0x09, 0x30, 0x09, 0x31, 0x09, 0x32};
  descriptor.reserve(96);  // without it GCC 14 warns of an overflow
  const auto append = [&](std::initializer_list<std::uint8_t> items) {
    descriptor.insert(descriptor.end(), items.begin(), items.end());
  };
  if (!together_) append({0x95, 0x03, 0x81, 0x02, 0x85, 0x02});
  append({0x09, 0x33, 0x09, 0x34, 0x09, 0x35});
  append({0x95, static_cast<std::uint8_t>(together_ ? 6 : 3), 0x81, 0x02});
  // Report 3: 32 buttons. Report 4, an output: the light.
  append({0x85, 0x03, 0x05, 0x09, 0x19, 0x01, 0x29, 0x20, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x20, 0x81, 0x02});
  append({0x85, 0x04, 0x05, 0x08, 0x09, 0x4b, 0x75, 0x08, 0x95, 0x01, 0x91, 0x02, 0xc0});
  if (together_) return {0x256f, 0xc635, "SpaceMouse Compact", descriptor, true};
  return {0x046d, 0xc626, "SpaceNavigator", descriptor, true};
}

std::optional<std::size_t> FakeSpaceMouse::read(std::span<std::uint8_t> report, double now) {
  std::fill(report.begin(), report.end(), std::uint8_t{0});
  if (buttons_ != reported_buttons_) {
    reported_buttons_ = buttons_;
    ++report_count_;
    report[0] = 3;
    for (std::size_t i = 0; i < 4; ++i) report[1 + i] = static_cast<std::uint8_t>(buttons_ >> (8 * i));
    return 5;
  }
  if (now < next_ || (deflection_ == Vec3(0) && reported_ == Vec3(0))) return std::nullopt;
  next_ = now + 8e-3;
  reported_ = deflection_;
  if (loses_zero && deflection_ == Vec3(0)) return std::nullopt;
  ++report_count_;
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
