#pragma once

/// For tests: catches what a servo tick may not do. While a thread is trapped, its allocations, frees, locks and waits
/// are counted, and so is every system call, by the kernel itself (syscall user dispatch, Linux 5.11 or newer); a
/// trapped system call fails with ENOSYS and leaves the trap open for the rest of the tick.

#include <string>

namespace palpate::device {

struct TrapCounts {
  int allocations = 0;  ///< malloc, calloc, realloc, operator new
  int frees = 0;
  int locks = 0;  ///< pthread mutexes, read-write locks, conditions, semaphores
  int system_calls = 0;
  long last_system_call = -1;  ///< its number
};

/// From here to the end of its life, of the thread that made it. One at a time in a thread.
class TickTrap {
 public:
  TickTrap() noexcept;
  TickTrap(const TickTrap&) = delete;
  TickTrap& operator=(const TickTrap&) = delete;
  ~TickTrap();
};

/// Once in every thread that will be trapped; false if this kernel cannot trap system calls: then only the rest is
/// counted.
bool prepare_tick_trap() noexcept;
/// Of the calling thread, since it began.
const TrapCounts& trap_counts() noexcept;
/// "2 allocations, 1 lock", or empty if nothing was caught.
std::string describe(const TrapCounts& counts);

}  // namespace palpate::device
