#pragma once

#include <cstddef>
#include <functional>

#include "io/progress.h"

namespace palpate::io::internal {

/// work(0) ... work(count - 1) on `threads` threads (0: all cores), the caller's among them; each index once, in no
/// order. Rethrows the first exception of `work` after all threads have stopped; throws Cancelled when `progress` says
/// so.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work, const Progress& progress,
                  int threads);

}  // namespace palpate::io::internal
