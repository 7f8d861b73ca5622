#include "plugin/options/stylus_option.h"

#include <CLI/CLI.hpp>

namespace palpate::plugin {

void add_device_option(CLI::App& command, StylusChoice& choice) {
  command
      .add_option("--device", choice.device,
                  "the stylus: " + device::device_kinds() +
                      ";\n@ADDRESS if several are plugged in (`palpate devices` lists them)")
      ->capture_default_str();
}

void add_stylus_option(CLI::App& command, StylusChoice& choice) {
  add_device_option(command, choice);
  command.add_option("--firmware", choice.firmware, "Falcon: Novint's firmware file, if the device has none yet");
  command.add_option(
      "--device-settings", choice.settings,
      "a JSON file of the device's settings: its largest force and more; `palpate devices --check KIND` writes one");
  command.add_option("--seed", choice.seed, "simulated stylus: seed of the hand's tremor")->capture_default_str();
  command.add_option("--rate", choice.rate_hz, "simulated stylus: ticks a second")
      ->check(CLI::Range(100.0, 20000.0))
      ->capture_default_str();
}

}  // namespace palpate::plugin
