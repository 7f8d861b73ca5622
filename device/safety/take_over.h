#pragma once

#include <functional>

#include "device/safety/guardian_watch.h"

namespace palpate::device {

/// The guardian's attempts to take the force from a session that is stopped, one at each poll: until one succeeds, or
/// the session goes on.
class TakeOver {
 public:
  /// s of failed attempts after which the user is asked to switch the device off. The attempts go on.
  static constexpr double unreachable_after_s = 0.5;
  enum class Result : std::uint8_t { nothing_new, zeroed, unreachable };

  explicit TakeOver(std::function<bool()> try_once) : try_once_(std::move(try_once)) {}
  /// Call it after every poll at which `watch` is stopped(). `now`: s.
  Result look(const GuardianWatch& watch, double now);

 private:
  std::function<bool()> try_once_;
  bool zeroed_ = false, told_ = false;
  double began_ = 0, next_ = 0;  // s
};

}  // namespace palpate::device
