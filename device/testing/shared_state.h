#pragma once

/// The memory of a fake library's device: a file that several processes map, or this process's own. Every process that
/// loads the library then has the same device.

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <new>

namespace palpate::device {

/// The state in the file that the environment variable names; a new file gets the initial state. Without the variable,
/// this process's own state.
template <typename State>
State& shared_state(const char* variable) {
  static State own;
  const char* const file = std::getenv(variable);
  if (file == nullptr) return own;
  const int node = open(file, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (node < 0) return own;
  const bool is_new = lseek(node, 0, SEEK_END) < static_cast<off_t>(sizeof(State));
  void* memory = MAP_FAILED;
  if (!is_new || ftruncate(node, sizeof(State)) == 0) {
    memory = mmap(nullptr, sizeof(State), PROT_READ | PROT_WRITE, MAP_SHARED, node, 0);
  }
  close(node);
  if (memory == MAP_FAILED) return own;
  return is_new ? *new (memory) State : *static_cast<State*>(memory);
}

}  // namespace palpate::device
