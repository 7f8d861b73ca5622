#include <algorithm>
#include <exception>

#include "device/device_type.h"
#include "device/falcon/falcon.h"
#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_usb.h"
#include "device/messages.h"
#include "device/settings_file.h"

namespace palpate::device {

namespace {

FalconSettings read(SettingsReader& reader) {
  FalconSettings settings;
  take_common(reader, settings, {.force_n = falcon_force});
  reader.take("firmware_file", settings.firmware_file);
  reader.take("motor_gain", settings.motor_gain);
  if (const Text wrong = wrong_gain(settings); !wrong.empty()) throw Refusal(wrong);
  return settings;
}

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  return make_with_settings(choice, &read_falcon, &make_falcon);
}

bool send_zeros_to_one(const std::string& address) {
  return zero_falcon(*open_falcon_usb(address));
}

/// The usual case first, since it is a matter of milliseconds. Without an address the session had the only Falcon;
/// where another was plugged in since, opening "the" Falcon is refused, and each of them gets its zeros.
bool send_zeros(const std::string& address, bool take_away) {
  if (take_away) return take_falcon_and_send_zeros(address);
  try {
    return send_zeros_to_one(address);
  } catch (const std::exception&) {
    if (!address.empty()) return false;
  }
  // One that cannot be opened does not keep the zeros from the next.
  const std::vector<FoundDevice> all = find_falcons();
  const auto reached = std::count_if(all.begin(), all.end(), [](const FoundDevice& falcon) {
    try {
      return send_zeros_to_one(falcon.address);
    } catch (const std::exception&) {
      return false;
    }
  });
  return all.size() > 1 && reached == static_cast<std::ptrdiff_t>(all.size());
}

GuardianMeans prepare_zeros(const std::string& address) {
  const std::vector<FoundDevice> all = find_falcons();
  const bool may_be_reached = std::any_of(all.begin(), all.end(), [&](const FoundDevice& falcon) {
    return falcon.accessible && (address.empty() || falcon.address == address || address.find(':') != address.npos);
  });
  return may_be_reached ? GuardianMeans{GuardianReach::at_any_time, 0.05} : GuardianMeans{};
}

}  // namespace

FalconSettings read_falcon(const std::string& json_file) {
  return read_settings_file("Novint Falcon", json_file, read);
}

extern const DeviceType falcon_type;
const DeviceType falcon_type{
    .kind = "falcon",
    .name = "Novint Falcon",
    .can = "3 axes sensed, 3 with force",
    .needs = "Novint's firmware file after it was switched on",
    .homing = "pull the grip all the way out, then push it in",
    .sold = "discontinued",
    .tested = protocol_tested,
    .watchdog = "unknown: switch it off",
    .file = DeviceFile::firmware,
    .file_hint = "Novint's firmware file, if it was switched off; or its settings: a JSON file",
    .find = &find_falcons,
    .make = &make,
    .send_zeros = &send_zeros,
    .prepare_zeros = &prepare_zeros,
};

}  // namespace palpate::device
