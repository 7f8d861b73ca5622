#pragma once

#include <functional>
#include <string>

#include "device/stylus.h"
#include "plugin/app/stylus_choice.h"

namespace palpate::plugin {

/// `palpate devices --check`.
struct DeviceCheck {
  StylusChoice stylus;
  std::string output;  ///< the settings file; empty: <kind>-settings.json here
  bool yes = false;    ///< nobody is asked: what the pose says is taken for what the hand felt
};

/// Pushes each axis with 0.2 N after asking, says what the hand should feel, and writes the settings that it found.
/// Throws InputRefused, also where not every push was felt where it was said, WrongUsage, and what the drivers throw.
void check_device(const DeviceCheck& check);
/// The same on this stylus, which is not open yet. `next_tick` waits for the next millisecond and returns its time, s.
void check_device(const DeviceCheck& check, device::Stylus& stylus, const std::function<double()>& next_tick);

}  // namespace palpate::plugin
