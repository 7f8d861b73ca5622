#pragma once

/// The Falcon's kinematics as in libnifalcon (BSD), written independently of the driver's, so that a wrong sign or
/// scale in the driver shows on the fake.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "device/stylus.h"

namespace palpate::device {

/// Encoder counts, not rounded, of a grip position (m, the Falcon's frame: z out of the body). Nothing if it is out of
/// reach.
std::optional<std::array<double, 3>> public_falcon_counts(const Vec3& position);
/// N on the grip for motor commands at a position; by finite differences of the above, since libnifalcon's Jacobian is
/// wrong.
Vec3 public_falcon_force(const Vec3& position, const std::array<int, 3>& motors, double gain);

/// Sixteen bytes between '<' and '>': three numbers, lowest four bits first, then flags.
std::array<std::uint8_t, 16> public_falcon_packet(const std::array<int, 3>& numbers, std::uint8_t flags);
struct PublicFalconPacket {
  std::array<int, 3> numbers{};
  std::uint8_t flags = 0;
};
std::optional<PublicFalconPacket> read_public_falcon_packet(std::span<const std::uint8_t> bytes);

}  // namespace palpate::device
