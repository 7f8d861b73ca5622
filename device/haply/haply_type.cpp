#include "device/device_type.h"
#include "device/haply/haply.h"
#include "device/haply/haply_service.h"
#include "device/settings_file.h"

namespace palpate::device {

HaplySettings read_haply(const std::string& json_file) {
  return read_settings_file("Haply", json_file, [](SettingsReader& reader) {
    HaplySettings settings;
    reader.take("address", settings.address);
    reader.take("host", settings.host);
    reader.take("port", settings.port);
    reader.take("preset", settings.preset);
    reader.take("maximum_force", settings.maximum_force);
    reader.take("stiffness_limit", settings.stiffness_limit);
    return settings;
  });
}

namespace {

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  HaplySettings settings;
  if (!choice.settings.empty()) settings = read_haply(choice.settings);
  if (!choice.address.empty()) settings.address = choice.address;
  return make_haply(settings);
}

}  // namespace

extern const DeviceType haply_type;
const DeviceType haply_type{
    .kind = "haply",
    .name = "Haply Inverse3 or Minverse",
    .can = "3 axes sensed, 3 with force; orientation and buttons of a VerseGrip",
    .needs = "the maker's Inverse Service, running on this machine",
    .homing = "calibrate it as Haply Hub says",
    .sold = "sold now",
    .tested = protocol_tested,
    .watchdog = "the service ends a force that is not renewed",
    .file = DeviceFile::settings,
    .file_hint = "Largest force and stiffness, if others are wanted: a JSON file",
    .find = &find_haply,
    .make = &make,
};

}  // namespace palpate::device
