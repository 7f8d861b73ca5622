// palpate-guardian KIND ADDRESS: waits on its standard input, a pipe from the session. A 'q' there is a session that
// closed its device itself, a 'w' one whose device is gone. The end of the pipe without either is a session that died:
// zeros are sent. Descriptor 3 is memory that both share (GuardianBeat). There the session counts its exchanges with
// the device: a count that stands still while there is a force is a session that was stopped. The guardian proves
// itself there, says what it can do for the device, and counts its looks.

#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>

#include "device/device_type.h"
#include "device/link/realtime.h"
#include "device/messages.h"
#include "device/safety/guardian_beat.h"
#include "device/safety/guardian_watch.h"
#include "device/safety/login_manager.h"
#include "device/safety/take_over.h"
#include "device/safety/zero_force.h"

namespace {

using namespace palpate::device;

constexpr int beat_descriptor = 3;
constexpr double asks_after = 2.0;  // s in vain, after which the user is asked to switch the device off

struct Device {
  const char* kind;
  const char* address;
};

void tell(bool stopped, const Device& device, bool zeroed, double begun) {
  const palpate::Text force = zeroed ? say("zero-force-was-sent") : say("stylus-could-not-be-reached");
  const palpate::Text text = stopped ? say("palpate-guardian-the-session-stands-still-while", force)
                                     : say("palpate-guardian-the-session-ended-without-closing", force);
  std::fprintf(stderr, "%s (%s, %.0f ms)\n", text.c_str(), device.kind, (monotonic_time() - begun) * 1e3);
}

/// Null where none is shared, or another program's.
GuardianBeat* session_beat() {
  struct stat shared {};
  if (fstat(beat_descriptor, &shared) != 0 || shared.st_size < static_cast<off_t>(sizeof(GuardianBeat))) return nullptr;
  void* const memory = mmap(nullptr, sizeof(GuardianBeat), PROT_READ | PROT_WRITE, MAP_SHARED, beat_descriptor, 0);
  return memory == MAP_FAILED ? nullptr : static_cast<GuardianBeat*>(memory);
}

/// Loads what a zero takes, before it is needed.
void prove_and_prepare(const Device& device, GuardianBeat& beat) {
  beat.proof = proof_for(beat.challenge);
  const DeviceType* const type = find_device_type(device.kind);
  GuardianMeans means;
  if (type != nullptr && type->prepare_zeros != nullptr) means = type->prepare_zeros(device.address);
  beat.zero_within_ms = static_cast<std::uint32_t>(means.zero_within_s * 1e3);
  beat.reach = means.reach;
}

/// The machine sleeps once no force is left: as soon as the session has seen to it, or this process.
void see_to_sleep(LoginManager& login, GuardianBeat& beat, bool taken_over) {
  login.look();
  beat.sleep_is_near = login.sleep_is_near();
  if (login.sleep_is_near() && (taken_over || beat.on_device == OnDevice::zero_taken)) login.let_sleep();
}

/// 'q', 'w', or 0 for the end of the pipe.
char wait_for_word(const Device& device, GuardianBeat* beat) {
  LoginManager login;
  GuardianWatch watch(beat);
  TakeOver take_over([&] { return try_zero_force(device.kind, device.address, true); });
  double begun = 0;
  bool taken_over = false;
  for (;;) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const int ready = poll(&input, 1, GuardianWatch::look_every_ms);
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) {
      if (beat != nullptr) ++beat->lives;
      const bool stopped = watch.stopped();
      if (watch.stopped_just_now()) begun = monotonic_time();
      if (stopped) {
        const TakeOver::Result result = take_over.look(watch, monotonic_time());
        taken_over = result == TakeOver::Result::zeroed || (taken_over && !watch.stopped_just_now());
        if (result != TakeOver::Result::nothing_new) tell(true, device, taken_over, begun);
      }
      if (beat != nullptr) see_to_sleep(login, *beat, stopped && taken_over);
      continue;
    }
    char word = 0;
    const ssize_t got = read(STDIN_FILENO, &word, 1);
    if (got < 0 && errno == EINTR) continue;
    return got == 1 ? word : '\0';
  }
}

/// Until the device is back, or the user logs out.
bool wait_for_device(const Device& device, const Login& login) {
  std::signal(SIGTERM, SIG_DFL);  // the end of the user's session
  return keep_trying([&] { return try_zero_force(device.kind, device.address); },
                     [&](double waited) { return login.is_over(waited); });
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "%s\n", say("palpate-guardian-kind-address-is-started").c_str());
    return 2;
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT, SIGTSTP}) std::signal(signal, SIG_IGN);
  become_realtime(70);
  const Device device{arguments[1], arguments[2]};
  const Login login;
  GuardianBeat* const beat = session_beat();
  if (beat != nullptr) prove_and_prepare(device, *beat);
  const char word = wait_for_word(device, beat);
  if (word == 'q') return 0;
  if (word == 'w') {
    // The session waits for this process, and may then open the device again. So one that is there is seen to first; a
    // child waits for one that is not.
    const bool zeroed = try_zero_force(device.kind, device.address);
    return zeroed || fork() != 0 || wait_for_device(device, login) ? 0 : 1;
  }
  const double begun = monotonic_time();
  const bool zeroed = send_zero_force(device.kind, device.address, asks_after);
  tell(false, device, zeroed, begun);
  return zeroed || wait_for_device(device, login) ? 0 : 1;
}
