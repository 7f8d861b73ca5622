#include "device/device_type.h"
#include "device/settings_file.h"
#include "device/touch/touch.h"

namespace palpate::device {

TouchSettings read_touch(const std::string& json_file) {
  return read_settings_file("3D Systems Touch", json_file, [](SettingsReader& reader) {
    TouchSettings settings;
    reader.take("address", settings.address);
    reader.take("maximum_force", settings.maximum_force);
    reader.take("stiffness_limit", settings.stiffness_limit);
    return settings;
  });
}

namespace {

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  TouchSettings settings;
  if (!choice.settings.empty()) settings = read_touch(choice.settings);
  if (!choice.address.empty()) settings.address = choice.address;
  return make_touch(settings);
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
    .watchdog = "the maker's library",
    .file = DeviceFile::settings,
    .file_hint = "Largest force and stiffness, if others are wanted: a JSON file",
    .find = &find_touch,
    .make = &make,
};

}  // namespace palpate::device
