// palpate-guardian KIND ADDRESS: waits on its standard input, a pipe from the session. A 'q' there is a session that
// closed its device itself, a 'w' one whose device is gone. The end of the pipe without either is a session that died:
// zeros are sent. Descriptor 3 is memory where the session counts its exchanges with the device: a count that stands
// still while there is a force is a session that was stopped.

#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>

#include "device/link/realtime.h"
#include "device/messages.h"
#include "device/safety/guardian.h"
#include "device/safety/guardian_watch.h"
#include "device/safety/zero_force.h"

namespace {

using palpate::device::GuardianBeat;
using palpate::device::GuardianWatch;

constexpr int beat_descriptor = 3;
constexpr double wait_for_device = 60.0;  // s

void tell(bool stopped, const char* kind, bool zeroed, double begun) {
  using palpate::device::say;
  const palpate::Text force = zeroed ? say("zero-force-was-sent") : say("stylus-could-not-be-reached");
  const palpate::Text text = stopped ? say("palpate-guardian-the-session-stands-still-while", force)
                                     : say("palpate-guardian-the-session-ended-without-closing", force);
  std::fprintf(stderr, "%s (%s, %.0f ms)\n", text.c_str(), kind, (palpate::device::monotonic_time() - begun) * 1e3);
}

const GuardianBeat* session_beat() {
  void* const memory = mmap(nullptr, sizeof(GuardianBeat), PROT_READ, MAP_SHARED, beat_descriptor, 0);
  return memory == MAP_FAILED ? nullptr : static_cast<const GuardianBeat*>(memory);
}

/// Takes the force from a session that stands still: once, or until the device can be reached.
class Taker {
 public:
  Taker(const char* kind, const char* address) : kind_(kind), address_(address) {}
  void take_from(const GuardianWatch& watch) {
    if (watch.stopped_just_now()) zeroed_ = told_ = false;
    if (zeroed_) return;
    const double begun = palpate::device::monotonic_time();
    zeroed_ = palpate::device::send_zero_force(kind_, address_, 0.5, true);
    if (zeroed_ || !told_) tell(true, kind_, zeroed_, begun);
    told_ = true;
  }

 private:
  const char* kind_;
  const char* address_;
  bool zeroed_ = false, told_ = false;
};

/// 'q', 'w', or 0 for the end of the pipe.
char wait_for_word(const char* kind, const char* address) {
  GuardianWatch watch(session_beat());
  Taker taker(kind, address);
  for (;;) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const int ready = poll(&input, 1, GuardianWatch::look_every_ms);
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) {
      if (watch.stopped()) taker.take_from(watch);
      continue;
    }
    char word = 0;
    const ssize_t got = read(STDIN_FILENO, &word, 1);
    if (got < 0 && errno == EINTR) continue;
    return got == 1 ? word : '\0';
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "%s\n", palpate::device::say("palpate-guardian-kind-address-is-started").c_str());
    return 2;
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT, SIGTSTP}) std::signal(signal, SIG_IGN);
  palpate::device::become_realtime(70);
  const char* const kind = arguments[1];
  const char* const address = arguments[2];
  const char word = wait_for_word(kind, address);
  if (word == 'q') return 0;
  if (word == 'w') {
    // The session waits for this process only, not for what goes on in its child.
    if (fork() != 0) return 0;
    palpate::device::send_zero_force(kind, address, wait_for_device);
    return 0;
  }
  const double begun = palpate::device::monotonic_time();
  const bool zeroed = palpate::device::send_zero_force(kind, address, 2.0);
  tell(false, kind, zeroed, begun);
  return zeroed ? 0 : 1;
}
