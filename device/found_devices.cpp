#include "device/found_devices.h"

#include <iterator>

#include "device/falcon/falcon_usb.h"
#include "device/link/hid.h"

namespace palpate::device {

std::vector<FoundDevice> find_devices() {
  std::vector<FoundDevice> found = find_falcons();
  std::vector<FoundDevice> hid = find_hid_devices();
  std::move(hid.begin(), hid.end(), std::back_inserter(found));
  return found;
}

std::string permission_advice() {
  return "type: sudo cp " PALPATE_UDEV_RULES_PATH
         " /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger && sudo adduser $USER plugdev; "
         "then log in again and replug the device";
}

}  // namespace palpate::device
