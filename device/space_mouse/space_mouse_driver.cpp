#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <stdexcept>

#include "device/messages.h"
#include "device/space_mouse/space_mouse_driver.h"
#include "device/vectors.h"

namespace palpate::device {

namespace {

constexpr std::uint8_t motion_report = 1;
constexpr std::uint8_t rotation_report = 2;
constexpr std::uint8_t button_report = 3;
constexpr double report_patience = 0.15;  // s: a held puck sends a report every 8 to 16 ms
constexpr double longest_step = 0.05;     // s: limits the jump of the pose after a longer delay of the thread

double word(std::span<const std::uint8_t> bytes, std::size_t index) {
  return static_cast<std::int16_t>(bytes[2 * index] | bytes[2 * index + 1] << 8);
}

}  // namespace

bool is_space_mouse(unsigned vendor, unsigned product) noexcept {
  constexpr std::array<unsigned, 12> logitech{0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625,
                                              0xc626, 0xc627, 0xc628, 0xc629, 0xc62b, 0xc640};
  constexpr std::array<unsigned, 10> connexion{0xc62e, 0xc62f, 0xc631, 0xc632, 0xc633,
                                               0xc635, 0xc636, 0xc638, 0xc63a, 0xc652};
  if (vendor == 0x046d) return std::find(logitech.begin(), logitech.end(), product) != logitech.end();
  if (vendor == 0x256f) return std::find(connexion.begin(), connexion.end(), product) != connexion.end();
  return false;
}

void SpaceMouseProtocol::connect(Link& link) {
  const std::uint64_t news = status_.news;
  status_ = {};
  status_.state = State::idle;
  status_.news = news;
  deflection_ = Vec3(0);
  time_ = told_ = link.now();
}

void SpaceMouseProtocol::receive(std::span<const std::uint8_t> packet, double now) noexcept {
  if (packet.size() < 2) return;
  const std::uint8_t report = packet.front();
  const auto payload = packet.subspan(1);
  if (report == button_report) {
    status_.buttons = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(payload.size(), 4); ++i) {
      status_.buttons |= static_cast<std::uint32_t>(payload[i]) << (8 * i);
    }
    return;
  }
  // Translation alone (6 bytes), or with rotation behind it (12 bytes, newer and wireless pucks): the first six bytes
  // are the same. Rotation comes in a report of its own otherwise, and is not used.
  if (report == rotation_report || report != motion_report || payload.size() < 6) return;
  told_ = now;
  // The puck's x is right, its y towards the user, its z down.
  const Vec3 raw = Vec3(word(payload, 0), -word(payload, 2), word(payload, 1)) / settings_.full_deflection;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::min(std::abs(raw[axis]), 1.0);
    const double beyond = std::max(0.0, size - settings_.dead_zone) / (1 - settings_.dead_zone);
    deflection_[axis] = std::copysign(beyond, raw[axis]);
  }
}

std::size_t SpaceMouseProtocol::step(const Vec3& /*force*/, double now, std::span<std::uint8_t> /*packet*/) noexcept {
  const double elapsed = std::clamp(now - time_, 0.0, longest_step);
  time_ = now;
  // Its report of zeros may be lost: the pose must not drift on.
  if (now - told_ > report_patience) deflection_ = Vec3(0);
  status_.position = glm::clamp(status_.position + settings_.speed * elapsed * deflection_, -settings_.half_extent,
                                settings_.half_extent);
  ++status_.news;
  return 0;
}

double SpaceMouseProtocol::longest_silence() const noexcept {
  return std::numeric_limits<double>::infinity();
}

std::unique_ptr<LinkStylus> make_space_mouse_on(const SpaceMouseSettings& settings, LinkStylus::LinkMaker make_link,
                                                const LinkStylusOptions& options) {
  if (!(settings.speed > 0 && settings.dead_zone >= 0 && settings.dead_zone < 1 && settings.full_deflection > 0)) {
    throw Refusal(say("spacemouse-speed-and-full-deflection-must"));
  }
  Specification specification;
  specification.name = "SpaceMouse";
  specification.force_axes = 0;
  specification.workspace_half_extent = settings.half_extent;
  specification.position_resolution = settings.speed / settings.full_deflection * 1e-3;
  return std::make_unique<LinkStylus>(specification, std::make_unique<SpaceMouseProtocol>(settings),
                                      std::move(make_link), options);
}

}  // namespace palpate::device
