#pragma once

/// Limits a motor's current, or a force, by the heat in its windings (I^2 t): it may stay above its continuous value
/// only for a time.

namespace palpate::device {

struct SustainedLimit {
  double continuous = 0;  ///< continuous current (A) or force (N) of the motor; 0: unknown, no limit
  double peak = 0;        ///< the same unit: what it can bear for `time`
  double time = 4;        ///< s
};

/// The heat of one motor above its steady state at the continuous value: the integral of I²t.
class SustainedLoad {
 public:
  /// The largest current or force allowed now. It falls smoothly to the continuous value as the heat nears its limit.
  double allowed(const SustainedLimit& limit) const noexcept;
  /// Adds the heat of a current or force of this size that lasted `elapsed` s.
  void add(const SustainedLimit& limit, double size, double elapsed) noexcept;

 private:
  double heat_ = 0;  // unit^2 s above continuous^2
};

}  // namespace palpate::device
