#pragma once

/// A haptic stylus, in its own frame: x to the user's right, y up, z towards the user; meters, newtons, seconds.

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>

#include "device/safety/on_device.h"
#include "solver/text/message.h"

namespace palpate::device {

using Vec3 = glm::dvec3;

/// What a stylus can do; constant while it is open.
struct Specification {
  std::string name;
  int position_axes = 3;           ///< degrees of freedom sensed
  int force_axes = 3;              ///< degrees of freedom actuated; 0 for a pointing device
  int orientation_axes = 0;        ///< degrees of freedom sensed beside the position
  Vec3 workspace_half_extent{0};   ///< m, about the origin
  double position_resolution = 0;  ///< m: one step of the position
  double maximum_force = 0;        ///< N, peak
  double continuous_force = 0;     ///< N, sustained
  double stiffness_limit = 0;      ///< N/m: a stiffer wall may ring
  double rate = 1000;              ///< Hz
  std::string watchdog;            ///< the part of this device that takes the force away; empty: DeviceType::watchdog
  std::string guardian;            ///< its guardian's reach, in words; empty: there is none
};

enum class State : std::uint8_t { disconnected, idle, homing, ramping, active, fault };
const char* name_of(State state);

struct Reading {
  double time = 0;   ///< s since the stylus was opened, on the device's own clock
  Vec3 position{0};  ///< m
  std::uint32_t buttons = 0;
  bool fresh = false;                  ///< whether the position is new since the previous read
  glm::dquat orientation{1, 0, 0, 0};  ///< of the stylus, if the device senses it
};

/// The force on a device as its link knows it. What was asked for may be another one.
struct ForceOnDevice {
  OnDevice state = OnDevice::unknown;
  double newtons = 0;  ///< its length; while the device takes none, or it is unknown, that of the last one it took
  bool is_held_back = false;  ///< less is given than was asked for, as in the ramp after a zero; heat does not count
};

class Stylus {
 public:
  Stylus() = default;
  Stylus(const Stylus&) = delete;
  Stylus& operator=(const Stylus&) = delete;
  virtual ~Stylus() = default;

  virtual Specification specification() const = 0;
  /// Throws std::runtime_error naming the device and what to do.
  virtual void open() = 0;
  /// Zero force, then closed. Never throws; may be called twice.
  virtual void close() noexcept = 0;
  /// The newest pose. Called in the tick: does not throw or allocate. If the device is lost, state() is State::fault.
  virtual Reading read() noexcept = 0;
  /// N. Only the safety filter's output may be written.
  virtual void write_force(const Vec3& force) noexcept = 0;
  virtual State state() const noexcept = 0;
  /// While state() is State::fault: what happened and what to do, in a sentence. Empty if it is not known. Not for the
  /// tick.
  virtual Text trouble() const { return {}; }
  /// N: the largest force that it gives now, which falls while its motors are warm. For any thread.
  virtual double allowed_force() const noexcept { return std::numeric_limits<double>::infinity(); }
  /// None: what was written acts. For any thread; its parts may be of two exchanges.
  virtual std::optional<ForceOnDevice> force_on_device() const noexcept { return {}; }
};

}  // namespace palpate::device
