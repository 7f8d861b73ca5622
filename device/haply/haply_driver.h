#pragma once

#include <array>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/haply/haply.h"
#include "device/link/link_stylus.h"
#include "device/link/lock_step.h"

namespace palpate::device {

/// s that the service has for each answer while a link to it is opened, and then for its first message.
constexpr double haply_patience = 2.0;

/// The service's version, from GET /version.
struct HaplyVersion {
  int major = 0;  ///< 0: not reported
  int minor = 0;
};
HaplyVersion parse_haply_version(std::string_view reply) noexcept;

/// The WebSockets of the service: a packet is an answer, or an event of the service.
class HaplyLink : public Link {
 public:
  virtual HaplyVersion version() const noexcept = 0;
  /// Whether the service's events arrive as packets between the answers.
  virtual bool hears_events() const noexcept = 0;
};

/// A device in the first message that the service sends.
struct HaplyDevice {
  std::string id;
  std::string type;  ///< "inverse3", "inverse3x", "minverse"
  std::string handedness;
  bool gravity_compensated = false;
  double force_gate = 0;  ///< filters.force_gate.gain
  double damping = 0;     ///< filters.damping.scalar
  bool torque_scaled = false;
  bool calibrated = true;  ///< from its status; true if that does not say
  bool ready = true;
};
/// Empty if the text is not an inventory.
std::vector<HaplyDevice> haply_inventory(std::string_view message);
/// The settings of the device that change what the hand feels, in a sentence.
std::string describe(const HaplyDevice& device);

/// The same stylus as make_haply()'s, on any link.
std::unique_ptr<LinkStylus> make_haply_on(const HaplySettings& settings, LinkMaker make_link,
                                          const LinkStylusOptions& options);

/// One message, one answer. A force lasts until the next message; without messages the device goes idle.
class HaplyProtocol final : public Protocol {
 public:
  explicit HaplyProtocol(const HaplySettings& settings) : settings_(settings) {}

  void connect(Link& link) override;
  void receive(std::span<const std::uint8_t> packet, double now) noexcept override;
  std::size_t step(const Vec3& force, double now, std::span<std::uint8_t> packet) noexcept override;
  const ProtocolStatus& status() const noexcept override { return status_; }
  std::size_t packet_size() const noexcept override { return 1 << 16; }
  void describe(Specification& specification) const override;
  /// N, the service's frame: the acting force that the service last reported. Nothing before its first report.
  const std::optional<Vec3>& acting_force() const noexcept { return acting_; }

 private:
  void choose(const std::vector<HaplyDevice>& devices);
  std::string first_message() const;
  void take_event(const nlohmann::json& event);
  void judge_force(const Vec3& acting) noexcept;
  double foreign_force(const Vec3& acting) const noexcept;
  void fail(LinkFault fault) noexcept;

  HaplySettings settings_;
  ProtocolStatus status_;
  HaplyDevice device_;
  bool had_home_ = false;              // since it was connected
  bool has_grip_ = false;              // a VerseGrip, which reports its orientation
  const char* vector_key_ = "vector";  // of 3.5; 3.1 says "values"
  bool switched_key_ = false;
  LockStep exchange_;
  bool hears_events_ = true;
  // N, the service's frame: the last forces sent, the newest first. The service reports the acting force late.
  std::array<Vec3, 4> sent_forces_{};
  std::optional<Vec3> acting_;
  int unheeded_ = 0;       // successive answers that report no force although one was sent
  int foreign_ = 0;        // successive answers that report a force that was not sent
  bool on_trial_ = false;  // the service has not applied the last forces
  bool resumes_ = false;   // it applies them again
};

}  // namespace palpate::device
