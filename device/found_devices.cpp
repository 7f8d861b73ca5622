#include "device/found_devices.h"

#include <iterator>

#include "device/device_type.h"

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

std::runtime_error which_of(const std::string& name, std::size_t matching) {
  return std::runtime_error(name + ": there are " + std::to_string(matching) +
                            "; name the address of one, as `palpate devices` lists them");
}

std::string permission_advice() {
  return "type: sudo cp " PALPATE_UDEV_RULES_PATH
         " /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger && sudo adduser $USER plugdev; "
         "then log in again and replug the device";
}

}  // namespace palpate::device
