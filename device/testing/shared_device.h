#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace palpate::device {

/// The state of a fake library's device, as stored in a file.
template <typename State>
class SharedDevice {
 public:
  explicit SharedDevice(const std::string& file) {
    State first;
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(&first), sizeof first);
    const int node = open(file.c_str(), O_RDWR | O_CLOEXEC);
    memory_ = mmap(nullptr, sizeof(State), PROT_READ | PROT_WRITE, MAP_SHARED, node, 0);
    close(node);
  }
  SharedDevice(const SharedDevice&) = delete;
  SharedDevice& operator=(const SharedDevice&) = delete;
  ~SharedDevice() { munmap(memory_, sizeof(State)); }
  volatile State* operator->() const { return static_cast<volatile State*>(memory_); }

 private:
  void* memory_;
};

}  // namespace palpate::device
