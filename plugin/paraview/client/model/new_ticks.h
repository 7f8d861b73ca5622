#pragma once

/// Reads the ticks written since the last poll, one after the other, and the buttons that changed in any of them. So a
/// short press counts even if the polling thread was busy.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "plugin/session/tick_ring.h"

namespace palpate::plugin {

class NewTicks {
 public:
  struct Buttons {
    std::uint32_t pressed = 0, let = 0;
  };

  /// Another session: continues with its first tick.
  void restart() { *this = {}; }
  /// The same session has restarted, and counts its ticks from 0 again.
  void count_anew() { next_ = 0; }
  /// Calls `each(pressed)` with every new tick in `tick` and its primitives in `shares`; `pressed`: the buttons that it
  /// presses together.
  template <typename Each>
  Buttons read(const TickRing& ring, TickRecord& tick, std::vector<PrimitiveRecord>& shares, const Each& each) {
    Buttons changed;
    const std::uint64_t written = ring.written();
    next_ = std::max(next_, ring.oldest());
    for (; next_ < written; ++next_) {
      shares.clear();
      if (!ring.read(next_, tick, &shares)) continue;
      const std::uint32_t pressed = tick.buttons & ~buttons_;
      changed.pressed |= pressed;
      changed.let |= buttons_ & ~tick.buttons;
      buttons_ = tick.buttons;
      each(pressed);
    }
    return changed;
  }

 private:
  std::uint64_t next_ = 0;
  std::uint32_t buttons_ = 0;
};

}  // namespace palpate::plugin
