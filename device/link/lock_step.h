#pragma once

/// For a device that answers each command once and in turn: when the next command is due, and how old the pose in an
/// answer is. An answer does not say which command it belongs to, so answers are counted. An overdue answer is lost or
/// still on its way. If it were counted as lost and then came, every later pose would count as newer than it is. So
/// after a lost answer there is a pause, to wait for it.

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate::device {

struct LockStepTimes {
  double overdue = 0.020;       ///< s after which a command is repeated, and the pose in its answer is too old
  bool speaks_unasked = false;  ///< an answer without a command has a current pose
};

class LockStep {
 public:
  /// s: a missing answer counts as lost if it has not come within this time after another one. A longer time leaves the
  /// link without a pose for longer than Protocol::longest_silence().
  static constexpr double longest_way = 0.050;

  explicit LockStep(const LockStepTimes& times = {}) : times_(times) {}

  /// To be called when nothing was sent and no answer is expected.
  void restart() noexcept { *this = LockStep(times_); }
  /// Whether a command is due: the last one was answered, or is overdue.
  bool is_due(double now) noexcept;
  /// To be called when a command that was due has been sent.
  void sent(double now) noexcept;
  /// To be called when this many answers have come.
  void answered(std::uint64_t count, double now) noexcept;
  /// Whether the last answer is current: it and the one before it came in time, and none is missing. If not, the
  /// position of the hand is not known.
  bool is_current() const noexcept { return on_time_ >= enough_on_time; }

 private:
  static constexpr int enough_on_time = 2;

  LockStepTimes times_;
  std::array<double, 16> sent_{};  // s: commands without an answer, the oldest first
  std::size_t owed_ = 0;
  int on_time_ = 1;  // answers in a row
  double last_sent_ = 0;
  double last_answer_ = 0;
  bool misses_others_ = false;  // an answer came after another one was overdue
};

}  // namespace palpate::device
