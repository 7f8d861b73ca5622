#include "device/stylus.h"

namespace palpate::device {

const char* name_of(State state) {
  switch (state) {
    case State::disconnected:
      return "disconnected";
    case State::idle:
      return "idle";
    case State::homing:
      return "homing";
    case State::ramping:
      return "ramping";
    case State::active:
      return "active";
    case State::fault:
      return "fault";
  }
  return "unknown";
}

}  // namespace palpate::device
