#include "device/safety/guardian.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace palpate::device {

void Guardian::dismiss() noexcept {
  if (pid_ <= 0) return;
  const char word = 'q';
  // It may have ended already; then the pipe is broken, and SIGPIPE must not end the session.
  struct sigaction ignore {};
  struct sigaction before {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &before);
  while (write(pipe_, &word, 1) < 0 && errno == EINTR) {
  }
  sigaction(SIGPIPE, &before, nullptr);
  ::close(pipe_);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = 0;
}

std::unique_ptr<Guardian> start_guardian(const GuardianSettings& settings) {
  if (settings.program.empty()) return nullptr;
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("guardian of the stylus: no pipe: ") + std::strerror(errno));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[0], STDIN_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A group of its own: Ctrl-C in a terminal goes to the session, which the guardian has to survive.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::string program = settings.program;
  std::string kind = settings.kind;
  std::string address = settings.address;
  std::array<char*, 4> arguments{program.data(), kind.data(), address.data(), nullptr};
  pid_t pid = 0;
  const int failed = posix_spawn(&pid, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  ::close(pipe_ends[0]);
  if (failed != 0) {
    ::close(pipe_ends[1]);
    throw std::runtime_error("guardian of the stylus: cannot start " + program + ": " + std::strerror(failed) +
                             "; install palpate once more, or name the program in PALPATE_GUARDIAN");
  }
  return std::make_unique<Guardian>(pid, pipe_ends[1]);
}

std::string guardian_program() {
  if (const char* named = std::getenv("PALPATE_GUARDIAN")) return named;
  std::array<char, 4096> self{};
  const ssize_t length = readlink("/proc/self/exe", self.data(), self.size() - 1);
  const std::string path(self.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
  for (const std::string& candidate :
       {path.substr(0, path.rfind('/') + 1) + "palpate-guardian", std::string(PALPATE_GUARDIAN_PATH)}) {
    if (access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return {};
}

}  // namespace palpate::device
