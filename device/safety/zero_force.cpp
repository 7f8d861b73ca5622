#include "device/safety/zero_force.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <exception>
#include <vector>

#include "device/falcon/falcon_protocol.h"
#include "device/falcon/falcon_usb.h"
#include "device/link/realtime.h"

namespace palpate::device {

namespace {

/// The homing bit stays set: dropping it would make the Falcon forget where it is.
bool send_zeros_to_one_falcon(const std::string& address) {
  const auto link = open_falcon_usb(address);
  const auto zero = encode(FalconCommand{});
  // A command cut short when the session died takes the first of these to its end; the next ones are whole.
  for (int i = 0; i < 3; ++i) {
    if (!link->send(zero) || !link->flush(0.1)) return false;
  }
  return true;
}

/// The usual case first, since it is a matter of milliseconds. Without an address the session had the only Falcon;
/// where another was plugged in since, opening "the" Falcon is refused, and each of them gets its zeros.
bool send_zeros_to_falcon(const std::string& address) {
  try {
    return send_zeros_to_one_falcon(address);
  } catch (const std::exception&) {
    if (!address.empty()) return false;
  }
  // One that cannot be opened does not keep the zeros from the next.
  const std::vector<FoundDevice> all = find_falcons();
  const auto reached = std::count_if(all.begin(), all.end(), [](const FoundDevice& falcon) {
    try {
      return send_zeros_to_one_falcon(falcon.address);
    } catch (const std::exception&) {
      return false;
    }
  });
  return all.size() > 1 && reached == static_cast<std::ptrdiff_t>(all.size());
}

/// Straight to the hidraw node, which several may hold at once: a report number and zeros, in each of the lengths that
/// firmwares read, since which one this arm has is not known here.
bool send_zeros_to_hid(const std::string& address) {
  const int node = open(address.c_str(), O_WRONLY | O_CLOEXEC);
  if (node < 0) return false;
  constexpr std::array<std::uint8_t, 65> zeros{};
  int taken = 0;
  for (const std::size_t length : {15, 9, 65}) taken += write(node, zeros.data(), length) > 0 ? 1 : 0;
  close(node);
  return taken > 0;
}

bool try_once(const std::string& kind, const std::string& address, bool take_away) {
  try {
    if (kind == "falcon" && take_away) return take_falcon_and_send_zeros(address);
    if (kind == "falcon") return send_zeros_to_falcon(address);
    return kind == "wooden_haptics" && send_zeros_to_hid(address);
  } catch (const std::exception&) {
    return false;  // still held by the process that is ending, or gone
  }
}

}  // namespace

bool send_zero_force(const std::string& kind, const std::string& address, double patience, bool take_away) {
  const double start = monotonic_time();
  do {
    if (try_once(kind, address, take_away)) return true;
    const timespec pause{0, 500'000};
    nanosleep(&pause, nullptr);
  } while (monotonic_time() - start < patience);
  return false;
}

}  // namespace palpate::device
