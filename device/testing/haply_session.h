#pragma once

/// The Haply's protocol message by message, with answers set by the test.

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/haply/haply_driver.h"
#include "device/testing/fake_haply.h"

namespace palpate::device {

/// A session with answers set by the test.
struct HaplySession {
  FakeHaply service;
  FakeHaplyLink link{service};
  HaplyProtocol protocol;
  std::vector<std::uint8_t> packet = std::vector<std::uint8_t>(1 << 16);

  explicit HaplySession(const HaplySettings& settings = {}) : protocol(settings) { protocol.connect(link); }
  void answer(const nlohmann::json& message) {
    const std::string text = message.dump();
    protocol.receive({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, service.time);
  }
  /// The next message; null if none is due.
  nlohmann::json step(const Vec3& force = Vec3(0)) {
    const std::size_t size = protocol.step(force, service.time, packet);
    return size == 0 ? nlohmann::json()
                     : nlohmann::json::parse(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
  }
  const ProtocolStatus& status() const { return protocol.status(); }
};

inline nlohmann::json vector_json(const Vec3& v) {
  return {{"x", v.x}, {"y", v.y}, {"z", v.z}};
}

/// The service's state for its arm at this place with this acting force.
inline nlohmann::json arm_at(const Vec3& place, const Vec3& acting = Vec3(0)) {
  const nlohmann::json arm{
      {"device_id", "049D"},
      {"state", {{"cursor_position", vector_json(place)}, {"current_cursor_force", vector_json(acting)}}},
      {"status", {{"calibrated", true}, {"ready", true}}}};
  return {{"inverse3", nlohmann::json::array({arm})}};
}

/// The message of a refusal; empty if there is none.
inline std::string refused(const std::function<void()>& run) {
  try {
    run();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace palpate::device
