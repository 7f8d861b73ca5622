#pragma once

/// Errors that a user can correct. The programs turn each into an exit code.

#include "solver/text/message.h"

namespace palpate::plugin {

/// Something in the input was refused: exit 1. The message names the file, series, primitive or device and what to do.
class InputRefused : public Refusal {
 public:
  using Refusal::Refusal;
};

/// The command was called wrongly: exit 2.
class WrongUsage : public Refusal {
 public:
  using Refusal::Refusal;
};

}  // namespace palpate::plugin
