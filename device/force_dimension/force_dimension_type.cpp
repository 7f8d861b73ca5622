#include <exception>

#include "device/device_type.h"
#include "device/force_dimension/force_dimension.h"
#include "device/force_dimension/force_dimension_driver.h"
#include "device/settings_file.h"

namespace palpate::device {

ForceDimensionSettings read_force_dimension(const std::string& json_file) {
  return read_settings_file("Force Dimension", json_file, [](SettingsReader& reader) {
    ForceDimensionSettings settings;
    take_common(reader, settings, force_dimension_limits);
    reader.take("may_home", settings.may_home);
    return settings;
  });
}

namespace {

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  return make_with_settings(choice, &read_force_dimension, &make_force_dimension);
}

bool send_zeros(const std::string& address, bool /*take_away*/) {
  return stop_force_dimension(address);
}

/// The library stays loaded.
GuardianMeans prepare_zeros(const std::string& /*address*/) {
  try {
    const DrdLibrary drd;
    return {GuardianReach::once_free, 0.1};
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

extern const DeviceType force_dimension_type;
const DeviceType force_dimension_type{
    .kind = "force_dimension",
    .name = "Force Dimension omega, delta, sigma or lambda",
    .can = "3 or 6 axes sensed, 3 with force; torque stays zero",
    .needs = "the maker's SDK 3.17 (libdrd.so); leave to home, for which the arm moves by itself",
    .sold = "sold now",
    .tested = protocol_tested,
    .watchdog = "30 ms, in its firmware, where the model has a watchdog",
    .file = DeviceFile::settings,
    .file_hint = "Leave to home (\"may_home\": true), largest force: a JSON file",
    .find = &find_force_dimension,
    .make = &make,
    .send_zeros = &send_zeros,
    .prepare_zeros = &prepare_zeros,
};

}  // namespace palpate::device
