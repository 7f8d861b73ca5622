#include "palpate/device/internal/zero_force.h"

#include <ctime>
#include <exception>

#include "palpate/device/falcon_protocol.h"
#include "palpate/device/internal/falcon_usb.h"
#include "palpate/device/realtime.h"

namespace palpate::device {

namespace {

/// The homing bit stays set: dropping it would make the Falcon forget where it is.
bool send_zeros_to_falcon(const std::string& address) {
  const auto link = open_falcon_usb(address);
  const auto zero = encode(FalconCommand{});
  // A command cut short when the session died takes the first of these to its end; the next ones are whole.
  for (int i = 0; i < 3; ++i) {
    if (!link->send(zero) || !link->flush(0.1)) return false;
  }
  return true;
}

bool try_once(const std::string& kind, const std::string& address) {
  try {
    return kind == "falcon" && send_zeros_to_falcon(address);
  } catch (const std::exception&) {
    return false;  // still held by the process that is ending, or gone
  }
}

}  // namespace

bool send_zero_force(const std::string& kind, const std::string& address, double patience) {
  const double start = monotonic_time();
  do {
    if (try_once(kind, address)) return true;
    const timespec pause{0, 500'000};
    nanosleep(&pause, nullptr);
  } while (monotonic_time() - start < patience);
  return false;
}

}  // namespace palpate::device
