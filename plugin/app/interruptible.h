#pragma once

/// Ctrl-C as a request to end properly.

#include <csignal>

namespace palpate::plugin {

/// While this object exists, SIGINT and SIGTERM only set a flag. Only one may exist at a time.
class Interruptible {
 public:
  Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
  ~Interruptible();

  /// Whether one of these signals has come since the latest Interruptible was made.
  static bool interrupted() noexcept;

 private:
  struct sigaction interrupt_before_ {};
  struct sigaction terminate_before_ {};
};

}  // namespace palpate::plugin
