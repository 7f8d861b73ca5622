#pragma once

/// A stylus that reads back poses handed in, one a tick, and feels nothing: for replaying a session.

#include <cstddef>
#include <span>

#include "device/stylus.h"

namespace palpate::device {

class ReplayStylus final : public Stylus {
 public:
  /// Does not copy: `readings` must outlive the stylus. They are returned as they are, also what is not fresh or
  /// finite.
  explicit ReplayStylus(std::span<const Reading> readings, const Specification& recorded = {});
  /// The same with the state of each tick, as many as readings: also what was lost or homing is repeated. Throws
  /// std::invalid_argument where they are not as many.
  ReplayStylus(std::span<const Reading> readings, std::span<const State> states, const Specification& recorded = {});

  Specification specification() const override { return specification_; }
  /// Starts at the first reading. Throws std::runtime_error when there is none.
  void open() override;
  void close() noexcept override;
  /// After the last reading: that one, not fresh.
  Reading read() noexcept override;
  /// Kept for last_force(); the next read() is the next reading.
  void write_force(const Vec3& force) noexcept override;
  State state() const noexcept override;

  bool finished() const noexcept { return next_ >= readings_.size(); }
  const Vec3& last_force() const noexcept { return last_force_; }

 private:
  std::span<const Reading> readings_;
  std::span<const State> states_;
  Specification specification_;
  std::size_t next_ = 0;
  State state_ = State::disconnected;
  Vec3 last_force_{0};
};

}  // namespace palpate::device
