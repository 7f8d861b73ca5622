#pragma once

/// The record of one tick, as it is shown, charted and recorded. Plain values: the servo writes them, all others read
/// them.

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace palpate::plugin {

/// The parts of a tick's time, in this order. `observe` makes the record itself; it samples the proxy's new place for
/// this tick and the next, so that `sample` is short.
enum class Stage : std::uint8_t { read, map, sample, modes, solve, filter, write, observe };
constexpr std::size_t stage_count = 8;
/// The most structures of a scene whose distances a tick records.
constexpr std::size_t distance_count = 8;
constexpr const char* stage_names[stage_count] = {"read",  "map",    "sample", "modes",
                                                  "solve", "filter", "write",  "observe"};

/// The effect of one primitive on the proxy. Device frame.
struct PrimitiveRecord {
  std::uint64_t tick = 0;  ///< index of the tick
  std::uint32_t mode = 0;  ///< index into the scene's modes; plus modes::of_scene_left if that scene is being left
  std::uint32_t type = 0;  ///< solver::PrimitiveType
  double strength_n = 0;   ///< N
  double force_n[3] = {};  ///< N, on the proxy
};

/// The commands to the session at a tick: bits of TickRecord::commands.
namespace command {
constexpr std::uint32_t arm = 1, disarm = 2, clear_fault = 4, change_stylus = 8;
}

/// Device frame: m, N, s.
struct TickRecord {
  std::uint64_t index = 0;
  double time_s = 0;  ///< since the session began, counted in deadlines and not by the clock
  double dt_s = 0;
  double pose_time_s = 0;  ///< of the pose, on the device's own clock
  double heartbeat_s = 0;  ///< time_s at which the controlling thread was last seen alive
  double probe_m[3] = {};
  double proxy_m[3] = {};
  double force_n[3] = {};    ///< of the coupling, before damping and the safety filter
  double sent_n[3] = {};     ///< the force sent to the device
  double value = 0;          ///< of the scan at the proxy; NaN outside
  double residual_n = 0;     ///< |equation (7)| with each primitive's share, which is defined on a constraint too
  double error_bound_m = 0;  ///< |proxy - exact proxy| is at most this
  double change_part = 1;    ///< the completed part of the change to this scene; 1: it is complete
  /// Of the proxy, from each structure that the scene reads (SceneRecord::structures), positive inside; NaN after
  /// the last of these structures.
  double distance_mm[distance_count] = {};
  std::uint32_t scene_epoch = 0;
  std::uint32_t sub_steps = 0;
  std::uint32_t halts = 0;
  std::uint32_t iterations = 0;
  std::uint32_t solver = 0;   ///< solver::SolverType::number, of the last sub-step
  std::uint32_t outcome = 0;  ///< solver::Outcome of the last sub-step
  std::uint32_t safety = 0;   ///< the safety filter's state and cause
  std::uint32_t share_count = 0;
  std::uint32_t buttons = 0;  ///< of the stylus and of the panel, as a bit mask
  std::uint32_t fresh = 0;    ///< 1: the pose is new in this tick
  std::uint32_t stylus_state = 0;
  std::uint32_t stylus_epoch = 0;  ///< counts the styluses held in this session
  std::uint32_t commands = 0;      ///< bits of namespace command that took effect in this tick
  // The rest depends on the clock or on other threads. No force depends on it.
  std::uint32_t from_brick = 0;  ///< 1: the last sub-step's gradient was ready; 0: it was computed in the tick
  std::uint32_t missed = 0;      ///< deadlines that passed without a tick since the previous tick
  std::uint32_t late_ns = 0;     ///< how long after its deadline this tick began
  std::uint32_t stage_ns[stage_count] = {};
};
static_assert(sizeof(TickRecord) == 8 + (20 + distance_count) * 8 + (16 + stage_count) * 4,
              "no padding: ticks are compared and written as bytes");

/// Whether two ticks are the same to the last bit in all that a replay repeats.
bool same_in_replay(const TickRecord& a, const TickRecord& b) noexcept;

/// A vector of a record.
inline glm::dvec3 vector_of(const double (&from)[3]) noexcept {
  return {from[0], from[1], from[2]};
}

}  // namespace palpate::plugin
