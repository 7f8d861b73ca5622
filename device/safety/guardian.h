#pragma once

/// A small process that takes the force away when the session's process is killed, crashes, or is stopped while the
/// stylus pushes (Ctrl-Z, a debugger). A pipe and a shared count of the exchanges with the device join the two. When
/// the pipe ends or the count stands still, the guardian opens the device and sends zeros. A device that was unplugged
/// gets them when it comes back.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/safety/on_device.h"

namespace palpate::device {

struct GuardianSettings {
  std::string program;  ///< path of palpate-guardian; empty: no guardian
  std::string kind;     ///< DeviceType::kind
  std::string address;  ///< of the one device, as FoundDevice::address
};

/// Lies in memory that session and guardian share.
struct GuardianBeat {
  std::atomic<std::uint32_t> count{0};                    ///< exchanges with the device
  std::atomic<OnDevice> on_device{OnDevice::zero_taken};  ///< at the last of them; before the first: nothing was given
};

class Guardian {
 public:
  Guardian(int pid, int pipe, GuardianBeat* shared) : pid_(pid), pipe_(pipe), shared_(shared) {}
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;
  ~Guardian() { dismiss(); }

  /// The device was closed in good order: the guardian leaves it alone and ends.
  void dismiss() noexcept { end('q'); }
  /// The device was lost, perhaps with its force on. The guardian goes on by itself for a minute, and sends zeros as
  /// soon as the device is back.
  void hand_over() noexcept { end('w'); }
  /// In each exchange with the device, before a force is given to it. After a device is lost there is no more beat.
  /// Wait-free.
  void beat(OnDevice on_device) noexcept {
    shared_->on_device.store(on_device, std::memory_order_relaxed);
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

/// The path of palpate-guardian: $PALPATE_GUARDIAN if it is set; else the first one that is found of
/// guardian_candidates(). Empty if there is none.
std::string guardian_program();

/// Where palpate-guardian may lie, in the order of search: beside `program`; beside the plug-in or program
/// `loaded_from`; in bin and libexec/palpate of every folder above it, which finds a build's and an installed one; and
/// at `installed`.
std::vector<std::string> guardian_candidates(const std::string& program, const std::string& loaded_from,
                                             const std::string& installed);

}  // namespace palpate::device
