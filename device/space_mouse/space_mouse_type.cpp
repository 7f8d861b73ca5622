#include "device/device_type.h"
#include "device/link/hid.h"
#include "device/space_mouse/space_mouse.h"
#include "device/space_mouse/space_mouse_driver.h"

namespace palpate::device {

namespace {

bool is_puck(const HidIds& ids) noexcept {
  const bool is_multi_axis = ids.usage_page == 0x0001 && ids.usage == 0x0008;
  return is_multi_axis && is_space_mouse(ids.vendor, ids.product);
}

std::vector<FoundDevice> find() {
  return find_hid_devices(space_mouse_hid);
}

std::shared_ptr<Stylus> make(const DeviceChoice& choice) {
  return make_space_mouse({.address = choice.address});
}

}  // namespace

const HidKind space_mouse_hid{.kind = "space_mouse", .name = "SpaceMouse", .is_it = &is_puck};

std::unique_ptr<Stylus> make_space_mouse(const SpaceMouseSettings& settings) {
  return make_space_mouse_on(settings, [address = settings.address] { return open_hid(space_mouse_hid, address); }, {});
}

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
