#include "device/found_devices.h"

#include <iterator>

#include "device/device_type.h"
#include "device/messages.h"

namespace palpate::device {

std::vector<FoundDevice> find_devices() {
  std::vector<FoundDevice> found;
  for (const DeviceType* type : device_types()) {
    if (type->find == nullptr) continue;
    std::vector<FoundDevice> some = type->find();
    std::move(some.begin(), some.end(), std::back_inserter(found));
  }
  return found;
}

Refusal which_of(const std::string& name, std::size_t matching) {
  return Refusal(say("several-devices", name, matching));
}

Text permission_advice() {
  return say("permission-advice", PALPATE_UDEV_RULES_PATH);
}

}  // namespace palpate::device
