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
  bool yes = false;    ///< asks nobody: assumes that the hand felt what the pose shows
};

/// Pushes each axis with 0.2 N after asking, says what the hand should feel, and writes the resulting settings. Throws
/// InputRefused, also if a push was not felt as announced, WrongUsage, and errors of the drivers.
void check_device(const DeviceCheck& check);
/// The same with this stylus, which is not yet open. `next_tick` waits for the next millisecond and returns its time,
/// s.
void check_device(const DeviceCheck& check, device::Stylus& stylus, const std::function<double()>& next_tick);

}  // namespace palpate::plugin
