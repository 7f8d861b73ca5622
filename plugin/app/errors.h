#pragma once

/// What goes wrong for a user's reasons. The programs turn each into an exit code.

#include <stdexcept>

namespace palpate::plugin {

/// Something in the input was refused: exit 1. The message names the file, series, primitive or device and what to do.
class InputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The command was called wrongly: exit 2.
class WrongUsage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate::plugin
