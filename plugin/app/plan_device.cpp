#include "plugin/app/plan_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "device/device_type.h"
#include "device/safety/energy.h"

namespace palpate::plugin {
namespace {

/// Mean time of a tick's damping, us; the best of some rounds.
double damping_us() {
  constexpr int ticks = 2000, rounds = 5;
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    device::EnergyState state;
    double sum = 0;  // so that nothing is optimised away
    const auto begun = std::chrono::steady_clock::now();
    for (int n = 0; n < ticks; ++n) {
      const double time = 1e-3 * n;
      const device::Reading reading{.time = time, .position = {1e-3 * std::sin(300 * time), 0, 0}, .fresh = true};
      sum += device::damp_ringing({}, reading, -400.0 * reading.position, state).x;
    }
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begun;
    if (std::isfinite(sum)) best = std::min(best, took.count() / ticks);
  }
  return best;
}

}  // namespace

std::vector<Saving> savings_of_device(const std::string& device, const device::Specification& specification) {
  std::vector<Saving> savings;
  const std::string kind = device.substr(0, device.find('@'));
  const device::DeviceType* const type = device::find_device_type(kind);
  const bool simulated = type != nullptr && type->is_simulated;
  std::string others;
  for (const device::DeviceType* driver : device::device_types()) {
    if (driver->find == nullptr || kind == driver->kind) continue;
    others += (others.empty() ? "" : ", ") + std::string(driver->kind);
  }
  savings.push_back({.what = "drivers of " + others,
                     .why = simulated ? "the stylus is simulated" : "another stylus is held",
                     .saves = "a thread, and USB, HID, sockets and libraries that nobody opens"});
  if (type == nullptr || type->send_zeros == nullptr) {
    savings.push_back({.what = "guardian",
                       .why = simulated                       ? "a simulated stylus pushes nobody"
                              : specification.force_axes == 0 ? "the stylus has no motors"
                                                              : "the device ends a force that is not renewed",
                       .saves = "a process and its pipe"});
  }
  if (specification.force_axes == 0) {
    savings.push_back({.what = "damping of ringing",
                       .why = "the stylus has no motors",
                       .saves = fmt::format("{:.2f} us a tick", damping_us())});
  }
  return savings;
}

}  // namespace palpate::plugin
