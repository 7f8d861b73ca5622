// palpate-guardian KIND ADDRESS: waits on its standard input, a pipe from the session. A 'q' there is a session that
// closed its device itself. The end of the pipe without it is a session that died: zeros are sent.

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>

#include "device/link/realtime.h"
#include "device/safety/zero_force.h"

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("palpate-guardian KIND ADDRESS is started by palpate, never by hand\n", stderr);
    return 2;
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT}) std::signal(signal, SIG_IGN);
  palpate::device::become_realtime(70);
  char word = 0;
  ssize_t got = 0;
  while ((got = read(STDIN_FILENO, &word, 1)) < 0 && errno == EINTR) {
  }
  if (got == 1 && word == 'q') return 0;
  const double start = palpate::device::monotonic_time();
  const bool zeroed = palpate::device::send_zero_force(arguments[1], arguments[2], 2.0);
  const double took = palpate::device::monotonic_time() - start;
  std::fprintf(stderr, "palpate-guardian: the session ended without closing its stylus; %s (%s, %.0f ms)\n",
               zeroed ? "zero force was sent" : "THE STYLUS COULD NOT BE REACHED: switch it off", arguments[1],
               took * 1e3);
  return zeroed ? 0 : 1;
}
