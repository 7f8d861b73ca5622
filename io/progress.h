#pragma once

#include <functional>

namespace palpate::io {

/// Reports the fraction done of a long piece of work: 0 to 1, ascending. Called on the thread that asked for the work,
/// several times a second if the work allows it. If it returns false, the work throws Cancelled. May be empty.
using Progress = std::function<bool(double done)>;

}  // namespace palpate::io
