#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "device/device_type.h"
#include "device/link/hid.h"
#include "device/messages.h"
#include "device/safety/guardian.h"
#include "device/settings_file.h"
#include "device/wooden_haptics/wooden_haptics.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"

namespace palpate::device {

namespace {

/// The ids are those of boards that anybody may use; the page of HID is the firmware's own.
bool is_arm(const HidIds& ids) noexcept {
  const bool mbed = ids.vendor == 0x1234 && ids.product == 0x0006;
  const bool teensy = ids.vendor == 0x16c0 && ids.product == 0x0486;
  return (mbed || teensy) && ids.usage_page == 0xffab && ids.usage == 0x0200;
}

std::vector<FoundDevice> find() {
  return find_hid_devices(wooden_haptics_hid);
}

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  return make_with_settings(choice, &read_wooden_haptics, &make_wooden_haptics);
}

/// Of the guardian's arm; empty: not known.
std::string guarded_arm;

/// Straight to the hidraw node: a report number and zeros, in each of the lengths that firmwares read, since which one
/// this arm has is not known here. Not into what another session drives, unless that one is stopped.
bool write_zeros(const std::string& path, bool take_away) {
  const int node = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (node < 0) return false;
  constexpr std::array<std::uint8_t, 65> zeros{};
  int taken = 0;
  if (take_away || flock(node, LOCK_EX | LOCK_NB) == 0) {
    for (const std::size_t length : {15, 9, 65}) taken += write(node, zeros.data(), length) > 0 ? 1 : 0;
  }
  close(node);
  return taken > 0;
}

/// An arm that was plugged in again has another node, and what lies at the former one may be anything.
bool send_zeros(const std::string& address, bool take_away) {
  if (!guarded_arm.empty() && hid_identity(address) == guarded_arm) return write_zeros(address, take_away);
  const std::vector<FoundDevice> arms = find();
  const auto meant = [&](const FoundDevice& arm) {
    return guarded_arm.empty() ? arm.address == address : hid_identity(arm.address) == guarded_arm;
  };
  const auto arm = std::find_if(arms.begin(), arms.end(), meant);
  return arm != arms.end() && write_zeros(arm->address, take_away);
}

GuardianMeans prepare_zeros(const std::string& address) {
  const std::vector<FoundDevice> arms = find();
  const bool may_be_reached = std::any_of(
      arms.begin(), arms.end(), [&](const FoundDevice& arm) { return arm.accessible && arm.address == address; });
  if (!may_be_reached) return {};
  guarded_arm = hid_identity(address);
  return {GuardianReach::at_any_time, 0.05};
}

}  // namespace

const HidKind wooden_haptics_hid{
    .kind = "wooden_haptics",
    .name = "WoodenHaptics",
    .is_it = &is_arm,
    .is_held_alone = true,
    .note = "its USB ids are shared by other devices: make sure that it is one before naming it",
};

std::unique_ptr<Stylus> make_wooden_haptics(const WoodenHapticsSettings& settings) {
  if (settings.address.empty()) throw Refusal(say("woodenhaptics-name-its-address"));
  LinkStylusOptions options;
  if (settings.guarded) options.guardian = {guardian_program(), wooden_haptics_hid.kind, settings.address};
  options.signs = settings.signs;
  options.stays_awake = true;
  return make_wooden_haptics_on(
      settings, [address = settings.address] { return open_hid(wooden_haptics_hid, address); }, options);
}

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
    .prepare_zeros = &prepare_zeros,
};

}  // namespace palpate::device
