#pragma once

#include <functional>

namespace palpate::io {

/// A callback that is told how much of a long piece of work is done: 0 to 1, ascending. It is called on the thread that
/// asked for the work, several times a second if the work allows it. If it returns false, the work throws Cancelled. It
/// may be empty.
using Progress = std::function<bool(double done)>;

}  // namespace palpate::io
