#include "device/safety/zero_force.h"

#include <ctime>
#include <exception>

#include "device/device_type.h"
#include "device/link/realtime.h"

namespace palpate::device {

namespace {

bool try_once(const DeviceType& type, const std::string& address, bool take_away) {
  try {
    return type.send_zeros(address, take_away);
  } catch (const std::exception&) {
    return false;  // still held by the process that is ending, or gone
  }
}

}  // namespace

bool send_zero_force(const std::string& kind, const std::string& address, double patience, bool take_away) {
  const DeviceType* const type = find_device_type(kind);
  if (type == nullptr || type->send_zeros == nullptr) return false;
  const double start = monotonic_time();
  do {
    if (try_once(*type, address, take_away)) return true;
    const timespec pause{0, 500'000};
    nanosleep(&pause, nullptr);
  } while (monotonic_time() - start < patience);
  return false;
}

}  // namespace palpate::device
