#include "device/testing/fake_falcon.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::device {

namespace {

constexpr std::uint16_t baud_9600 = 0x4138;
constexpr std::uint16_t baud_140k = 0x0015;
constexpr std::uint16_t baud_1500k = 0x0002;
constexpr double wire_time = 0.25e-3;  // s: 32 bytes at 1.5 Mbaud and the firmware's own time

// Before it is homed a Falcon counts from wherever it was switched on.
constexpr std::size_t packet_size = 16;
constexpr double center = 0.120;  // m along z: the middle of what the grip reaches
constexpr int unhomed_offset = 1234;
constexpr double out_count = 400;  // the index marks, passed on the way out and then on the way in
constexpr double in_count = 300;

const std::vector<Waypoint>& homing_path() {
  static const std::vector<Waypoint> path{{0.05, {0, 0, 0}}, {0.30, {0, 0, 0.039}}, {0.60, {0, 0, 0}}};
  return path;
}

ArmModel falcon_arm(double friction) {
  ArmModel arm;
  arm.coulomb_friction = friction;
  arm.mass = 0.1;
  arm.half_extent = Vec3(0.04);
  return arm;
}

}  // namespace

FakeFalcon::FakeFalcon(const FakeFalconOptions& options)
    : options_(options),
      hand_(falcon_arm(options.friction), HandModel{}, options.path.empty() ? homing_path() : options.path),
      firmware_loaded_(options.firmware_loaded) {
  homed_.fill(options.homed);
}

void FakeFalcon::control(std::uint8_t request, std::uint16_t value, double now) {
  switch (request) {
    case 0:
      if (value == 1 || value == 0) to_host_.clear();
      if (value == 2 || value == 0) command_bytes_.clear();
      break;
    case 1:
      if (value == 0x0101 && !dtr_ && baud_ == baud_9600) in_boot_loader_ = true;
      if ((value & 0xff00) == 0x0100) dtr_ = value == 0x0101;
      break;
    case 3:
      if (loading_ && value == baud_1500k) {
        firmware_loaded_ = received_ == options_.image && !received_.empty();
        in_boot_loader_ = loading_ = false;
      }
      if (value == baud_9600) {
        firmware_loaded_ = firmware_loaded_ && !in_boot_loader_;
        loading_ = false;
      }
      baud_ = value;
      break;
    case 9:
      latency_ = value * 1e-3;
      break;
    default:
      break;
  }
  last_in_ = std::max(last_in_, now - latency_);
}

void FakeFalcon::lose_usb() {
  baud_ = baud_9600;
  latency_ = 0.016;
  dtr_ = false;
  to_host_.clear();
  command_bytes_.clear();
}

void FakeFalcon::write(std::span<const std::uint8_t> bytes, double now) {
  if (faults.silent) return;
  for (const std::uint8_t byte : bytes) {
    if (in_boot_loader_) {
      boot_byte(byte, now);
      continue;
    }
    if (!firmware_runs()) continue;
    command_bytes_.push_back(byte);
    if (command_bytes_.front() != '<') command_bytes_.clear();
    if (command_bytes_.size() < packet_size) continue;
    if (const auto command = read_public_falcon_packet(command_bytes_)) run(*command, now);
    command_bytes_.clear();
  }
}

void FakeFalcon::boot_byte(std::uint8_t byte, double now) {
  if (baud_ == baud_9600) {
    received_.push_back(byte);
    const std::size_t n = received_.size();
    if (n >= 3 && received_[n - 3] == 0x0a && received_[n - 2] == 0x43 && byte == 0x0d) {
      received_.clear();
      if (options_.greeting_after_zero) reply(std::array<std::uint8_t, 1>{0}, now);
      reply(std::array<std::uint8_t, 4>{0x0a, 0x44, 0x2c, 0x0d}, now);
    }
  } else if (baud_ == baud_140k && !dtr_) {
    if (!loading_) {
      loading_ = byte == 'A';
      if (faults.odd_start) byte = 'B';
      received_.clear();
      ++uploads_;
    } else {
      received_.push_back(byte);
      if (faults.corrupt_echoes > 0) {
        --faults.corrupt_echoes;
        byte ^= 0x10U;
      }
    }
    reply(std::array<std::uint8_t, 1>{byte}, now);
  }
}

Vec3 FakeFalcon::grip() const {
  return hand_.body().position + Vec3(0, 0, center);
}

std::array<double, 3> FakeFalcon::true_counts() const {
  std::array<double, 3> counts = public_falcon_counts(grip()).value_or(std::array<double, 3>{});
  for (double& count : counts) count = std::round(count);
  return counts;
}

void FakeFalcon::run(const PublicFalconPacket& command, double now) {
  constexpr std::uint8_t homing_mode = 1;
  ++commands_;
  hand_.advance(now, force_);
  motors_ = command.numbers;
  if (is_pushing()) pushed_until_ = now;
  force_ = public_falcon_force(grip(), motors_, options_.motor_gain);
  if (glm::length(force_) > glm::length(strongest_)) strongest_ = force_;

  const std::array<double, 3> counts = true_counts();
  std::array<int, 3> answer{};
  std::uint8_t flags = static_cast<std::uint8_t>(hand_.buttons() & 15);
  for (std::size_t i = 0; i < 3; ++i) {
    if ((command.flags & homing_mode) == 0) homed_[i] = was_out_[i] = false;
    was_out_[i] = was_out_[i] || counts[i] >= out_count;
    homed_[i] = homed_[i] || (was_out_[i] && counts[i] <= in_count);
    answer[i] = static_cast<int>(counts[i]) + (homed_[i] ? 0 : unhomed_offset);
    if (faults.impossible_pose) answer[i] = i == 0 ? 4000 : -4000;
    if (homed_[i] && !faults.home_lost) flags = static_cast<std::uint8_t>(flags | 0x10 << i);
  }
  auto packet = public_falcon_packet(answer, flags);
  const auto nth = [&](int every) { return every > 0 && commands_ % static_cast<std::uint64_t>(every) == 0; };
  if (nth(faults.drop_every)) return;
  if (nth(faults.garble_every)) packet[commands_ % packet.size()] = 0xff;
  reply(packet, now);
}

void FakeFalcon::reply(std::span<const std::uint8_t> bytes, double now) {
  for (const std::uint8_t byte : bytes) to_host_.push_back({byte, now + wire_time + faults.reply_delay});
}

std::optional<std::size_t> FakeFalcon::read(std::span<std::uint8_t> packet, double now) {
  // Anything but 64 would lose bytes on the real chip.
  odd_reads_ += packet.size() == 64 ? 0 : 1;
  std::size_t ready = 0;
  while (ready < to_host_.size() && to_host_[ready].ready <= now) ++ready;
  if (faults.silent) ready = 0;
  const std::size_t most = std::min(faults.most_payload, packet.size() - 2);
  if (ready < most && now - last_in_ < latency_) return std::nullopt;
  last_in_ = now;
  packet[0] = 0x01;
  packet[1] = 0x60;
  const std::size_t payload = std::min(ready, most);
  for (std::size_t i = 0; i < payload; ++i) {
    packet[2 + i] = to_host_.front().value;
    to_host_.pop_front();
  }
  return payload + 2;
}

}  // namespace palpate::device
