#pragma once

/// A small process that takes the force away when the session's process is killed, crashes, or is stopped while the
/// stylus pushes (Ctrl-Z, a debugger). A pipe and a shared count of the exchanges with the device join the two. When
/// the pipe ends or the count stands still, the guardian opens the device and sends zeros. A device that was unplugged
/// gets them when it comes back. The guardian proves before the first force that it works, and its loss is a fault.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/safety/guardian_beat.h"
#include "solver/text/message.h"

namespace palpate::device {

struct GuardianSettings {
  std::string program;  ///< path of palpate-guardian; empty: no guardian
  std::string kind;     ///< DeviceType::kind
  std::string address;  ///< the address of its device, as FoundDevice::address
};

class Guardian {
 public:
  /// s that it has for its proof, and once more for its search for the device.
  static constexpr double patience_s = 5;
  /// s: the longest time to wait until it ends, even if it hangs.
  static constexpr double end_within_s = 2;

  /// `pid` 0: there is no process, and another object owns `shared`.
  Guardian(int pid, int pipe, GuardianBeat* shared, std::string program = {})
      : pid_(pid), pipe_(pipe), shared_(shared), program_(std::move(program)) {}
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;
  ~Guardian() { dismiss(); }

  /// Waits until it has proved that it is a guardian. Throws std::runtime_error if it ends, or has no proof within
  /// `patience` s.
  void prove(double patience = patience_s) const;
  /// Waits until it reports its reach for the device. Throws std::runtime_error as prove() does, and if it can do
  /// nothing.
  GuardianReach reach(double patience = patience_s) const;
  /// Its reach, in words for the user; after reach().
  Text describe() const;

  /// The device was closed in good order: the guardian leaves it alone and ends. If it does not end, it is killed.
  void dismiss() noexcept { end('q'); }
  /// The device was lost, perhaps with its force on. If it is there, it has its zeros when this returns, and no
  /// guardian is left. If not, the guardian goes on by itself until the device is back or the user logs out, and sends
  /// zeros as soon as it is back.
  void hand_over() noexcept { end('w'); }
  /// To be called in each exchange with the device, before a force is given to it; not after a device is lost.
  /// Wait-free.
  void beat(OnDevice on_device) noexcept {
    shared_->on_device.store(on_device, std::memory_order_relaxed);
    shared_->count.fetch_add(1, std::memory_order_relaxed);
  }
  const GuardianBeat& shared() const noexcept { return *shared_; }
  int pid() const noexcept { return pid_; }

 private:
  bool has_ended() const noexcept;
  template <typename Holds>
  void wait_until(const Holds& holds, double patience) const;
  void end(char word) noexcept;
  bool wait_for_end(double patience) const noexcept;

  int pid_;
  int pipe_;
  GuardianBeat* shared_;
  std::string program_;
};

/// Null if no program is named. Throws std::runtime_error if it cannot be started.
std::unique_ptr<Guardian> start_guardian(const GuardianSettings& settings);

/// Whether a guardian of this user can leave the session's control group: this needs a systemd that runs the user's
/// scopes. If it cannot, anything that ends the whole group (the end of a container, an out-of-memory killer) ends both
/// session and guardian.
bool guardian_can_leave_group();

/// The path of palpate-guardian: $PALPATE_GUARDIAN if it is set; else the first of guardian_candidates() that exists.
/// Empty if there is none.
std::string guardian_program();

/// Places of palpate-guardian, in the order of search: beside `program`; beside the plug-in or program `loaded_from`;
/// in bin and libexec/palpate of every folder above it, where a build and an installation have it; and at `installed`.
std::vector<std::string> guardian_candidates(const std::string& program, const std::string& loaded_from,
                                             const std::string& installed);

}  // namespace palpate::device
