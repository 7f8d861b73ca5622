#pragma once

/// A program that a test starts and ends, by its id.

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::io::testing {

class Process {
 public:
  /// Its stdout can be read line by line; its stderr goes to the file `log`, or is dropped where `log` is empty.
  explicit Process(const std::vector<std::string>& command, const std::filesystem::path& log = {});
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  /// Ends it: its input ends, then SIGTERM, then after 10 s SIGKILL.
  ~Process();

  /// Waits for the next line; empty where it ends or says nothing for 10 s.
  std::string read_line();
  /// All that it says until it ends or for 10 s.
  std::string read_rest();
  pid_t id() const noexcept { return id_; }
  void signal(int number) const;
  /// Waits for its end and returns its exit code, 128 + n for signal n.
  int wait();

 private:
  pid_t id_ = -1;
  int input_ = -1, output_ = -1;
  int status_ = 0;
  std::string unread_;
};

/// A TCP port of this machine that nobody listens on now.
int free_port();
/// Whether somebody listens on a port of this machine.
bool is_listening(int port);

}  // namespace palpate::io::testing
