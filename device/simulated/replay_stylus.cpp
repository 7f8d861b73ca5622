#include "device/simulated/replay_stylus.h"

#include <algorithm>
#include <stdexcept>

#include "device/messages.h"

namespace palpate::device {

ReplayStylus::ReplayStylus(std::span<const Reading> readings, const Specification& recorded)
    : readings_(readings), specification_(recorded) {
  specification_.name = recorded.name.empty() ? "replay" : "replay of " + recorded.name;
}

ReplayStylus::ReplayStylus(std::span<const Reading> readings, std::span<const State> states,
                           const Specification& recorded)
    : ReplayStylus(readings, recorded) {
  if (states.size() != readings.size()) {
    throw std::logic_error(specification_.name + ": as many states as poses are needed");
  }
  states_ = states;
}

State ReplayStylus::state() const noexcept {
  if (states_.empty() || state_ == State::disconnected) return state_;
  return states_[std::min(next_, states_.size() - 1)];
}

void ReplayStylus::open() {
  if (readings_.empty()) throw Refusal(say("no-poses-record-a-session-first", specification_.name));
  next_ = 0;
  last_force_ = Vec3(0);
  state_ = State::idle;
}

void ReplayStylus::close() noexcept {
  last_force_ = Vec3(0);
  state_ = State::disconnected;
}

Reading ReplayStylus::read() noexcept {
  if (readings_.empty()) return {};
  if (!finished()) return readings_[next_];
  Reading last = readings_.back();
  last.fresh = false;
  return last;
}

void ReplayStylus::write_force(const Vec3& force) noexcept {
  last_force_ = force;
  if (!finished()) ++next_;
}

}  // namespace palpate::device
