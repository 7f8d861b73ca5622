#pragma once

#include <cstdio>

#include "solver/text/message.h"

namespace palpate::plugin {

/// Says it on stderr, in a line of its own.
inline void tell(const Text& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
}

}  // namespace palpate::plugin
