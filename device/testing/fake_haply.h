#pragma once

/// Haply's service according to its documents: an inventory first, then one state for each message; x right, y away
/// from the user, z up. Written only from the documents, independently of the driver. In the same process it runs on a
/// clock that advances only during waits; haply_server.h puts it behind a real socket.

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "device/haply/haply_driver.h"

namespace palpate::device {

/// An event of the service's own safety checks: "ebrake_triggered", "ebrake_released", "stall_detected", ...
std::string haply_safety_event(const std::string& type, const std::string& id = "049D");

struct FakeHaply {
  double time = 0;  ///< s, in the same process
  HaplyVersion version{3, 5};
  std::string spelling = "vector";  ///< the key of a force's components that this service reads; 3.1 reads "values"
  std::vector<std::string> ids{"049D"};
  std::string type = "inverse3";
  Vec3 place{0};  ///< m
  bool has_grip = true;
  std::uint32_t buttons = 2;  ///< of the grip, below 8: bit 0 is "a"
  bool ready = true;
  double idle_after = 0.05;  ///< s without a message until the device goes idle
  double delay = 0.3e-3;     ///< s until an answer comes

  bool calibrated = true;
  bool tells_status = true;         ///< in its answers; its inventory always has it
  Vec3 others_force{0};             ///< N: of another program's session
  bool heeds = true;                ///< whether it applies forces
  std::vector<std::string> events;  ///< in the same process: sent between the answers

  bool silent = false, gone = false, garbles = false, halves = false, loses_device = false;
  int garbles_every = 0;  ///< every n-th answer is invalid

  nlohmann::json first_message;
  int messages = 0;
  int torques = 0;                                        ///< commands other than forces
  double largest_n = 0;                                   ///< largest commanded force
  std::vector<std::pair<double, std::string>> to_client;  ///< in the same process: time and text

  /// The first message to a new session.
  std::string inventory() const;
  /// Handles a message of a session and returns the answer.
  std::string answer(int session, const std::string& text, double now);
  /// The force that acts now, N in the service's frame: the sum over the sessions. Zero if the device is idle or
  /// unplugged.
  Vec3 acting(double now) const;
  /// Ends a session and its force.
  void leave(int session) { commands_.erase(session); }

 private:
  struct Command {
    Vec3 force{0};
    double time = 0;
  };
  std::string state(double now) const;

  std::map<int, Command> commands_;
};

/// The service in the same process.
class FakeHaplyLink final : public HaplyLink {
 public:
  explicit FakeHaplyLink(FakeHaply& service, int session = 0);
  ~FakeHaplyLink() override { service_.leave(session_); }

  HaplyVersion version() const noexcept override { return service_.version; }
  bool hears_events() const noexcept override { return true; }
  double now() noexcept override { return service_.time; }
  bool lost() const noexcept override { return service_.gone; }
  bool flush(double /*timeout*/) noexcept override { return !service_.gone; }
  bool send(std::span<const std::uint8_t> packet) noexcept override;
  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override;

 private:
  FakeHaply& service_;
  int session_;
};

}  // namespace palpate::device
