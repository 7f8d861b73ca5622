#pragma once

/// How busy the machine is. Tests' time limits are for an idle machine, and grow in proportion.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace palpate {

/// Seconds that the main thread has waited for a processor since it began. It waits longer than the number of threads
/// suggests if others have a higher priority. Uses only what a signal handler may.
inline double waited_for_a_processor() {
  char text[64] = "";
  const int file = open("/proc/self/schedstat", O_RDONLY | O_CLOEXEC);  // ns of running, ns of waiting, turns
  if (file < 0) return 0;
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  char* waited = text;
  if (size > 0) std::strtod(text, &waited);
  return 1e-9 * std::strtod(waited, nullptr);
}

/// The number of runnable threads for each processor, at least 1. Uses only what a signal handler may.
inline double crowd() {
  char text[16] = "";
  const int file = open("/proc/loadavg", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 1;
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  return size > 0 ? std::max(1.0, std::strtod(text, nullptr) / static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN))) : 1;
}

}  // namespace palpate
