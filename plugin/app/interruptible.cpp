#include "plugin/app/interruptible.h"

#include <utility>

namespace palpate::plugin {
namespace {

volatile std::sig_atomic_t came = 0;
bool exists = false;

}  // namespace

Interruptible::Interruptible() : is_outermost_(!std::exchange(exists, true)) {
  if (!is_outermost_) return;
  came = 0;
  struct sigaction action {};
  action.sa_handler = [](int) { came = 1; };
  sigaction(SIGINT, &action, &interrupt_before_);
  sigaction(SIGTERM, &action, &terminate_before_);
  sigaction(SIGHUP, &action, &hang_up_before_);
  if (hang_up_before_.sa_handler == SIG_IGN) sigaction(SIGHUP, &hang_up_before_, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, &pipe_before_);
}

Interruptible::~Interruptible() {
  if (!is_outermost_) return;
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
  sigaction(SIGHUP, &hang_up_before_, nullptr);
  sigaction(SIGPIPE, &pipe_before_, nullptr);
  exists = false;
}

bool Interruptible::interrupted() noexcept {
  return came != 0;
}

}  // namespace palpate::plugin
