#pragma once

#include <string>

#include "modes/messages.h"

namespace palpate::modes {

/// Refuses a scene for what stands at the path.
[[noreturn]] inline void refuse(const std::string& path, const Text& why) {
  throw InvalidInput(at_place(path, why));
}

}  // namespace palpate::modes
