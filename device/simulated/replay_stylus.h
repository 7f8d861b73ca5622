#pragma once

/// A stylus that returns given poses, one a tick, and is not moved by forces: for replaying a session.

#include <cstddef>
#include <span>

#include "device/stylus.h"

namespace palpate::device {

class ReplayStylus final : public Stylus {
 public:
  /// Does not copy: `readings` must outlive the stylus. They are returned unchanged, even if they are not fresh or not
  /// finite.
  explicit ReplayStylus(std::span<const Reading> readings, const Specification& recorded = {});
  /// The same with the state of each tick, so that a lost or homing stylus is repeated, too. Throws
  /// std::invalid_argument if there are not as many states as readings.
  ReplayStylus(std::span<const Reading> readings, std::span<const State> states, const Specification& recorded = {});

  Specification specification() const override { return specification_; }
  /// Starts at the first reading. Throws std::runtime_error if there is none.
  void open() override;
  void close() noexcept override;
  /// After the last reading it returns that one again, not fresh.
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
