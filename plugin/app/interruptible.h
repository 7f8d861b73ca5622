#pragma once

/// Ctrl-C as a wish to end in good order.

#include <csignal>

namespace palpate::plugin {

/// While it lives, SIGINT and SIGTERM only say that they came. One at a time.
class Interruptible {
 public:
  Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
  ~Interruptible();

  /// Whether one came since the last Interruptible began.
  static bool interrupted() noexcept;

 private:
  struct sigaction interrupt_before_ {};
  struct sigaction terminate_before_ {};
};

}  // namespace palpate::plugin
