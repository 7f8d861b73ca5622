#pragma once

/// How busy a machine is: limits of time are those of one that has nothing else to do, and longer by as much.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace palpate {

/// Seconds that the main thread wanted a processor and had none, since it began. More urgent programs beside it make it
/// wait for longer than their number tells. Uses what a signal handler may.
inline double waited_for_a_processor() {
  char text[64] = "";
  const int file = open("/proc/self/schedstat", O_RDONLY | O_CLOEXEC);  // ns that it ran, ns that it waited, turns
  if (file < 0) return 0;
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  char* waited = text;
  if (size > 0) std::strtod(text, &waited);
  return 1e-9 * std::strtod(waited, nullptr);
}

/// How many threads want to run for each processor, at least 1. Uses what a signal handler may.
inline double crowd() {
  char text[16] = "";
  const int file = open("/proc/loadavg", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 1;
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  return size > 0 ? std::max(1.0, std::strtod(text, nullptr) / static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN))) : 1;
}

}  // namespace palpate
