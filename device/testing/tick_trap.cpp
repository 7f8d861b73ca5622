#include "device/testing/tick_trap.h"

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/prctl.h>

#include <csignal>
#include <cstddef>

#ifndef PR_SET_SYSCALL_USER_DISPATCH
#define PR_SET_SYSCALL_USER_DISPATCH 59
#define PR_SYS_DISPATCH_ON 1
#endif

namespace {

constexpr char allow = 0;
constexpr char block = 1;

thread_local bool trapped = false;
thread_local bool prepared = false;
thread_local volatile char selector = allow;  // read by the kernel at every system call of the thread
thread_local palpate::device::TrapCounts counts;

void on_system_call(int /*signal*/, siginfo_t* info, void* /*context*/) {
  selector = allow;  // the return from here is a system call, too
  ++counts.system_calls;
  counts.last_system_call = info->si_syscall;
}

void count(int& what) {
  if (trapped) ++what;
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// In place of the C library's: the same, counted.
extern "C" {
void* __libc_malloc(std::size_t size);                      // NOLINT: glibc's names
void* __libc_calloc(std::size_t number, std::size_t size);  // NOLINT
void* __libc_realloc(void* memory, std::size_t size);       // NOLINT
void __libc_free(void* memory);                             // NOLINT

void* malloc(std::size_t size) {
  count(counts.allocations);
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count(counts.allocations);
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  count(counts.allocations);
  return __libc_realloc(memory, size);
}
void free(void* memory) {
  count(counts.frees);
  __libc_free(memory);
}
int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static const auto real = next<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
  count(counts.locks);
  return real(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  static const auto real = next<int (*)(pthread_mutex_t*)>("pthread_mutex_trylock");
  count(counts.locks);
  return real(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) {
  static const auto real = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  count(counts.locks);
  return real(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) {
  static const auto real = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  count(counts.locks);
  return real(lock);
}
int pthread_cond_signal(pthread_cond_t* condition) {
  static const auto real = next<int (*)(pthread_cond_t*)>("pthread_cond_signal");
  count(counts.locks);
  return real(condition);
}
int pthread_cond_broadcast(pthread_cond_t* condition) {
  static const auto real = next<int (*)(pthread_cond_t*)>("pthread_cond_broadcast");
  count(counts.locks);
  return real(condition);
}
int sem_post(sem_t* semaphore) {
  static const auto real = next<int (*)(sem_t*)>("sem_post");
  count(counts.locks);
  return real(semaphore);
}
int sem_wait(sem_t* semaphore) {
  static const auto real = next<int (*)(sem_t*)>("sem_wait");
  count(counts.locks);
  return real(semaphore);
}
}

namespace palpate::device {

TickTrap::TickTrap() noexcept {
  trapped = true;
  if (prepared) selector = block;
}

TickTrap::~TickTrap() {
  selector = allow;
  trapped = false;
}

bool prepare_tick_trap() noexcept {
  struct sigaction action {};
  action.sa_sigaction = on_system_call;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSYS, &action, nullptr);
  prepared = prctl(PR_SET_SYSCALL_USER_DISPATCH, PR_SYS_DISPATCH_ON, 0, 0, &selector) == 0;
  return prepared;
}

const TrapCounts& trap_counts() noexcept {
  return counts;
}

std::string describe(const TrapCounts& caught) {
  std::string text;
  const auto add = [&](int number, const char* what) {
    if (number > 0) text += (text.empty() ? "" : ", ") + std::to_string(number) + " " + what;
  };
  add(caught.allocations, "allocations");
  add(caught.frees, "frees");
  add(caught.locks, "locks");
  add(caught.system_calls, "system calls");
  if (caught.system_calls > 0) text += " (the last is number " + std::to_string(caught.last_system_call) + ")";
  return text;
}

}  // namespace palpate::device
