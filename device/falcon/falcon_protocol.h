#pragma once

/// The Novint Falcon's packets, after the BSD-licensed libnifalcon: sixteen ASCII bytes each way, exactly one reply to
/// a command. They have no checksum, so every byte is checked against the values that it may have.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "device/stylus.h"

namespace palpate::device {

constexpr std::size_t falcon_packet_size = 16;
constexpr int falcon_motor_limit = 4096;  ///< the largest command that the firmware's documents allow

enum FalconLight : std::uint8_t { falcon_green = 0x02, falcon_blue = 0x04, falcon_red = 0x08 };

struct FalconCommand {
  std::array<int, 3> motors{};  ///< -4096 to 4096; larger values are clamped, never wrapped
  bool homing = true;           ///< if false is sent once, the Falcon loses its home position
  std::uint8_t lights = 0;      ///< FalconLight bits
};

struct FalconReply {
  std::array<int, 3> encoders{};  ///< counts, int16
  std::uint32_t buttons = 0;      ///< 1 plus, 2 forward, 4 center, 8 minus
  std::array<bool, 3> homed{};
};

std::array<std::uint8_t, falcon_packet_size> encode(const FalconCommand& command) noexcept;
/// Decodes one packet; nothing unless every byte is one that a Falcon sends.
std::optional<FalconReply> decode_falcon_reply(std::span<const std::uint8_t> packet) noexcept;

/// Finds replies in a stream that may be split, joined or garbled anywhere.
class FalconReplies {
 public:
  /// The newest whole reply that these bytes complete.
  std::optional<FalconReply> feed(std::span<const std::uint8_t> bytes) noexcept;
  std::uint64_t received() const noexcept { return received_; }
  std::uint64_t garbled_bytes() const noexcept { return garbled_bytes_; }

 private:
  std::array<std::uint8_t, falcon_packet_size> tail_{};
  std::size_t tail_size_ = 0;
  std::uint64_t received_ = 0;
  std::uint64_t garbled_bytes_ = 0;
};

/// Motor commands for arm torques (N m): -gain tau, all scaled by one factor if one of them passes the limit, so that
/// the force keeps its direction. Zeros if a torque is not finite.
std::array<int, 3> falcon_motors(const Vec3& torques, double gain) noexcept;

}  // namespace palpate::device
