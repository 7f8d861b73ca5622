#include "device/device_type.h"
#include "device/link/hid.h"
#include "device/space_mouse/space_mouse.h"

namespace palpate::device {

namespace {

std::vector<FoundDevice> find() {
  return find_hid_devices("space_mouse");
}

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  return make_space_mouse({.address = choice.address});
}

}  // namespace

extern const DeviceType space_mouse_type;
const DeviceType space_mouse_type{
    .kind = "space_mouse",
    .name = "3Dconnexion SpaceMouse",
    .can = "3 axes sensed as a rate, no force",
    .sold = "sold",
    .tested = protocol_tested,
    .watchdog = "not needed: it has no motors",
    .has_force = false,
    .find = &find,
    .make = &make,
};

}  // namespace palpate::device
