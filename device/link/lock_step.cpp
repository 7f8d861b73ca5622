#include "device/link/lock_step.h"

#include <algorithm>

namespace palpate::device {

bool LockStep::is_due(double now) noexcept {
  if (owed_ == 0) return true;
  const bool waits =
      misses_others_ ? now - std::max(last_sent_, last_answer_) < longest_way : now - last_sent_ < times_.overdue;
  if (waits) return false;
  if (misses_others_) owed_ = 0;
  misses_others_ = false;
  on_time_ = 0;
  return true;
}

void LockStep::sent(double now) noexcept {
  // Where there is no room the newest is left out: the answers then seem older than they are.
  if (owed_ < sent_.size()) sent_[owed_++] = now;
  last_sent_ = now;
}

void LockStep::answered(std::uint64_t count, double now) noexcept {
  if (count == 0) return;
  last_answer_ = now;
  bool is_on_time = times_.speaks_unasked;
  if (count > owed_) {
    owed_ = 0;
  } else {
    is_on_time = count == owed_ && now - sent_[count - 1] < times_.overdue;
    std::copy(sent_.begin() + static_cast<std::ptrdiff_t>(count), sent_.end(), sent_.begin());
    owed_ -= count;
  }
  on_time_ = is_on_time ? std::min(on_time_ + 1, enough_on_time) : 0;
  misses_others_ = owed_ > 0;
}

}  // namespace palpate::device
