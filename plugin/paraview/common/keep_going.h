#pragma once

#include <functional>

#include "io/errors.h"

namespace palpate::plugin {

/// Called by long work, at least every few milliseconds, on the thread that works. False: nobody wants the work any
/// more. May be empty.
using KeepGoing = std::function<bool()>;

/// Throws io::Cancelled if the work is not wanted any more.
inline void check_wanted(const KeepGoing& keep_going) {
  if (keep_going && !keep_going()) throw io::Cancelled();
}

}  // namespace palpate::plugin
