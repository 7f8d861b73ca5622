#include "palpate/plugin/stylus_option.h"

#include <CLI/CLI.hpp>

#include "palpate/device/falcon.h"
#include "palpate/device/simulated_stylus.h"
#include "palpate/device/space_mouse.h"
#include "palpate/device/wooden_haptics.h"
#include "palpate/plugin/command.h"

namespace palpate::plugin {

void add_device_option(CLI::App& command, StylusOption& option) {
  command
      .add_option(
          "--device", option.device,
          "the stylus: simulated, falcon, wooden_haptics or space_mouse; @ADDRESS where several are plugged in\n"
          "(`palpate devices` lists them)")
      ->capture_default_str();
}

void add_stylus_option(CLI::App& command, StylusOption& option) {
  add_device_option(command, option);
  command.add_option("--firmware", option.firmware, "Falcon: Novint's firmware file, where it has none yet");
  command.add_option("--device-settings", option.settings, "WoodenHaptics: the arm's geometry and signs, a JSON file");
  command.add_option("--seed", option.seed, "simulated: of the hand's tremor")->capture_default_str();
  command.add_option("--rate", option.rate_hz, "simulated: ticks a second")
      ->check(CLI::Range(100.0, 20000.0))
      ->capture_default_str();
}

std::shared_ptr<device::Stylus> make_stylus(const StylusOption& option) {
  const auto at = option.device.find('@');
  const std::string kind = option.device.substr(0, at);
  const std::string address = at == std::string::npos ? "" : option.device.substr(at + 1);
  if (kind == "simulated") {
    device::SimulatedDevice model;
    model.hand.tremor_seed = option.seed;
    model.rate = option.rate_hz;
    return std::make_shared<device::SimulatedStylus>(model);
  }
  if (kind == "falcon") {
    return device::make_falcon({.address = address, .firmware_file = option.firmware});
  }
  if (kind == "wooden_haptics") {
    device::WoodenHapticsSettings settings;
    if (!option.settings.empty()) settings = device::read_wooden_haptics(option.settings);
    if (!address.empty()) settings.address = address;
    return device::make_wooden_haptics(settings);
  }
  if (kind == "space_mouse") {
    return device::make_space_mouse({.address = address});
  }
  throw WrongUsage("--device: there is no device \"" + option.device +
                   "\"; there are: simulated, falcon, wooden_haptics, space_mouse");
}

}  // namespace palpate::plugin
