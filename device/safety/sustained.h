#pragma once

/// What a motor bears for long: the square of its current (or of a force) may stay above the continuous one only for a
/// time, as the heat in its windings does (I^2 t).

namespace palpate::device {

struct SustainedLimit {
  double continuous = 0;  ///< A or N that may last for ever; 0: not known, and nothing is limited
  double peak = 0;        ///< the same unit: what may last for `time`
  double time = 4;        ///< s
};

/// The heat of one motor above what leaves it by itself.
class SustainedLoad {
 public:
  /// The largest size allowed now. Approaches the continuous one smoothly as the heat comes to its limit.
  double allowed(const SustainedLimit& limit) const noexcept;
  /// This size was given for `elapsed` s.
  void add(const SustainedLimit& limit, double size, double elapsed) noexcept;

 private:
  double heat_ = 0;  // unit^2 s above continuous^2
};

}  // namespace palpate::device
