#pragma once

/// A Falcon as seen through its protocol: serial chip, boot loader, firmware, three arms and a hand on the grip. It is
/// independent of the transport that mounts it, which also gives the time.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "device/testing/fake_hand.h"
#include "device/testing/public_falcon.h"

namespace palpate::device {

struct FakeFalconOptions {
  bool firmware_loaded = true;
  bool homed = false;
  std::vector<std::uint8_t> image;   ///< the only accepted firmware
  bool greeting_after_zero = false;  ///< a 00 before the greeting, as some USB stacks report it
  double motor_gain = 10000;
  double friction = 0.06;      ///< N, of the arms
  std::vector<Waypoint> path;  ///< of the hand, m in the device's frame; empty: out, in and then at rest
};

/// Faults; may be changed while it runs.
struct FakeFalconFaults {
  bool silent = false;            ///< gives no answers
  double reply_delay = 0;         ///< s in addition to a reply's normal delay
  std::size_t most_payload = 62;  ///< bytes in one USB packet: below 16 every reply is split
  int garble_every = 0;           ///< every n-th reply has a damaged byte
  int drop_every = 0;             ///< every n-th reply is lost
  bool impossible_pose = false;   ///< encoders that no Falcon can have
  bool home_lost = false;         ///< as after switching it off and on
  bool odd_start = false;         ///< answers the start of an upload with another letter
  int corrupt_echoes = 0;         ///< this many of the upload's echoes have a wrong bit
};

class FakeFalcon {
 public:
  explicit FakeFalcon(const FakeFalconOptions& options = {});

  // The USB side. Vendor request; bulk OUT 0x02; bulk IN 0x81: the packet that would complete now, status bytes first.
  void control(std::uint8_t request, std::uint16_t value, double now);
  void write(std::span<const std::uint8_t> bytes, double now);
  std::optional<std::size_t> read(std::span<std::uint8_t> packet, double now);

  /// Unplugged: its serial chip, which is powered by the bus, loses its settings. The arms have their own power.
  void lose_usb();

  FakeFalconFaults faults;

  // The state of the arms. Whether a real Falcon has a watchdog is unknown: this one holds its last command for ever.
  const std::array<int, 3>& motors() const noexcept { return motors_; }
  const Vec3& force() const noexcept { return force_; }                ///< N on the grip
  const Vec3& strongest_force() const noexcept { return strongest_; }  ///< N: the largest so far
  bool is_pushing() const noexcept { return motors_ != std::array<int, 3>{}; }
  double pushed_until() const noexcept { return pushed_until_; }  ///< s: time of the last non-zero command
  const FakeHand& hand() const noexcept { return hand_; }
  FakeHand& hand() noexcept { return hand_; }
  bool firmware_runs() const noexcept { return firmware_loaded_ && baud_ == 2; }
  std::uint64_t commands() const noexcept { return commands_; }
  int uploads() const noexcept { return uploads_; }
  int packets_with_other_size() const noexcept { return odd_reads_; }

 private:
  void boot_byte(std::uint8_t byte, double now);
  void run(const PublicFalconPacket& command, double now);
  Vec3 grip() const;  // m, the Falcon's frame
  void reply(std::span<const std::uint8_t> bytes, double now);
  std::array<double, 3> true_counts() const;

  FakeFalconOptions options_;
  FakeHand hand_;

  std::uint16_t baud_ = 0x4138;
  double latency_ = 0.016;
  bool dtr_ = false;
  bool firmware_loaded_;
  bool in_boot_loader_ = false;
  bool loading_ = false;
  std::vector<std::uint8_t> received_;

  struct Byte {
    std::uint8_t value;
    double ready;
  };
  std::deque<Byte> to_host_;
  double last_in_ = 0;

  std::vector<std::uint8_t> command_bytes_;
  std::array<int, 3> motors_{};
  Vec3 force_{0};
  Vec3 strongest_{0};
  std::array<bool, 3> homed_{};
  std::array<bool, 3> was_out_{};
  std::uint64_t commands_ = 0;
  int uploads_ = 0;
  int odd_reads_ = 0;
  double pushed_until_ = 0;
};

}  // namespace palpate::device
