#include "device/testing/public_falcon.h"

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace palpate::device {

namespace {

// m: FalconGeometry.h's letters.
constexpr double a = 0.060, b = 0.1025, c = 0.01443, d = 0.01125, e = 0.01125, f = -0.025, r = 0.040, s = -0.02309;
constexpr double degree = std::numbers::pi / 180;
constexpr std::array<double, 3> phi{105 * degree, -15 * degree, -135 * degree};

double degrees_of_count(double count) {
  return 360 * count / (4 * 320) * (14.25 / 110) + 35;
}

/// theta1 of a leg, radians.
double first_angle(int leg, const Vec3& p) {
  const double turn = phi[static_cast<std::size_t>(leg)];
  const double u = std::cos(turn) * p.x + std::sin(turn) * p.y - r;
  const double v = -std::sin(turn) * p.x + std::cos(turn) * p.y - s;
  const double w = p.z;
  const double third = std::acos((v + f) / b);
  const double arm = d + e + b * std::sin(third);
  const double even = w * w + u * u + 2 * c * u + a * a + c * c - arm * arm;
  const double odd = 2 * a * u + 2 * a * c;
  const double l0 = even - odd;
  const double l1 = -4 * a * w;
  const double l2 = even + odd;
  return 2 * std::atan((-l1 - std::sqrt(l1 * l1 - 4 * l0 * l2)) / (2 * l2));
}

}  // namespace

std::optional<std::array<double, 3>> public_falcon_counts(const Vec3& position) {
  std::array<double, 3> counts{};
  for (int leg = 0; leg < 3; ++leg) {
    const double theta = first_angle(leg, position) / degree;
    if (!std::isfinite(theta)) return std::nullopt;
    counts[static_cast<std::size_t>(leg)] = (theta - degrees_of_count(0)) / (degrees_of_count(1) - degrees_of_count(0));
  }
  return counts;
}

Vec3 public_falcon_force(const Vec3& position, const std::array<int, 3>& motors, double gain) {
  constexpr double h = 1e-6;
  // A motor command is -gain x the torque on its arm; a torque does the work of the force: F = (d theta / d x)^T tau.
  Vec3 force(0);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 step(0);
    step[axis] = h;
    for (int leg = 0; leg < 3; ++leg) {
      const double turned = (first_angle(leg, position + step) - first_angle(leg, position - step)) / (2 * h);
      force[axis] += turned * -motors[static_cast<std::size_t>(leg)] / gain;
    }
  }
  return std::isfinite(force.x + force.y + force.z) ? force : Vec3(0);
}

std::array<std::uint8_t, 16> public_falcon_packet(const std::array<int, 3>& numbers, std::uint8_t flags) {
  std::array<std::uint8_t, 16> bytes{};
  bytes[0] = '<';
  for (std::size_t i = 0; i < 12; ++i) {
    const auto bits = static_cast<unsigned>(numbers[i / 4]) >> (4 * (i % 4));
    bytes[1 + i] = static_cast<std::uint8_t>(0x41 + (bits & 0xfU));
  }
  bytes[13] = static_cast<std::uint8_t>(0x41 + flags);
  bytes[14] = 0x41;
  bytes[15] = '>';
  return bytes;
}

std::optional<PublicFalconPacket> read_public_falcon_packet(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != 16 || bytes[0] != '<' || bytes[15] != '>') return std::nullopt;
  PublicFalconPacket packet;
  for (std::size_t i = 0; i < 3; ++i) {
    unsigned bits = 0;
    for (std::size_t n = 0; n < 4; ++n) {
      const unsigned nibble = bytes[1 + 4 * i + n] - 0x41U;
      if (nibble > 15) return std::nullopt;
      bits |= nibble << (4 * n);
    }
    packet.numbers[i] = static_cast<std::int16_t>(bits);
  }
  packet.flags = static_cast<std::uint8_t>(bytes[13] - 0x41);
  return packet;
}

}  // namespace palpate::device
