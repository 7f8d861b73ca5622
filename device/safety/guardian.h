#pragma once

/// Takes the force away when the session's process dies without a word (SIGKILL, a crash): a small process of its own,
/// joined to the session by a pipe. When the pipe ends, it opens the device and sends zeros.

#include <memory>
#include <string>

namespace palpate::device {

struct GuardianSettings {
  std::string program;  ///< path of palpate-guardian; empty: no guardian
  std::string kind;     ///< "falcon" or "wooden_haptics"
  std::string address;  ///< of the one device, as FoundDevice::address
};

class Guardian {
 public:
  Guardian(int pid, int pipe) : pid_(pid), pipe_(pipe) {}
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;
  ~Guardian() { dismiss(); }

  /// The device was closed in good order: the guardian leaves it alone and ends.
  void dismiss() noexcept;
  int pid() const noexcept { return pid_; }

 private:
  int pid_;
  int pipe_;
};

/// Nothing where no program is named. Throws std::runtime_error where it cannot be started.
std::unique_ptr<Guardian> start_guardian(const GuardianSettings& settings);

/// The installed or built palpate-guardian: $PALPATE_GUARDIAN, else beside the running program, else where it was
/// installed; empty where there is none.
std::string guardian_program();

}  // namespace palpate::device
