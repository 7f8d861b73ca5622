#pragma once

/// How a command is told which stylus to hold: --device KIND[@ADDRESS] and what that kind needs.

#include <cstdint>
#include <memory>
#include <string>

#include "palpate/device/stylus.h"

namespace CLI {
class App;
}

namespace palpate::plugin {

struct StylusOption {
  std::string device = "simulated";
  std::string firmware;  ///< Falcon: Novint's file
  std::string settings;  ///< WoodenHaptics: the arm's JSON file
  std::uint64_t seed = 1;
  double rate_hz = 1000;  ///< of the simulated one
  bool is_simulated() const { return device == "simulated"; }
};

/// --device alone. `option` has to live as long as the command, here and below.
void add_device_option(CLI::App& command, StylusOption& option);
/// All of them.
void add_stylus_option(CLI::App& command, StylusOption& option);

/// Not open yet; drivers of real ones start a guardian when they are opened. Throws WrongUsage for a kind that there is
/// not, and what the drivers throw for their settings.
std::shared_ptr<device::Stylus> make_stylus(const StylusOption& option);

}  // namespace palpate::plugin
