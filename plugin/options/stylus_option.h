#pragma once

/// How a command is told which stylus to hold: --device KIND[@ADDRESS] and what that kind needs.

#include "plugin/app/stylus_choice.h"

namespace CLI {
class App;
}

namespace palpate::plugin {

/// --device alone. `choice` has to live as long as the command, here and below.
void add_device_option(CLI::App& command, StylusChoice& choice);
/// All of them.
void add_stylus_option(CLI::App& command, StylusChoice& choice);

}  // namespace palpate::plugin
