#pragma once

/// Keeps the machine from sleeping while a stylus with motors is open, through systemd-inhibit, a process that ends
/// with this one. If the machine sleeps anyway, this is a fault when it wakes (LinkFault::slept).

#include <memory>
#include <string>

namespace palpate::device {

class StayAwake {
 public:
  StayAwake(int pid, int pipe) : pid_(pid), pipe_(pipe) {}
  StayAwake(const StayAwake&) = delete;
  StayAwake& operator=(const StayAwake&) = delete;
  /// The machine may sleep again.
  ~StayAwake();

 private:
  int pid_;
  int pipe_;
};

/// `device`: the name that the system shows as the reason. Null if systemd-inhibit is not installed.
std::unique_ptr<StayAwake> stay_awake(const std::string& device) noexcept;

}  // namespace palpate::device
