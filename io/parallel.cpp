#include "io/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "io/errors.h"

namespace palpate::io::internal {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work, const Progress& progress,
                  int threads) {
  if (progress && !progress(0)) throw Cancelled();
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> stop = false;
  std::exception_ptr failure;
  std::mutex failure_mutex;

  const auto run = [&](bool reports) {
    try {
      for (std::size_t i = next++; i < count && !stop; i = next++) {
        work(i);
        const std::size_t finished = ++done;
        const double part = static_cast<double>(finished) / static_cast<double>(count);
        if (reports && progress && finished < count && !progress(part)) throw Cancelled();
      }
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  };

  static const unsigned cores = std::max(1U, std::thread::hardware_concurrency());  // static: the call reads a file
  const auto wanted = static_cast<std::size_t>(threads > 0 ? threads : static_cast<int>(cores));
  {
    std::vector<std::jthread> helpers;
    for (std::size_t t = 1; t < std::min(wanted, count); ++t) helpers.emplace_back(run, false);
    run(true);
  }
  if (failure) std::rethrow_exception(failure);
  if (progress && !progress(1)) throw Cancelled();
}

}  // namespace palpate::io::internal
