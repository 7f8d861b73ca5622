#include "device/safety/zero_force.h"

#include <unistd.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "device/device_type.h"

namespace palpate::device {

double pause_after(double seconds) noexcept {
  constexpr double shortest = 0.5e-3, longest = 0.1, share = 0.05;
  return std::clamp(share * seconds, shortest, longest);
}

bool keep_trying(const std::function<bool()>& try_once, const std::function<bool(double)>& gives_up,
                 const DriverClock& clock) {
  const double start = clock.now();
  for (;;) {
    if (try_once()) return true;
    const double waited = clock.now() - start;
    if (gives_up(waited)) return false;
    clock.sleep(pause_after(waited));
  }
}

bool try_zero_force(const std::string& kind, const std::string& address, bool take_away) noexcept {
  try {
    const DeviceType* const type = find_device_type(kind);
    return type != nullptr && type->send_zeros != nullptr && type->send_zeros(address, take_away);
  } catch (const std::exception&) {
    return false;  // still held by the process that is ending, or gone
  }
}

bool send_zero_force(const std::string& kind, const std::string& address, double patience, bool take_away) {
  const DeviceType* const type = find_device_type(kind);
  if (type == nullptr || type->send_zeros == nullptr) return false;
  return keep_trying([&] { return try_zero_force(kind, address, take_away); },
                     [&](double waited) { return waited >= patience; });
}

Login::Login(std::string folder) : folder_(std::move(folder)), was_there_(access(folder_.c_str(), F_OK) == 0) {}

bool Login::is_over(double waited_s) const {
  return was_there_ ? access(folder_.c_str(), F_OK) != 0 : waited_s >= without_login_s;
}

std::string Login::own_folder() {
  return "/run/user/" + std::to_string(getuid());
}

}  // namespace palpate::device
