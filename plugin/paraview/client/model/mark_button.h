#pragma once

/// The panel's mark button. It presses the stylus' button, so that ticks and recordings contain the press.

#include <optional>
#include <span>
#include <utility>

#include "plugin/app/live_session.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin {

class MarkButton {
 public:
  explicit MarkButton(LiveSession& live) : live_(live) {}

  void press() {
    letting_go_ = false;
    live_.press(mark_button);
  }
  /// Releases the button after at least one tick has seen it pressed.
  void let_go() { letting_go_ = true; }
  /// Cancels a press. The button makes no mark until a tick shows it released.
  void forget() {
    live_.press(0);
    letting_go_ = false;
    drop();
  }
  /// The clutch separates hand and patient: cancels a press, but the button may stay pressed.
  void drop() {
    presses_.drop();
    is_cut_off_ = true;
  }
  /// The mark or path of a press of this button, or of the stylus' own, that ended in this tick. `proxy_mm(tick)`: the
  /// proxy's position.
  template <typename ProxyMm>
  std::optional<MarkMade> follow(const TickRecord& tick, std::span<const PrimitiveRecord> shares,
                                 const modes::Scene& scene, const ProxyMm& proxy_mm) {
    const bool is_pressed = (tick.buttons & mark_button) != 0;
    is_cut_off_ = is_cut_off_ && is_pressed;  // ticks from before the separation may still come
    if (is_cut_off_ || (!is_pressed && !presses_.is_down())) return std::nullopt;
    if (is_pressed && std::exchange(letting_go_, false)) live_.press(0);
    return presses_.take(
        {.tick = tick, .time_s = tick.time_s, .proxy_mm = proxy_mm(tick), .shares = shares, .scene = scene});
  }

 private:
  LiveSession& live_;
  MarkPresses presses_;
  bool letting_go_ = false;
  bool is_cut_off_ = false;
};

}  // namespace palpate::plugin
