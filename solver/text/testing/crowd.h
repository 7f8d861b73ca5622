#pragma once

/// How busy a machine is: limits of time are those of one that has nothing else to do, and longer by as much.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace palpate {

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
