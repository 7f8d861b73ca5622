#include "device/device_type.h"
#include "device/settings_file.h"
#include "device/touch/touch.h"
#include "device/touch/touch_driver.h"

namespace palpate::device {

TouchSettings read_touch(const std::string& json_file) {
  return read_settings_file("3D Systems Touch", json_file, [](SettingsReader& reader) {
    TouchSettings settings;
    take_common(reader, settings, touch_limits);
    reader.take("may_reset_encoders", settings.may_reset_encoders);
    return settings;
  });
}

namespace {

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  return make_with_settings(choice, &read_touch, &make_touch);
}

bool send_zeros(const std::string& address, bool /*take_away*/) {
  return send_zeros_to_touch(address);
}

/// The library stays loaded.
GuardianMeans prepare_zeros(const std::string& /*address*/) {
  return find_touch().empty() ? GuardianMeans{} : GuardianMeans{GuardianReach::once_free, 0.1};
}

}  // namespace

extern const DeviceType touch_type;
const DeviceType touch_type{
    .kind = "touch",
    .name = "3D Systems Touch",
    .can = "6 axes sensed, 3 with force; torque stays zero",
    .needs = "the maker's OpenHaptics (libHD.so) and device driver",
    .homing = "put the stylus into its inkwell",
    .sold = "sold now",
    .tested = protocol_tested,
    .watchdog = "unknown: switch it off",
    .file = DeviceFile::settings,
    .file_hint = "Largest force and stiffness, if others are wanted: a JSON file",
    .find = &find_touch,
    .make = &make,
    .send_zeros = &send_zeros,
    .prepare_zeros = &prepare_zeros,
};

}  // namespace palpate::device
