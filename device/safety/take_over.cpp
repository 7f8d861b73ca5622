#include "device/safety/take_over.h"

#include "device/safety/zero_force.h"

namespace palpate::device {

TakeOver::Result TakeOver::look(const GuardianWatch& watch, double now) {
  if (watch.stopped_just_now()) {
    zeroed_ = told_ = false;
    began_ = next_ = now;
  }
  if (zeroed_ || now < next_) return Result::nothing_new;
  zeroed_ = try_once_();
  if (zeroed_) return Result::zeroed;
  next_ = now + pause_after(now - began_);
  if (told_ || now - began_ < unreachable_after_s) return Result::nothing_new;
  told_ = true;
  return Result::unreachable;
}

}  // namespace palpate::device
