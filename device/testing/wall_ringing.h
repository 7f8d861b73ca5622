#pragma once

/// Shared by the drivers' tests: the ringing of a wall under a fake device's hand.

#include <algorithm>

#include "device/stylus.h"

namespace palpate::device {

/// Presses on a wall of this stiffness (N/m) at y = 0, along the hand's path, and returns how far the hand still moves
/// after two seconds, m. The bench runs a stylus for some seconds under a force that is a function of its readings.
template <typename Bench, typename Hand>
double ringing_of_wall(Bench& bench, const Hand& hand, double stiffness) {
  const auto wall = [&](const Reading& reading) { return Vec3(0, std::max(0.0, -stiffness * reading.position.y), 0); };
  bench.run(2, wall);
  double lowest = 1;
  double highest = -1;
  bench.run(0.5, [&](const Reading& reading) {
    lowest = std::min(lowest, hand.body().position.y);
    highest = std::max(highest, hand.body().position.y);
    return wall(reading);
  });
  return highest - lowest;
}

}  // namespace palpate::device
