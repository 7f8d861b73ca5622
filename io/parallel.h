#pragma once

#include <cstddef>
#include <functional>

#include "io/progress.h"

namespace palpate::io::internal {

/// Calls work(0) ... work(count - 1), each once and in no fixed order, on `threads` threads (0: all cores), one of
/// which is the caller's. Rethrows the first exception of `work` after all threads have stopped. Throws Cancelled if
/// `progress` returns false.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work, const Progress& progress,
                  int threads);

}  // namespace palpate::io::internal
