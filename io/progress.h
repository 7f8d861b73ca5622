#pragma once

#include <functional>

namespace palpate::io {

/// Told how much of a long piece of work is done, 0 to 1, ascending. Called on the thread that asked for the work,
/// several times a second where the work allows; returning false cancels it, and it throws Cancelled. An empty one is
/// never called.
using Progress = std::function<bool(double done)>;

}  // namespace palpate::io
