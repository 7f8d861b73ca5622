#include "device/falcon/falcon_protocol.h"

#include <algorithm>
#include <cmath>

#include "device/vectors.h"

namespace palpate::device {

namespace {

constexpr std::uint8_t letter_of_zero = 0x41;

/// A word is four letters, the least significant nibble first.
void put_word(std::uint8_t* letters, int value) {
  const auto bits = static_cast<std::uint16_t>(value);
  for (int i = 0; i < 4; ++i) letters[i] = static_cast<std::uint8_t>(letter_of_zero + ((bits >> (4 * i)) & 15));
}

std::optional<int> take_word(const std::uint8_t* letters) {
  std::uint16_t bits = 0;
  for (int i = 0; i < 4; ++i) {
    const int nibble = letters[i] - letter_of_zero;
    if (nibble < 0 || nibble > 15) return std::nullopt;
    bits = static_cast<std::uint16_t>(bits | nibble << (4 * i));
  }
  return static_cast<std::int16_t>(bits);
}

}  // namespace

std::array<std::uint8_t, falcon_packet_size> encode(const FalconCommand& command) noexcept {
  std::array<std::uint8_t, falcon_packet_size> packet{};
  packet.front() = '<';
  for (std::size_t i = 0; i < 3; ++i) {
    put_word(&packet[1 + 4 * i], std::clamp(command.motors[i], -falcon_motor_limit, falcon_motor_limit));
  }
  packet[13] = static_cast<std::uint8_t>(letter_of_zero + (command.homing ? 1 : 0) + (command.lights & 0x0e));
  packet[14] = letter_of_zero;
  packet.back() = '>';
  return packet;
}

std::optional<FalconReply> decode_falcon_reply(std::span<const std::uint8_t> packet) noexcept {
  if (packet.size() != falcon_packet_size || packet.front() != '<' || packet.back() != '>') return std::nullopt;
  FalconReply reply;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<int> count = take_word(&packet[1 + 4 * i]);
    if (!count) return std::nullopt;
    reply.encoders[i] = *count;
  }
  const int flags = packet[13] - letter_of_zero;
  if (flags < 0 || flags > 0x7f) return std::nullopt;
  reply.buttons = static_cast<std::uint32_t>(flags & 15);
  for (std::size_t i = 0; i < 3; ++i) reply.homed[i] = ((flags >> (4 + i)) & 1) != 0;
  return reply;
}

std::optional<FalconReply> FalconReplies::feed(std::span<const std::uint8_t> bytes) noexcept {
  std::optional<FalconReply> newest;
  for (const std::uint8_t byte : bytes) {
    tail_[tail_size_++] = byte;
    // Every start that cannot become a packet is dropped, so that a stray '<' never hides the packet after it.
    while (tail_size_ > 0) {
      if (tail_.front() == '<' && tail_size_ < falcon_packet_size) break;
      if (const auto reply = decode_falcon_reply(std::span(tail_).first(tail_size_))) {
        newest = reply;
        ++received_;
        tail_size_ = 0;
        break;
      }
      std::copy(tail_.begin() + 1, tail_.begin() + static_cast<std::ptrdiff_t>(tail_size_), tail_.begin());
      --tail_size_;
      ++garbled_bytes_;
    }
  }
  return newest;
}

std::array<int, 3> falcon_motors(const Vec3& torques, double gain) noexcept {
  const Vec3 commands = -gain * torques;
  if (!is_finite(commands)) return {};
  double largest = 0;
  for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(commands[i]));
  const double factor = largest > falcon_motor_limit ? falcon_motor_limit / largest : 1;
  std::array<int, 3> motors{};
  for (int i = 0; i < 3; ++i) motors[static_cast<std::size_t>(i)] = static_cast<int>(std::lround(factor * commands[i]));
  return motors;
}

}  // namespace palpate::device
