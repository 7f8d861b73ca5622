#pragma once

#include <string>

#include "modes/messages.h"

namespace palpate::modes {

/// Throws InvalidInput that names the path in the scene and the reason.
[[noreturn]] inline void refuse(const std::string& path, const Text& why) {
  throw InvalidInput(at_place(path, why));
}

}  // namespace palpate::modes
