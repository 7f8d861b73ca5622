#include "device/testing/fake_haply.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

namespace palpate::device {

namespace {

using Json = nlohmann::json;

Json vector(const Vec3& v) {
  return {{"x", v.x}, {"y", v.y}, {"z", v.z}};
}

std::string vector_text(const Vec3& v) {
  std::array<char, 120> text{};
  char* at = text.data();
  const auto add = [&](const char* key, double value) {
    at = std::copy_n(key, std::strlen(key), at);
    at = std::isfinite(value) ? std::to_chars(at, text.data() + text.size(), value).ptr : std::copy_n("null", 4, at);
  };
  add(R"({"x":)", v.x);
  add(R"(,"y":)", v.y);
  add(R"(,"z":)", v.z);
  return std::string(text.data(), at) + "}";
}

/// A quarter turn about the service's z. `buttons`: bit 0 is "a".
Json grip(std::uint32_t buttons) {
  return {{"device_id", "61576"},
          {"state",
           {{"buttons", {{"a", (buttons & 1) != 0}, {"b", (buttons & 2) != 0}, {"c", (buttons & 4) != 0}}},
            {"orientation", {{"w", std::sqrt(0.5)}, {"x", 0.0}, {"y", 0.0}, {"z", std::sqrt(0.5)}}}}}};
}

Json grips(bool any, std::uint32_t buttons) {
  return any ? Json::array({grip(buttons)}) : Json::array();
}

}  // namespace

std::string haply_safety_event(const std::string& type, const std::string& id) {
  return Json{{"name", "device-safety-triggered"},
              {"category", "device"},
              {"level", "error"},
              {"data", {{"device_family", "inverse"}, {"device_id", id}, {"safety_type", type}}},
              {"message", type}}
      .dump();
}

std::string FakeHaply::inventory() const {
  Json list = Json::array();
  for (const std::string& id : ids) {
    list.push_back({{"device_id", id},
                    {"config",
                     {{"type", type},
                      {"handedness", "right"},
                      {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 1.0}}},
                      {"torque_scaling", {{"enabled", true}}},
                      {"filters", {{"force_gate", {{"gain", 0.3}}}, {"damping", {{"scalar", 0.0}}}}}}},
                    {"state", {{"cursor_position", vector(place)}}},
                    {"status", {{"calibrated", calibrated}, {"ready", ready}}}});
  }
  return Json{{"session_id", 7}, {"inverse3", list}, {"wireless_verse_grip", grips(has_grip, buttons)}}.dump();
}

// Not through a tree of JSON: a session asks a thousand times a second.
std::string FakeHaply::state(double now) const {
  static const std::array<std::string, 8> with_grip = [] {
    std::array<std::string, 8> made;
    for (std::uint32_t n = 0; n < made.size(); ++n) made[n] = grips(true, n).dump();
    return made;
  }();
  std::string text = R"({"inverse3":[)";
  if (!loses_device && !ids.empty()) {
    text += R"({"device_id":")" + ids.front() + R"(","state":{"cursor_position":)" + vector_text(place) +
            R"(,"current_cursor_force":)" + vector_text(acting(now)) + "}";
    const auto word = [](bool holds) { return holds ? "true" : "false"; };
    if (tells_status) {
      text += std::string(R"(,"status":{"calibrated":)") + word(calibrated) + R"(,"ready":)" + word(ready) + "}";
    }
    text += "}";
  }
  return text + R"(],"wireless_verse_grip":)" + (has_grip ? with_grip.at(buttons) : "[]") + "}";
}

std::string FakeHaply::answer(int session, const std::string& text, double now) {
  const Json message = Json::parse(text);
  if (messages++ == 0) first_message = message;
  Command command{Vec3(0), now};
  const Json& told = message.at("inverse3").at(0).at("commands");
  for (const auto& one : told.items()) {
    if (one.key() != "set_cursor_force") {
      ++torques;
    } else if (one.value().contains(spelling)) {
      const Json& v = one.value().at(spelling);
      command.force = {v.at("x").get<double>(), v.at("y").get<double>(), v.at("z").get<double>()};
    }
  }
  commands_[session] = command;
  largest_n = std::max(largest_n, glm::length(command.force));
  const bool is_nonsense = garbles || (garbles_every > 0 && messages % garbles_every == 0);
  std::string said = is_nonsense ? "{\"inverse3\": nonsense" : state(now);
  if (halves) said.resize(said.size() / 2);
  return said;
}

Vec3 FakeHaply::acting(double now) const {
  Vec3 sum = others_force;
  if (!heeds) return sum;
  for (const auto& [session, command] : commands_) {
    if (now - command.time <= idle_after) sum += command.force;
  }
  return sum;
}

FakeHaplyLink::FakeHaplyLink(FakeHaply& service, int session) : service_(service), session_(session) {
  service.to_client = {{service.time, service.inventory()}};
}

bool FakeHaplyLink::send(std::span<const std::uint8_t> packet) noexcept {
  if (service_.gone) return false;
  // A service that says nothing may still hear.
  const std::string said = service_.answer(session_, {packet.begin(), packet.end()}, service_.time);
  constexpr double at_least = 50e-6;  // s: an answer in no time would let no time go by
  service_.to_client.emplace_back(service_.time + std::max(service_.delay, at_least), said);
  return true;
}

std::size_t FakeHaplyLink::receive(std::span<std::uint8_t> packet, double timeout) noexcept {
  const double end = service_.time + timeout;
  for (;;) {
    if (!service_.events.empty()) {
      const std::string text = service_.events.front();
      service_.events.erase(service_.events.begin());
      std::copy(text.begin(), text.end(), packet.begin());
      return text.size();
    }
    auto& waiting = service_.to_client;
    if (!service_.silent && !waiting.empty() && waiting.front().first <= service_.time) {
      const std::string text = waiting.front().second;
      waiting.erase(waiting.begin());
      std::copy(text.begin(), text.end(), packet.begin());
      return text.size();
    }
    if (service_.time >= end) return 0;
    service_.time = std::min(service_.time + 50e-6, end);
  }
}

}  // namespace palpate::device
