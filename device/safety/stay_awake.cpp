#include "device/safety/stay_awake.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>

namespace palpate::device {

StayAwake::~StayAwake() {
  // The command that it runs ends with its input. It may be waiting for a bus that does not answer: it is ended, too.
  ::close(pipe_);
  kill(pid_, SIGTERM);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::unique_ptr<StayAwake> stay_awake(const std::string& device) noexcept {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return nullptr;
  pid_t pid = 0;
  bool started = false;
  try {
    std::array<std::string, 6> words{"systemd-inhibit", "--what=sleep:idle", "--mode=block",
                                     "--who=Palpate",   "--why=" + device,   "cat"};
    std::array<char*, 7> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    started = posix_spawnp(&pid, words[0].c_str(), &actions, nullptr, arguments.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[0]);
    if (started) return std::make_unique<StayAwake>(pid, ends[1]);
  } catch (const std::exception&) {
    ::close(ends[0]);
  }
  ::close(ends[1]);
  return nullptr;
}

}  // namespace palpate::device
