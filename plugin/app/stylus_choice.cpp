#include "plugin/app/stylus_choice.h"

#include "device/falcon/falcon.h"
#include "device/simulated/simulated_stylus.h"
#include "device/space_mouse/space_mouse.h"
#include "device/wooden_haptics/wooden_haptics.h"
#include "plugin/app/errors.h"

namespace palpate::plugin {

std::shared_ptr<device::Stylus> make_stylus(const StylusChoice& choice) {
  const auto at = choice.device.find('@');
  const std::string kind = choice.device.substr(0, at);
  const std::string address = at == std::string::npos ? "" : choice.device.substr(at + 1);
  if (kind == "simulated") {
    device::SimulatedDevice model;
    model.hand.tremor_seed = choice.seed;
    model.rate = choice.rate_hz;
    return std::make_shared<device::SimulatedStylus>(model);
  }
  if (kind == "falcon") {
    return device::make_falcon({.address = address, .firmware_file = choice.firmware});
  }
  if (kind == "wooden_haptics") {
    device::WoodenHapticsSettings settings;
    if (!choice.settings.empty()) settings = device::read_wooden_haptics(choice.settings);
    if (!address.empty()) settings.address = address;
    return device::make_wooden_haptics(settings);
  }
  if (kind == "space_mouse") {
    return device::make_space_mouse({.address = address});
  }
  throw WrongUsage("--device: there is no device \"" + choice.device +
                   "\"; there are: simulated, falcon, wooden_haptics, space_mouse");
}

}  // namespace palpate::plugin
