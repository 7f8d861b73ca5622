#include "device/simulated/hand_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "device/messages.h"
#include "device/vectors.h"

namespace palpate::device {

void check_path(std::span<const Waypoint> path) {
  if (path.empty()) throw InvalidInput(say("hand-path-has-no-waypoint"));
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string name = "waypoint " + std::to_string(i + 1) + " of the hand's path";
    if (!std::isfinite(path[i].time) || !is_finite(path[i].position)) {
      throw InvalidInput(say("waypoint-is-not-finite", name));
    }
    if (i > 0 && !(path[i].time > path[i - 1].time)) {
      throw InvalidInput(say("not-later-than-the-one-before", name));
    }
  }
}

Waypoint point_on(std::span<const Waypoint> path, PathInterpolation interpolation, double time) noexcept {
  const auto after = std::upper_bound(path.begin(), path.end(), time,
                                      [](double t, const Waypoint& waypoint) { return t < waypoint.time; });
  if (after == path.begin()) return {time, after->position, after->buttons};
  const Waypoint& from = *(after - 1);
  if (after == path.end()) return {time, from.position, from.buttons};
  double s = (time - from.time) / (after->time - from.time);
  if (interpolation == PathInterpolation::minimum_jerk) s = s * s * s * (10 + s * (6 * s - 15));
  return {time, from.position + s * (after->position - from.position), from.buttons};
}

}  // namespace palpate::device
