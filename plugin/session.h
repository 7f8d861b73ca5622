#pragma once

/// The session that ties a scan, a scene and a stylus, stepped one tick at a time: read the pose, step the balance,
/// filter the force, write it, and leave a frame.

#include <array>
#include <memory>
#include <span>

#include "palpate/device/safety_filter.h"
#include "palpate/device/stylus.h"
#include "palpate/io/field_source.h"
#include "palpate/modes/haptic_step.h"
#include "palpate/modes/plan.h"
#include "palpate/plugin/frame.h"
#include "palpate/solver/chain.h"

namespace palpate::plugin {

class Session {
 public:
  /// Opens the stylus and arms the safety filter. The stylus has to outlive the session. Throws what Stylus::open()
  /// throws.
  Session(std::shared_ptr<const modes::Plan> plan, std::shared_ptr<const io::FieldSource> source,
          device::Stylus& stylus, const device::SafetyLimits& limits);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// Zero force, stylus closed.
  ~Session();

  /// One tick. Does not allocate, lock, log or throw.
  const Frame& tick() noexcept;
  /// What each primitive did in the last tick's last sub-step.
  std::span<const Share> shares() const noexcept { return {shares_.data(), frame_.share_count}; }
  device::Fault fault() const noexcept { return safety_.fault; }

 private:
  std::shared_ptr<const modes::Plan> plan_;
  std::shared_ptr<const io::FieldSource> source_;
  device::Stylus& stylus_;
  device::SafetyLimits limits_;
  device::SafetyState safety_;
  solver::Chain chain_;
  modes::Touch touch_;
  std::unique_ptr<modes::StepScratch> scratch_;
  Frame frame_;
  std::array<Share, modes::most_primitives> shares_{};
  std::uint64_t ticks_ = 0;
  double last_time_ = 0;
};

/// The safety filter's limits for a scene on a device: never above what the device can do.
device::SafetyLimits limits_for(const modes::Limits& scene, const device::Specification& device);

/// Frame::safety holds both.
constexpr std::uint32_t pack_safety(device::State state, device::Fault fault) {
  return static_cast<std::uint32_t>(state) | static_cast<std::uint32_t>(fault) << 8U;
}
constexpr device::State state_of(const Frame& frame) {
  return static_cast<device::State>(frame.safety & 0xFFU);
}
constexpr device::Fault fault_of(const Frame& frame) {
  return static_cast<device::Fault>(frame.safety >> 8U);
}

}  // namespace palpate::plugin
