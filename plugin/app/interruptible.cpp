#include "plugin/app/interruptible.h"

namespace palpate::plugin {
namespace {

volatile std::sig_atomic_t came = 0;

}  // namespace

Interruptible::Interruptible() {
  came = 0;
  struct sigaction action {};
  action.sa_handler = [](int) { came = 1; };
  sigaction(SIGINT, &action, &interrupt_before_);
  sigaction(SIGTERM, &action, &terminate_before_);
}

Interruptible::~Interruptible() {
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
}

bool Interruptible::interrupted() noexcept {
  return came != 0;
}

}  // namespace palpate::plugin
