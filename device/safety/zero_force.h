#pragma once

#include <functional>
#include <string>

#include "device/link/driver_clock.h"

namespace palpate::device {

/// s until the next attempt to reach a device that could not be reached for `seconds`. At first there is no pause,
/// because a session that is ending may release the device at any moment; later the pauses are longer. A device that is
/// plugged in again keeps its force for less than 0.3 s in any case.
double pause_after(double seconds) noexcept;

/// Repeats `try_once` with these pauses until it succeeds. Returns false as soon as `gives_up(s since the first
/// attempt)` returns true. There is always one attempt.
bool keep_trying(const std::function<bool()>& try_once, const std::function<bool(double)>& gives_up,
                 const DriverClock& clock = {});

/// One attempt to open the device and send zeros until it has taken some; for the guardian, which does not know its
/// state. `take_away`: from a process that is stopped and will not release it. Never throws.
bool try_zero_force(const std::string& kind, const std::string& address, bool take_away = false) noexcept;

/// The same for at most `patience` s. False if the device is gone.
bool send_zero_force(const std::string& kind, const std::string& address, double patience, bool take_away = false);

/// Whether the user who is logged in now has logged out: the folder of the login, /run/user/UID, is gone.
class Login {
 public:
  /// s of waiting for a device if nobody is logged in, as in a container.
  static constexpr double without_login_s = 3600;

  explicit Login(std::string folder = own_folder());
  bool is_over(double waited_s) const;
  static std::string own_folder();

 private:
  std::string folder_;
  bool was_there_;
};

}  // namespace palpate::device
