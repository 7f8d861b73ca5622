#include "device/device_type.h"
#include "device/haply/haply.h"
#include "device/haply/haply_service.h"
#include "device/settings_file.h"

namespace palpate::device {

HaplySettings read_haply(const std::string& json_file) {
  return read_settings_file("Haply", json_file, [](SettingsReader& reader) {
    HaplySettings settings = haply_defaults();
    take_common(reader, settings, {});
    reader.take("host", settings.host);
    reader.take("port", settings.port);
    reader.take("events_port", settings.events_port);
    reader.take("preset", settings.preset);
    return settings;
  });
}

namespace {

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  return make_with_settings(choice, &read_haply, &make_haply, haply_defaults());
}

bool send_zeros(const std::string& address, bool /*take_away*/) {
  return send_zeros_to_haply(address);
}

GuardianMeans prepare_zeros(const std::string& /*address*/) {
  return {GuardianReach::looks_on, 0.3};
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
    .send_zeros = &send_zeros,
    .prepare_zeros = &prepare_zeros,
};

}  // namespace palpate::device
