#pragma once

/// Ctrl-C as a request to end properly.

#include <csignal>

namespace palpate::plugin {

/// While one of these objects exists, SIGINT, SIGTERM and SIGHUP (the terminal or its connection is gone) only set a
/// flag, and SIGPIPE (the reader of the output is gone) is ignored. A SIGHUP that was ignored before stays ignored, as
/// nohup wants it. One may be made inside another: they share the flag. For one thread.
class Interruptible {
 public:
  Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
  ~Interruptible();

  /// Whether one of these signals has come since the latest outermost Interruptible was made.
  static bool interrupted() noexcept;

 private:
  bool is_outermost_ = false;
  struct sigaction interrupt_before_ {};
  struct sigaction terminate_before_ {};
  struct sigaction hang_up_before_ {};
  struct sigaction pipe_before_ {};
};

}  // namespace palpate::plugin
