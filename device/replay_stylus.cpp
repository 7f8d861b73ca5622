#include "palpate/device/replay_stylus.h"

#include <stdexcept>

namespace palpate::device {

ReplayStylus::ReplayStylus(std::span<const Reading> readings, const Specification& recorded)
    : readings_(readings), specification_(recorded) {
  specification_.name = recorded.name.empty() ? "replay" : "replay of " + recorded.name;
}

void ReplayStylus::open() {
  if (readings_.empty()) throw std::runtime_error(specification_.name + ": no poses; record a session first");
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
