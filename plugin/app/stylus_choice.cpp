#include "plugin/app/stylus_choice.h"

#include "device/device_type.h"
#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {

const device::DeviceType& type_of(const StylusChoice& choice) {
  const device::DeviceType* const type = device::find_device_type(choice.device.substr(0, choice.device.find('@')));
  if (type == nullptr) {
    throw WrongUsage(say("device-there-is-no-device", choice.device, device::device_kinds()));
  }
  return *type;
}

std::shared_ptr<device::Stylus> make_stylus(const StylusChoice& choice) {
  const auto at = choice.device.find('@');
  return type_of(choice).make({.address = at == std::string::npos ? "" : choice.device.substr(at + 1),
                               .firmware = choice.firmware,
                               .settings = choice.settings,
                               .seed = choice.seed,
                               .rate_hz = choice.rate_hz});
}

}  // namespace palpate::plugin
