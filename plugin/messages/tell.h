#pragma once

#include <cstdio>

#include "solver/text/message.h"
#include "solver/text/printable.h"

namespace palpate::plugin {

/// Prints the text on stderr, on a line of its own, with control characters made visible.
inline void tell(const Text& text) {
  std::fprintf(stderr, "%s\n", printable(text).c_str());
}

}  // namespace palpate::plugin
