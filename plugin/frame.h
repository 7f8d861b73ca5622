#pragma once

/// One tick as it is shown, charted and recorded. Plain values: written by the servo, read by everybody else.

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace palpate::plugin {

/// Where a tick's time went, in this order.
enum class Stage : std::uint8_t { read, step, filter, write, observe };
constexpr std::size_t stage_count = 5;

/// What one primitive did to the proxy. Device frame.
struct Share {
  std::uint64_t frame = 0;  ///< index of the frame
  std::uint32_t mode = 0;   ///< index into the scene's modes
  std::uint32_t type = 0;   ///< solver::PrimitiveType
  double strength_n = 0;    ///< N
  double force_n[3] = {};   ///< N, on the proxy
};

/// Device frame: m, N, s.
struct Frame {
  std::uint64_t index = 0;
  double time_s = 0;  ///< since the session began, on the device's clock
  double dt_s = 0;
  double probe_m[3] = {};
  double proxy_m[3] = {};
  double force_n[3] = {};    ///< of the coupling, before the safety filter
  double sent_n[3] = {};     ///< what the device was fed
  double value = 0;          ///< of the scan at the proxy; NaN outside
  double residual_n = 0;     ///< |equation (7)| with each primitive's share, which is defined on a constraint too
  double error_bound_m = 0;  ///< |proxy - exact proxy| is at most this
  std::uint32_t scene_epoch = 0;
  std::uint32_t sub_steps = 0;
  std::uint32_t iterations = 0;
  std::uint32_t solver = 0;   ///< solver::SolverKind of the last sub-step
  std::uint32_t outcome = 0;  ///< solver::Outcome of the last sub-step
  std::uint32_t safety = 0;   ///< the safety filter's state and cause
  std::uint32_t share_count = 0;
  std::uint32_t buttons = 0;     ///< of the stylus, as a bit mask
  std::uint32_t from_brick = 0;  ///< 1: the last sub-step's gradient was ready; 0: it was computed at the sample
  std::uint32_t stage_ns[stage_count] = {};  ///< the only fields that depend on the clock
};
static_assert(sizeof(Frame) == 8 + 17 * 8 + (9 + stage_count) * 4,
              "no padding: frames are compared and written as bytes");

}  // namespace palpate::plugin
