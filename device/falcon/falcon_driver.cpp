#include "device/falcon/falcon_driver.h"

#include <algorithm>
#include <cmath>

#include "device/setting_limits.h"
#include "device/vectors.h"

namespace palpate::device {

namespace {

// A hand at the edge of the reach trembles in and out of it with 8 to 12 Hz. A doubt that took the force away lasts
// until the hand has been inside for longer than a period of that.
constexpr double brief_doubt = 0.020;   // s
constexpr double settling_time = 0.15;  // s
const Vec3 newton_start(0, 0, 0.11);    // m: from here Newton's method reaches every pose of the workspace

}  // namespace

FalconProtocol::FalconProtocol(const FalconSettings& settings) : settings_(settings) {}

void FalconProtocol::connect(Link& link) {
  connect_falcon(dynamic_cast<FalconLink&>(link), settings_.firmware_file);
  const std::uint64_t news = status_.news;
  status_ = {};
  status_.state = State::homing;
  status_.news = news;
  replies_ = {};
  robot_position_ = newton_start;
  exchange_.restart();
  doubt_.forget();
}

void FalconProtocol::receive(std::span<const std::uint8_t> packet, double now) noexcept {
  const std::uint64_t before = replies_.received();
  const std::optional<FalconReply> reply = replies_.feed(packet);
  exchange_.answered(replies_.received() - before, now);
  if (reply) take(*reply, now);
}

void FalconProtocol::take(const FalconReply& reply, double now) noexcept {
  if (status_.state == State::fault) return;
  // The grip: 1 plus, 2 forward, 4 centre, 8 minus. The centre is under the thumb: it is the first button, too.
  constexpr unsigned first = 1, centre = 4;
  status_.buttons = reply.buttons | ((reply.buttons & centre) != 0 ? first : 0);
  const bool homed = std::all_of(reply.homed.begin(), reply.homed.end(), [](bool leg) { return leg; });
  if (!homed) {
    if (status_.state != State::homing) return fail(LinkFault::unhomed);
    // Counts mean nothing before; the pose stays where it was.
    if (exchange_.is_current()) ++status_.news;
    return;
  }
  if (!exchange_.is_current()) {
    status_.doubtful = true;
    return;
  }
  Vec3 angles;
  for (int leg = 0; leg < 3; ++leg) {
    angles[leg] = settings_.geometry.angle_at_zero +
                  reply.encoders[static_cast<std::size_t>(leg)] * settings_.geometry.angle_per_count;
  }
  const std::optional<Vec3> position = falcon_position(settings_.geometry, angles, robot_position_);
  if (!position) {
    if (doubt_.lasts(now)) fail(LinkFault::unreachable_pose);
    if (!status_.doubtful) doubt_began_ = now;
    doubted_ = now;
    status_.doubtful = true;
    return;
  }
  doubt_.ends(now);
  const bool is_brief = doubted_ - doubt_began_ < brief_doubt;
  if (is_brief || now - doubted_ > settling_time) status_.doubtful = false;
  robot_position_ = *position;
  status_.position = *position - Vec3(0, 0, settings_.geometry.center);
  status_.state = State::idle;
  ++status_.news;
}

void FalconProtocol::fail(LinkFault fault) noexcept {
  status_.state = State::fault;
  status_.fault = fault;
}

std::size_t FalconProtocol::step(const Vec3& force, double now, std::span<std::uint8_t> packet) noexcept {
  if (!exchange_.is_due(now)) return 0;
  // The same force at the motors is another one at the grip where the grip has moved on.
  const bool may_push = exchange_.is_current() && status_.state == State::idle;
  FalconCommand command;
  command.lights = status_.state == State::idle ? falcon_green : falcon_red;
  const auto torques =
      may_push ? falcon_torques(settings_.geometry, robot_position_, clamp_length(force, settings_.maximum_force))
               : std::nullopt;
  if (torques) command.motors = falcon_motors(*torques, settings_.motor_gain);
  status_.withheld = !torques;
  const auto bytes = encode(command);
  std::copy(bytes.begin(), bytes.end(), packet.begin());
  exchange_.sent(now);
  return bytes.size();
}

Text wrong_gain(const FalconSettings& settings) {
  return wrong_calibration("motor_gain", settings.motor_gain, FalconSettings().motor_gain);
}

Specification falcon_specification(const FalconSettings& settings) {
  Specification specification;
  specification.name = "Novint Falcon";
  specification.workspace_half_extent = Vec3(0.04);  // all of this cube can be reached; of a 10 cm one 1.3 % cannot
  specification.position_resolution = 0.035e-3;
  specification.maximum_force = settings.maximum_force;
  specification.continuous_force = settings.maximum_force / 2;
  specification.stiffness_limit = settings.stiffness_limit;
  return specification;
}

std::unique_ptr<LinkStylus> make_falcon_on(const FalconSettings& settings, LinkStylus::LinkMaker make_link,
                                           const LinkStylusOptions& options) {
  check_limits("Novint Falcon", settings, {.force_n = falcon_force});
  if (const Text wrong = wrong_gain(settings); !wrong.empty()) throw Refusal(at_place("Novint Falcon", wrong));
  return std::make_unique<LinkStylus>(falcon_specification(settings), std::make_unique<FalconProtocol>(settings),
                                      std::move(make_link), options);
}

}  // namespace palpate::device
