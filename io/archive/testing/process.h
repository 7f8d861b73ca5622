#pragma once

/// A child process of a test.

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::io::testing {

class Process {
 public:
  /// Its stdout can be read line by line. Its stderr goes to the file `log`, or is dropped if `log` is empty.
  explicit Process(const std::vector<std::string>& command, const std::filesystem::path& log = {});
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  /// Ends the process: closes its input, then SIGTERM, then after 10 s SIGKILL.
  ~Process();

  /// Waits for the next line; empty if the process ends or is silent for 10 s.
  std::string read_line();
  /// All output until the process ends, or for 10 s.
  std::string read_rest();
  pid_t id() const noexcept { return id_; }
  void signal(int number) const;
  /// Waits for the process to end and returns its exit code, or 128 + n for signal n.
  int wait();

 private:
  pid_t id_ = -1;
  int input_ = -1, output_ = -1;
  int status_ = 0;
  std::string unread_;
};

/// A TCP port of this machine on which no program listens now.
int free_port();
/// Whether a program listens on a port of this machine.
bool is_listening(int port);

}  // namespace palpate::io::testing
