#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdint>

#include "device/device_type.h"
#include "device/link/hid.h"
#include "device/settings_file.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {

namespace {

std::vector<FoundDevice> find() {
  return find_hid_devices("wooden_haptics");
}

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  return make_with_settings(choice, &read_wooden_haptics, &make_wooden_haptics);
}

/// Straight to the hidraw node, which several may hold at once: a report number and zeros, in each of the lengths that
/// firmwares read, since which one this arm has is not known here.
bool send_zeros(const std::string& address, bool /*take_away*/) {
  const int node = open(address.c_str(), O_WRONLY | O_CLOEXEC);
  if (node < 0) return false;
  constexpr std::array<std::uint8_t, 65> zeros{};
  int taken = 0;
  for (const std::size_t length : {15, 9, 65}) taken += write(node, zeros.data(), length) > 0 ? 1 : 0;
  close(node);
  return taken > 0;
}

}  // namespace

extern const DeviceType wooden_haptics_type;
const DeviceType wooden_haptics_type{
    .kind = "wooden_haptics",
    .name = "WoodenHaptics",
    .can = "3 axes sensed, 3 with force",
    .needs = "its address, and a settings file that names its preset: 2015, 2016, 2019 or woody",
    .homing = "put the arm into its home pose (lower body upright, upper body level), then press its button",
    .sold = "built by hand",
    .tested = protocol_tested,
    .watchdog = "0.5 s, in its firmware",
    .file = DeviceFile::settings,
    .file_hint = "The arm's settings: a JSON file",
    .find = &find,
    .make = &make,
    .send_zeros = &send_zeros,
};

}  // namespace palpate::device
