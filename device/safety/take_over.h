#pragma once

#include <functional>

#include "device/safety/guardian_watch.h"

namespace palpate::device {

/// The guardian's tries to take the force from a session that stands still, look by look: until one succeeds, or the
/// session goes on.
class TakeOver {
 public:
  /// s of vain tries after which the user is asked to switch the device off. The tries go on.
  static constexpr double unreachable_after_s = 0.5;
  enum class Result : std::uint8_t { nothing_new, zeroed, unreachable };

  explicit TakeOver(std::function<bool()> try_once) : try_once_(std::move(try_once)) {}
  /// After every look at which `watch` says stopped(). `now`: s.
  Result look(const GuardianWatch& watch, double now);

 private:
  std::function<bool()> try_once_;
  bool zeroed_ = false, told_ = false;
  double began_ = 0, next_ = 0;  // s
};

}  // namespace palpate::device
