#pragma once

/// The options that name a stylus: --device KIND[@ADDRESS], and the settings of that kind.

#include "plugin/app/stylus_choice.h"

namespace CLI {
class App;
}

namespace palpate::plugin {

/// Only --device. `choice` must outlive the command, here and below.
void add_device_option(CLI::App& command, StylusChoice& choice);
/// All these options.
void add_stylus_option(CLI::App& command, StylusChoice& choice);

}  // namespace palpate::plugin
