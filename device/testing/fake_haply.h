#pragma once

/// Haply's service as its documents have it: an inventory first, then one state for each message; x right, y away from
/// the user, z up. Written from the documents alone, apart from the driver. In the same process it runs on a clock that
/// moves only while somebody waits; haply_server.h puts it behind a real socket.

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "device/haply/haply_driver.h"

namespace palpate::device {

/// An event of the service's own safety: "ebrake_triggered", "ebrake_released", "stall_detected", ...
std::string haply_safety_event(const std::string& type, const std::string& id = "049D");

struct FakeHaply {
  double time = 0;  ///< s, in the same process
  HaplyVersion version{3, 5};
  std::string spelling = "vector";  ///< of a force's components: what this service reads; 3.1 reads "values"
  std::vector<std::string> ids{"049D"};
  std::string type = "inverse3";
  Vec3 place{0};  ///< m
  bool has_grip = true;
  bool ready = true;
  double idle_after = 0.05;  ///< s without a message: the device goes idle
  double delay = 0.3e-3;     ///< s until an answer comes

  bool calibrated = true;
  bool tells_status = true;         ///< in its answers; its inventory always does
  Vec3 others_force{0};             ///< N: of another program's session
  bool heeds = true;                ///< forces; where not, none acts
  std::vector<std::string> events;  ///< in the same process: to be heard between the answers

  bool silent = false, gone = false, garbles = false, halves = false, loses_device = false;
  int garbles_every = 0;  ///< each n-th answer is nonsense

  nlohmann::json first_message;
  int messages = 0;
  int torques = 0;                                        ///< commands other than a force
  double largest_n = 0;                                   ///< of the forces that it was told
  std::vector<std::pair<double, std::string>> to_client;  ///< in the same process: when, what

  /// What the service sends to a new session.
  std::string inventory() const;
  /// Takes a message of a session and returns the answer.
  std::string answer(int session, const std::string& text, double now);
  /// N in the service's frame, that acts now: the sum over the sessions. None from a device that is idle or gone.
  Vec3 acting(double now) const;
  /// A session's force goes with it.
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
