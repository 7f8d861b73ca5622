#include "device/wooden_haptics/wooden_haptics_driver.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

#include "device/messages.h"
#include "device/vectors.h"

namespace palpate::device {

namespace {

constexpr std::size_t report_2016 = 8;
constexpr std::size_t report_hid = 14;
constexpr std::size_t report_teensy = 64;
constexpr int set_encoders = 1;
constexpr int button_pressed = 1;
// haptikfabrikenapi's host reads the stylus's button off the fourth encoder (src/fsusbhapticdevicethread.cpp): 10000 is
// added to its counts, and a gimbal has fewer than 5000.
constexpr int pressed_counts = 5000;
constexpr double start_time = 0.010;  // s of silence after which the firmware waits for us
constexpr double bounce_time = 0.1;   // s: pressed again so soon after the homing, its button bounced in the home pose
// An arm is in reach of its origin; its home pose lies outside the workspace.
constexpr double reach_in_radii = 3;

int word(std::span<const std::uint8_t> packet, std::size_t index) {
  return static_cast<std::int16_t>(packet[2 * index] | packet[2 * index + 1] << 8);
}

/// No body can turn half round.
bool could_be(const Vec3& angles) {
  constexpr double half_a_turn = std::numbers::pi;
  return std::abs(angles.x) < half_a_turn && std::abs(angles.y) < half_a_turn && std::abs(angles.z) < half_a_turn;
}

void put_word(std::span<std::uint8_t> packet, std::size_t index, int value) {
  const auto bits = static_cast<std::uint16_t>(value);
  packet[2 * index] = static_cast<std::uint8_t>(bits & 0xffU);
  packet[2 * index + 1] = static_cast<std::uint8_t>(bits >> 8U);
}

}  // namespace

void WoodenHapticsProtocol::connect(Link& link) {
  const std::uint64_t news = status_.news;
  status_ = {};
  status_.state = State::homing;
  status_.news = news;
  report_size_ = 0;
  calibrated_ = keeps_home_;
  button_ = started_ = false;
  exchange_.restart();
  starts_ = 0;
  doubt_.forget();
  std::array<std::uint8_t, 64> packet{};
  const double start = link.now();
  while (report_size_ == 0) {
    if (link.lost() || link.now() - start > 1.0) {
      throw Refusal(link.lost() ? say("woodenhaptics-at-it-was-unplugged", settings_.address)
                                : say("woodenhaptics-at-it-sends-no-reports", settings_.address));
    }
    const std::size_t size = link.receive(packet, 1e-3);
    if (size > 0) receive(std::span(packet).first(size), link.now());
    const std::size_t due = step(Vec3(0), link.now(), packet);
    if (due > 0) link.send(std::span(packet).first(due));
  }
  keeps_home_ = false;
  if ((report_size_ == report_2016) != settings_.short_reports) {
    throw Refusal(say("woodenhaptics-at-it-sends-reports-of-bytes", settings_.address, report_size_, settings_.preset));
  }
}

void WoodenHapticsProtocol::disconnected(bool lost) noexcept {
  keeps_home_ = !lost && calibrated_ && status_.state == State::idle;
}

std::array<int, 3> WoodenHapticsProtocol::within_load(std::array<int, 3> milliamperes, double elapsed) noexcept {
  const SustainedLimit limit{settings_.continuous_current, settings_.current_limit};
  double factor = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double asked = 1e-3 * std::abs(milliamperes[i]);
    if (asked > 0) factor = std::min(factor, loads_[i].allowed(limit) / asked);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    milliamperes[i] = static_cast<int>(factor * milliamperes[i]);
    loads_[i].add(limit, 1e-3 * milliamperes[i], elapsed);
  }
  return milliamperes;
}

void WoodenHapticsProtocol::receive(std::span<const std::uint8_t> packet, double now) noexcept {
  const bool known = packet.size() == report_2016 || packet.size() == report_hid || packet.size() == report_teensy;
  if (!known || (report_size_ != 0 && packet.size() != report_size_)) {
    if (report_size_ == 0) return;
    exchange_.answered(1, now);  // an answer all the same
    status_.doubtful = true;
    return;
  }
  const std::array<int, 3> counts{word(packet, 0), word(packet, 1), word(packet, 2)};
  if (report_size_ == 0 && packet.size() == report_2016 && !keeps_home_) {
    // No button: the arm was opened in its home pose.
    for (std::size_t i = 0; i < 3; ++i) offset_[i] = settings_.home_counts[i] - counts[i];
    calibrated_ = true;
  }
  report_size_ = packet.size();
  exchange_.answered(1, now);
  if (packet.size() != report_2016) {
    status_.buttons = settings_.stylus_button && word(packet, 3) > pressed_counts ? 1 : 0;
    const bool pressed = word(packet, 6) == button_pressed;
    // The latch is cleared by the counters being set: from then on they count from home.
    if (button_ && !pressed) {
      calibrated_ = true;
      offset_ = {};
      homed_ = now;
    }
    button_ = pressed;
  }
  take(counts, now);
}

void WoodenHapticsProtocol::take(const std::array<int, 3>& counts, double now) noexcept {
  if (status_.state == State::fault) return;
  // The counters are set under the hand, wherever it is. In mid-session that is no home.
  if (button_ && status_.state == State::idle && now - homed_ > bounce_time) return fail(LinkFault::unhomed);
  if (!calibrated_ || button_) {
    if (exchange_.is_current()) ++status_.news;
    status_.state = State::homing;
    return;
  }
  if (!exchange_.is_current()) {
    status_.doubtful = true;
    return;
  }
  std::array<int, 3> homed{};
  for (std::size_t i = 0; i < 3; ++i) homed[i] = counts[i] + offset_[i];
  const Vec3 angles = wooden_haptics_angles(settings_, homed);
  const Vec3 position = wooden_haptics_position(settings_, angles);
  if (!could_be(angles) || glm::length(position) > reach_in_radii * settings_.workspace_radius) {
    if (doubt_.lasts(now)) fail(LinkFault::unreachable_pose);
    status_.doubtful = true;
    return;
  }
  doubt_.ends(now);
  status_.doubtful = false;
  ++status_.news;
  angles_ = angles;
  status_.position = position;
  status_.state = State::idle;
}

void WoodenHapticsProtocol::fail(LinkFault fault) noexcept {
  status_.state = State::fault;
  status_.fault = fault;
}

std::size_t WoodenHapticsProtocol::step(const Vec3& force, double now, std::span<std::uint8_t> packet) noexcept {
  if (!started_) {
    started_ = true;
    sent_ = now;
  }
  const bool is_due = report_size_ != 0 ? exchange_.is_due(now) : now - sent_ >= start_time;
  if (!is_due) return 0;
  // Before the first report its length is not known: both kinds of firmware are offered theirs in turn.
  const std::size_t size = report_size_ != 0 ? report_size_ : (starts_++ % 4 == 3 ? report_2016 : report_hid);
  std::fill(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size), std::uint8_t{0});
  const bool is_current = report_size_ != 0 && exchange_.is_current();
  status_.withheld = !is_current || button_ || status_.state != State::idle;
  if (is_current && button_) {
    // In a fault, too: that clears the latch, so that the next session does not take it for a press in the home pose.
    put_word(packet, 3, set_encoders);
    for (std::size_t i = 0; i < 3; ++i) put_word(packet, 4 + i, settings_.home_counts[i]);
  } else if (is_current && status_.state == State::idle) {
    const Vec3 torques = wooden_haptics_torques(settings_, angles_, clamp_length(force, settings_.maximum_force));
    const std::array<int, 3> currents = within_load(wooden_haptics_currents(settings_, torques), now - sent_);
    for (std::size_t i = 0; i < 3; ++i) put_word(packet, i, currents[i]);
  }
  if (report_size_ != 0) exchange_.sent(now);
  sent_ = now;
  return size;
}

std::unique_ptr<LinkStylus> make_wooden_haptics_on(const WoodenHapticsSettings& settings,
                                                   LinkStylus::LinkMaker make_link, const LinkStylusOptions& options) {
  check(settings);
  Specification specification;
  specification.name = "WoodenHaptics";
  specification.workspace_half_extent = Vec3(settings.workspace_radius);
  specification.position_resolution = 0.064e-3;
  specification.maximum_force = settings.maximum_force;
  specification.continuous_force = settings.maximum_force / 2;
  specification.stiffness_limit = settings.stiffness_limit;
  return std::make_unique<LinkStylus>(specification, std::make_unique<WoodenHapticsProtocol>(settings),
                                      std::move(make_link), options);
}

}  // namespace palpate::device
