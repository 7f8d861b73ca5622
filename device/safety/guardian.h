#pragma once

/// Takes the force away when the session's process dies without a word (SIGKILL, a crash), or is stopped while it
/// pushes (Ctrl-Z, a debugger): a small process of its own, joined to the session by a pipe and a shared count of the
/// exchanges with the device. When the pipe ends or the count stands still, it opens the device and sends zeros. A
/// device that was unplugged gets them when it comes back.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

namespace palpate::device {

struct GuardianSettings {
  std::string program;  ///< path of palpate-guardian; empty: no guardian
  std::string kind;     ///< "falcon" or "wooden_haptics"
  std::string address;  ///< of the one device, as FoundDevice::address
};

/// In memory that session and guardian share.
struct GuardianBeat {
  std::atomic<std::uint32_t> count{0};    ///< exchanges with the device
  std::atomic<std::uint32_t> pushing{0};  ///< 1: the last of them carried a force
};

class Guardian {
 public:
  Guardian(int pid, int pipe, GuardianBeat* shared) : pid_(pid), pipe_(pipe), shared_(shared) {}
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;
  ~Guardian() { dismiss(); }

  /// The device was closed in good order: the guardian leaves it alone and ends.
  void dismiss() noexcept { end('q'); }
  /// The device is gone, perhaps with its force on: for a minute the guardian goes on by itself and sends zeros as soon
  /// as the device is back.
  void hand_over() noexcept { end('w'); }
  /// After each exchange with the device. Wait-free.
  void beat(bool pushing) noexcept {
    shared_->pushing.store(pushing ? 1 : 0, std::memory_order_relaxed);
    shared_->count.fetch_add(1, std::memory_order_relaxed);
  }
  int pid() const noexcept { return pid_; }

 private:
  void end(char word) noexcept;

  int pid_;
  int pipe_;
  GuardianBeat* shared_;
};

/// Nothing where no program is named. Throws std::runtime_error where it cannot be started.
std::unique_ptr<Guardian> start_guardian(const GuardianSettings& settings);

/// The installed or built palpate-guardian: $PALPATE_GUARDIAN, else beside the running program, else where it was
/// installed; empty where there is none.
std::string guardian_program();

}  // namespace palpate::device
