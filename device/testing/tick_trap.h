#pragma once

/// For tests: detects operations that a servo tick may not do. While a thread is trapped, its allocations, frees, locks
/// and waits are counted, and so is every system call, by the kernel itself (syscall user dispatch, Linux 5.11 or
/// newer). A trapped system call fails with ENOSYS and leaves the trap open for the rest of the tick.

#include <string>

namespace palpate::device {

struct TrapCounts {
  int allocations = 0;  ///< malloc, calloc, realloc, operator new
  int frees = 0;
  int locks = 0;  ///< pthread mutexes, read-write locks, conditions, semaphores
  int system_calls = 0;
  long last_system_call = -1;  ///< its number
};

/// Traps the thread that made it until it is destroyed. One at a time in a thread.
class TickTrap {
 public:
  TickTrap() noexcept;
  TickTrap(const TickTrap&) = delete;
  TickTrap& operator=(const TickTrap&) = delete;
  ~TickTrap();
};

/// To be called once in every thread that will be trapped. False if this kernel cannot trap system calls: then only the
/// rest is counted.
bool prepare_tick_trap() noexcept;
/// Counts of the calling thread, since its trap began.
const TrapCounts& trap_counts() noexcept;
/// "2 allocations, 1 lock", or empty if nothing was caught.
std::string describe(const TrapCounts& counts);

}  // namespace palpate::device
