#include "device/safety/guardian.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "device/link/driver_clock.h"
#include "device/messages.h"
#include "device/safety/guardian_watch.h"

namespace palpate::device {

namespace {

constexpr int beat_descriptor = 3;  // of the guardian

struct SharedMemory {
  int descriptor;
  GuardianBeat* beat = nullptr;
};

SharedMemory share_beat() {
  SharedMemory shared{.descriptor = memfd_create("palpate-beat", MFD_CLOEXEC)};
  if (shared.descriptor < 0 || ftruncate(shared.descriptor, sizeof(GuardianBeat)) != 0) return shared;
  void* const memory = mmap(nullptr, sizeof(GuardianBeat), PROT_READ | PROT_WRITE, MAP_SHARED, shared.descriptor, 0);
  if (memory != MAP_FAILED) shared.beat = new (memory) GuardianBeat;
  return shared;
}

}  // namespace

bool Guardian::has_ended() const noexcept {
  siginfo_t ended{};
  return waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid == pid_;
}

template <typename Holds>
void Guardian::wait_until(const Holds& holds, double patience) const {
  for (const double start = monotonic_time(); !holds(); sleep_seconds(1e-3)) {
    if (pid_ > 0 && has_ended()) throw Refusal(say("guardian-of-the-stylus-ended", program_));
    if (monotonic_time() - start > patience) throw Refusal(say("guardian-of-the-stylus-proves-nothing", program_));
  }
}

void Guardian::prove(double patience) const {
  wait_until([&] { return shared_->proof.load() == proof_for(shared_->challenge); }, patience);
}

GuardianReach Guardian::reach(double patience) const {
  wait_until([&] { return shared_->reach.load() != GuardianReach::untold; }, patience);
  const GuardianReach reach = shared_->reach.load();
  if (reach == GuardianReach::none) throw Refusal(say("guardian-of-the-stylus-reaches-nothing", program_));
  return reach;
}

Text Guardian::describe() const {
  const auto ms = shared_->zero_within_ms.load();
  switch (shared_->reach.load()) {
    case GuardianReach::at_any_time:
      return say("guardian-reaches-it-at-any-time", ms, ms + GuardianWatch::stopped_after_ms);
    case GuardianReach::once_free:
      return say("guardian-reaches-it-once-free", ms);
    case GuardianReach::looks_on:
      return say("guardian-looks-on");
    case GuardianReach::untold:
    case GuardianReach::none:
      break;
  }
  return {};
}

bool Guardian::wait_for_end(double patience) const noexcept {
  const double start = monotonic_time();
  for (;;) {
    const pid_t ended = waitpid(pid_, nullptr, WNOHANG);
    if (ended == pid_ || (ended < 0 && errno != EINTR)) return true;
    if (monotonic_time() - start >= patience) return false;
    sleep_seconds(0.5e-3);
  }
}

void Guardian::end(char word) noexcept {
  if (pid_ <= 0) return;
  // It may have ended already; then the pipe is broken, and SIGPIPE must not end the session.
  struct sigaction ignore {};
  struct sigaction before {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &before);
  while (write(pipe_, &word, 1) < 0 && errno == EINTR) {
  }
  sigaction(SIGPIPE, &before, nullptr);
  ::close(pipe_);
  // One that is stuck in a maker's library is ended, but not where a force may be left: its word waits for it.
  constexpr double killed_within_s = 0.2;
  if (!wait_for_end(end_within_s - killed_within_s) && word == 'q') {
    kill(pid_, SIGKILL);
    wait_for_end(killed_within_s);
  }
  pid_ = 0;
  munmap(shared_, sizeof(GuardianBeat));
}

std::unique_ptr<Guardian> start_guardian(const GuardianSettings& settings) {
  if (settings.program.empty()) return nullptr;
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) {
    throw Refusal(say("guardian-of-the-stylus-no-pipe", std::strerror(errno)));
  }
  const SharedMemory shared = share_beat();
  if (shared.beat == nullptr) {
    if (shared.descriptor >= 0) ::close(shared.descriptor);
    for (const int end : pipe_ends) ::close(end);
    throw Refusal(say("guardian-of-the-stylus-no-shared-memory", std::strerror(errno)));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, shared.descriptor, beat_descriptor);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A group of its own: Ctrl-C in a terminal goes to the session, which the guardian has to survive.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::string program = settings.program;
  std::string kind = settings.kind;
  std::string address = settings.address;
  std::array<char*, 4> arguments{program.data(), kind.data(), address.data(), nullptr};
  pid_t pid = 0;
  shared.beat->challenge = std::random_device()();
  const int failed = posix_spawn(&pid, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  ::close(pipe_ends[0]);
  ::close(shared.descriptor);
  if (failed != 0) {
    ::close(pipe_ends[1]);
    munmap(shared.beat, sizeof(GuardianBeat));
    throw Refusal(say("guardian-of-the-stylus-cannot-start", program, std::strerror(failed)));
  }
  return std::make_unique<Guardian>(pid, pipe_ends[1], shared.beat, program);
}

bool guardian_can_leave_group() {
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
  return runtime != nullptr && access((std::string(runtime) + "/systemd/private").c_str(), F_OK) == 0;
}

namespace {

std::string running_program() {
  std::error_code failed;
  return std::filesystem::read_symlink("/proc/self/exe", failed);
}

/// Of the file that this code was loaded from: the program, or the plug-in in another's.
std::string own_file() {
  Dl_info info{};
  dladdr(reinterpret_cast<const void*>(&guardian_program), &info);
  std::error_code failed;
  const auto file = std::filesystem::weakly_canonical(info.dli_fname != nullptr ? info.dli_fname : "", failed);
  return failed ? std::string() : file.string();
}

}  // namespace

std::vector<std::string> guardian_candidates(const std::string& program, const std::string& loaded_from,
                                             const std::string& installed) {
  const std::filesystem::path beside = std::filesystem::path(loaded_from).parent_path();
  std::vector<std::string> candidates{std::filesystem::path(program).parent_path() / "palpate-guardian",
                                      beside / "palpate-guardian"};
  for (std::filesystem::path at = beside; at.has_relative_path(); at = at.parent_path()) {
    candidates.push_back(at / "bin/palpate-guardian");
    candidates.push_back(at / "libexec/palpate/palpate-guardian");
  }
  candidates.push_back(installed);
  return candidates;
}

std::string guardian_program() {
  if (const char* named = std::getenv("PALPATE_GUARDIAN")) return named;
  for (const std::string& candidate : guardian_candidates(running_program(), own_file(), PALPATE_GUARDIAN_PATH)) {
    if (access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return {};
}

}  // namespace palpate::device
