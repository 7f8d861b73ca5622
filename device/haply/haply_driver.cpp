#include "device/haply/haply_driver.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "device/found_devices.h"
#include "device/messages.h"
#include "device/setting_limits.h"
#include "device/vectors.h"

namespace palpate::device {

namespace {

using Json = nlohmann::json;

constexpr double noticeable = 0.1;     // N: a force that the service must tell back
constexpr int unheeded_at_most = 100;  // answers
// A service that does not heed forces may begin to at any time: until it does it is asked for no more than this.
constexpr int unheeded_soon = 5;     // answers
constexpr double trial_force = 0.2;  // N
// Forces of several programs add up. The service's own filters take from a force, and add none.
constexpr double foreign_at_most = 0.5;      // N
constexpr int foreign_answers_at_most = 20;  // in a row
constexpr double farthest = 1.0;             // m: no arm reaches farther

/// Null where there is none.
const Json* at(const Json& json, const char* key) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  return found == json.end() ? nullptr : &*found;
}

template <typename... Keys>
const Json* at(const Json& json, const char* key, Keys... keys) {
  const Json* const inner = at(json, key);
  return inner == nullptr ? nullptr : at(*inner, keys...);
}

std::string text_of(const Json* json) {
  return json != nullptr && json->is_string() ? json->get<std::string>() : std::string();
}

double number_of(const Json* json, double otherwise = 0) {
  return json != nullptr && json->is_number() ? json->get<double>() : otherwise;
}

bool is_denied(const Json* json) {
  return json != nullptr && json->is_boolean() && !json->get<bool>();
}

bool is_true(const Json* json) {
  return json != nullptr && json->is_boolean() && json->get<bool>();
}

/// The service leaves out what is zero.
Vec3 vector_of(const Json& json) {
  return {number_of(at(json, "x")), number_of(at(json, "y")), number_of(at(json, "z"))};
}

// The service's frame: x right, y away from the user, z up.
Vec3 to_device_frame(const Vec3& service) {
  return {service.x, service.z, -service.y};
}
Vec3 to_service_frame(const Vec3& device) {
  return {device.x, -device.z, device.y};
}

/// The device of this id in a message; null where it is not in it.
const Json* find_device(const Json& message, const char* list, const std::string& id) {
  const Json* const devices = at(message, list);
  if (devices == nullptr || !devices->is_array()) return nullptr;
  const auto found = std::find_if(devices->begin(), devices->end(),
                                  [&](const Json& one) { return text_of(at(one, "device_id")) == id; });
  return found == devices->end() ? nullptr : &*found;
}

/// The first of a list of grips, which are told by no id that would tie them to an arm.
const Json* first_state(const Json& message, const char* list) {
  const Json* const grips = at(message, list);
  if (grips == nullptr || !grips->is_array() || grips->empty()) return nullptr;
  return at(grips->front(), "state");
}

std::uint32_t buttons_of(const Json& message) {
  std::uint32_t buttons = 0;
  if (const Json* const wireless = first_state(message, "wireless_verse_grip")) {
    constexpr std::array keys{"a", "b", "c"};
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (is_true(at(*wireless, "buttons", keys[i]))) buttons |= 1U << i;
    }
  }
  if (const Json* const wired = first_state(message, "verse_grip")) {
    const Json* const button = at(*wired, "button");
    if (is_true(button) || number_of(button) > 0) buttons |= 1U;
  }
  return buttons;
}

std::optional<glm::dquat> orientation_of(const Json& message) {
  for (const char* list : {"wireless_verse_grip", "verse_grip"}) {
    const Json* const state = first_state(message, list);
    const Json* const turn = state == nullptr ? nullptr : at(*state, "orientation");
    if (turn == nullptr) continue;
    const double w = number_of(at(*turn, "w"));
    const Vec3 axis = to_device_frame(vector_of(*turn));
    const glm::dquat orientation(w, axis.x, axis.y, axis.z);
    const double length = glm::length(orientation);
    if (std::isfinite(length) && std::abs(length - 1) < 0.1) return orientation / length;
  }
  return {};
}

/// Text into a packet that is large enough. Not printf's: a program in another language has another decimal point.
class TextInto {
 public:
  explicit TextInto(std::span<std::uint8_t> packet)
      : begin_(reinterpret_cast<char*>(packet.data())), at_(begin_), end_(begin_ + packet.size()) {}
  TextInto& add(std::string_view text) noexcept {
    const auto size = std::min(text.size(), static_cast<std::size_t>(end_ - at_));
    at_ = std::copy_n(text.begin(), size, at_);
    return *this;
  }
  TextInto& add(double value) noexcept {
    at_ = std::to_chars(at_, end_, value, std::chars_format::fixed, 5).ptr;
    return *this;
  }
  std::size_t size() const noexcept { return static_cast<std::size_t>(at_ - begin_); }

 private:
  char* begin_;
  char* at_;
  char* end_;
};

bool is_plain(const std::string& id) {
  return !id.empty() && std::all_of(id.begin(), id.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
}

}  // namespace

HaplyVersion parse_haply_version(std::string_view reply) noexcept {
  const Json json = Json::parse(reply, nullptr, false);
  const std::string text = text_of(at(json, "project_version"));
  HaplyVersion version;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, version.major);
  if (error != std::errc() || rest == end || *rest != '.') return {};
  if (std::from_chars(rest + 1, end, version.minor).ec != std::errc()) return {};
  return version;
}

std::vector<HaplyDevice> haply_inventory(std::string_view message) {
  std::vector<HaplyDevice> devices;
  const Json json = Json::parse(message, nullptr, false);
  const Json* const list = at(json, "inverse3");
  if (list == nullptr || !list->is_array()) return devices;
  for (const Json& one : *list) {
    HaplyDevice device;
    device.id = text_of(at(one, "device_id"));
    if (!is_plain(device.id)) continue;
    device.type = text_of(at(one, "config", "type"));
    device.handedness = text_of(at(one, "config", "handedness"));
    device.gravity_compensated = is_true(at(one, "config", "gravity_compensation", "enabled"));
    device.torque_scaled = is_true(at(one, "config", "torque_scaling", "enabled"));
    device.calibrated = !is_denied(at(one, "status", "calibrated"));
    device.ready = !is_denied(at(one, "status", "ready"));
    device.force_gate = number_of(at(one, "config", "filters", "force_gate", "gain"));
    device.damping = number_of(at(one, "config", "filters", "damping", "scalar"));
    devices.push_back(std::move(device));
  }
  return devices;
}

std::string describe(const HaplyDevice& device) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "the service's own settings change what is felt: gravity compensation %s, torque scaling %s, force "
                "gate %.2f, damping %.2f",
                device.gravity_compensated ? "on" : "off", device.torque_scaled ? "on" : "off", device.force_gate,
                device.damping);
  return text.data();
}

void HaplyProtocol::choose(const std::vector<HaplyDevice>& devices) {
  std::vector<HaplyDevice> matching = devices;
  std::erase_if(matching,
                [&](const HaplyDevice& one) { return !settings_.address.empty() && one.id != settings_.address; });
  if (matching.empty()) {
    throw Refusal(say("haply-its-service-runs-but-finds-no",
                      (settings_.address.empty() ? std::string() : " " + settings_.address)));
  }
  if (matching.size() > 1) {
    throw which_of("Haply", matching.size());
  }
  device_ = matching.front();
}

void HaplyProtocol::connect(Link& link) {
  const std::uint64_t news = status_.news;
  status_ = {};
  status_.state = State::homing;
  status_.news = news;
  vector_key_ = "vector";
  if (const auto* service = dynamic_cast<const HaplyLink*>(&link)) {
    const HaplyVersion version = service->version();
    const bool is_old = version.major == 3 && version.minor < 5;
    if (version.major > 3) {
      throw Refusal(say("haply-its-service-is-version", version.major));
    }
    vector_key_ = is_old ? "values" : "vector";
    hears_events_ = service->hears_events();
  }
  switched_key_ = on_trial_ = resumes_ = had_home_ = false;
  unheeded_ = foreign_ = 0;
  sent_forces_ = {};
  acting_.reset();
  std::vector<std::uint8_t> packet(packet_size());
  const double start = link.now();
  std::vector<HaplyDevice> devices;
  bool told = false;
  while (!told && !link.lost() && link.now() - start < haply_patience) {
    const std::size_t size = link.receive(packet, 0.01);
    const std::string_view message(reinterpret_cast<const char*>(packet.data()), size);
    told = size > 0 && message.find("\"inverse3\"") != std::string_view::npos;
    if (told) {
      devices = haply_inventory(message);
      has_grip_ = orientation_of(Json::parse(message, nullptr, false)).has_value();
    }
  }
  if (!told) {
    throw Refusal(say("haply-its-service-does-not-tell-which"));
  }
  choose(devices);
  const std::string message = first_message();
  link.send({reinterpret_cast<const std::uint8_t*>(message.data()), message.size()});
  exchange_.restart();
  exchange_.sent(link.now());
}

std::string HaplyProtocol::first_message() const {
  Json arm{{"device_id", device_.id},
           {"configure", {{"preset", settings_.preset}}},
           {"commands", {{"set_cursor_force", {{vector_key_, {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}}}}}}}};
  if (settings_.preset.empty()) arm.erase("configure");
  return Json{{"session", {{"configure", {{"profile", {{"name", "org.palpate:session"}}}}}}},
              {"inverse3", Json::array({arm})}}
      .dump();
}

void HaplyProtocol::describe(Specification& specification) const {
  const bool is_small = device_.type == "minverse";
  specification.name = is_small ? "Haply Minverse" : "Haply Inverse3";
  if (!hears_events_) {
    specification.watchdog = "the service ends a force that is not renewed; its emergency brake is not heard";
  }
  specification.orientation_axes = has_grip_ ? 3 : 0;
  specification.workspace_half_extent = Vec3(is_small ? 0.04 : 0.10) / std::sqrt(3.0);
}

void HaplyProtocol::fail(LinkFault fault) noexcept {
  if (status_.state == State::fault) return;
  status_.state = State::fault;
  status_.fault = fault;
}

/// Of the service's own safety. After its brake has held the arm nobody knows what lies beneath the hand: the force
/// comes back only when the user opens the device and turns it on.
void HaplyProtocol::take_event(const Json& event) {
  const Json* const data = at(event, "data");
  if (data == nullptr || text_of(at(event, "name")) != "device-safety-triggered") return;
  const std::string id = text_of(at(*data, "device_id")), what = text_of(at(*data, "safety_type"));
  const bool is_brake = what == "ebrake_triggered" || what == "ebrake_released";
  if (is_brake && (id.empty() || id == device_.id)) fail(LinkFault::own_safety);
}

void HaplyProtocol::receive(std::span<const std::uint8_t> packet, double now) noexcept {
  const Json message = Json::parse(packet.begin(), packet.end(), nullptr, false);
  if (at(message, "name") != nullptr) return take_event(message);
  exchange_.answered(1, now);
  if (!message.is_object() || status_.state == State::fault) return;
  const Json* const arm = find_device(message, "inverse3", device_.id);
  if (arm == nullptr) {
    // Half a message is none, but a whole one without the arm says that it is gone.
    if (message.contains("inverse3")) fail(LinkFault::unplugged);
    return;
  }
  // What is not told is as it was told before, first by the inventory.
  const auto keep = [&](const char* key, bool& value) {
    const Json* const told = at(*arm, "status", key);
    if (told != nullptr && told->is_boolean()) value = told->get<bool>();
  };
  keep("calibrated", device_.calibrated);
  keep("ready", device_.ready);
  // Calibrated anew it may have another frame under the same hand: the user opens it again. That it is not ready for a
  // moment, because it was asked late, changes nothing of that.
  if (had_home_ && !device_.calibrated) return fail(LinkFault::unhomed);
  status_.state = device_.calibrated && device_.ready ? State::idle : State::homing;
  had_home_ = had_home_ || status_.state == State::idle;
  const Json* const position = at(*arm, "state", "cursor_position");
  if (position == nullptr) return;
  const Vec3 place = to_device_frame(vector_of(*position));
  if (!is_finite(place) || glm::length(place) > farthest) return fail(LinkFault::unreachable_pose);
  status_.doubtful = !exchange_.is_current();
  status_.buttons = buttons_of(message);
  if (exchange_.is_current()) {
    status_.position = place;
    if (const auto orientation = orientation_of(message)) status_.orientation = *orientation;
    ++status_.news;
  }
  if (const Json* const force = at(*arm, "state", "current_cursor_force")) judge_force(vector_of(*force));
}

/// N: the distance from the nearest force that can be ours: one of the last, or a part of it.
double HaplyProtocol::foreign_force(const Vec3& acting) const noexcept {
  double least = glm::length(acting);
  for (const Vec3& sent : sent_forces_) {
    const double square = glm::dot(sent, sent);
    const double part = square > 0 ? std::clamp(glm::dot(acting, sent) / square, 0.0, 1.0) : 0;
    least = std::min(least, glm::distance(acting, part * sent));
  }
  return least;
}

void HaplyProtocol::judge_force(const Vec3& acting) noexcept {
  acting_ = acting;
  foreign_ = foreign_force(acting) > foreign_at_most ? foreign_ + 1 : 0;
  if (foreign_ >= foreign_answers_at_most) return fail(LinkFault::foreign_force);
  // Which of the two spellings the service reads is not certain from its version: it tells the force that acts.
  const double sent = glm::length(sent_forces_.front());
  const bool heeded = sent < noticeable || glm::length(acting) > 0.1 * sent;
  unheeded_ = heeded ? 0 : unheeded_ + 1;
  resumes_ = resumes_ || (heeded && on_trial_);
  on_trial_ = !heeded && (on_trial_ || unheeded_ >= unheeded_soon);
  if (unheeded_ < unheeded_at_most) return;
  if (switched_key_) return fail(LinkFault::forces_refused);
  switched_key_ = true;
  unheeded_ = 0;
  vector_key_ = vector_key_ == std::string_view("vector") ? "values" : "vector";
}

std::size_t HaplyProtocol::step(const Vec3& force, double now, std::span<std::uint8_t> packet) noexcept {
  if (!exchange_.is_due(now)) return 0;
  const bool may_push = exchange_.is_current() && status_.state == State::idle && !resumes_;
  const double most = on_trial_ ? std::min(trial_force, settings_.maximum_force) : settings_.maximum_force;
  const Vec3 sent = may_push ? to_service_frame(clamp_length(force, most)) : Vec3(0);
  std::shift_right(sent_forces_.begin(), sent_forces_.end(), 1);
  sent_forces_.front() = sent;
  TextInto text(packet);
  text.add("{\"inverse3\":[{\"device_id\":\"").add(device_.id);
  text.add("\",\"commands\":{\"set_cursor_force\":{\"").add(vector_key_);
  text.add("\":{\"x\":").add(sent.x).add(",\"y\":").add(sent.y);
  text.add(",\"z\":").add(sent.z).add("}}}}]}");
  exchange_.sent(now);
  status_.withheld = !may_push;
  status_.most_force = on_trial_ ? most : std::numeric_limits<double>::infinity();
  resumes_ = false;
  return text.size();
}

std::unique_ptr<LinkStylus> make_haply_on(const HaplySettings& settings, LinkMaker make_link,
                                          const LinkStylusOptions& options) {
  check_limits("Haply", settings, {});
  Specification specification;
  specification.name = "Haply Inverse3";
  specification.workspace_half_extent = Vec3(0.10) / std::sqrt(3.0);
  specification.position_resolution = 0.01e-3;
  specification.maximum_force = settings.maximum_force;
  specification.continuous_force = settings.maximum_force / 2;
  specification.stiffness_limit = settings.stiffness_limit;
  return std::make_unique<LinkStylus>(specification, std::make_unique<HaplyProtocol>(settings), std::move(make_link),
                                      options);
}

}  // namespace palpate::device
