#pragma once

/// Where the device behind a fake library lives: in a file that several processes map, or in this process alone. A
/// device is there for every process that loads its library.

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <new>

namespace palpate::device {

/// The state in the file that the environment variable names; a file that is new has it as it is made. Without the
/// variable, one of this process.
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
