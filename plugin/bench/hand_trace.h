#pragma once

/// A simulated hand that traces the edge of an organ on a screen: with tremor, drift and the error of aiming at a
/// pixel, with a stylus that holds it at the scan's edge, or without forces.

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "io/volume.h"
#include "modes/scene/scene.h"

namespace palpate::plugin {

namespace hand {
inline constexpr double pixel_mm = 0.5;   // of a screen on which a slice of 256 mm is 512 pixels wide
inline constexpr double speed_mm_s = 20;  // along the edge
inline constexpr double tremor_mm = 0.2, drift_mm = 1;
inline constexpr double press_mm = 1.5;   // target depth behind the edge of a hand that feels it
inline constexpr double sample_s = 0.05;  // time between points of the trace
}  // namespace hand

/// A place that the hand aims at.
struct EdgePlace {
  glm::dvec3 place_mm{0};
  glm::dvec3 outward{0};  ///< unit
};

/// The trace of a hand.
struct HandTrace {
  std::vector<glm::dvec3> points_mm;
  double path_mm = 0;
};

/// Sorts places for a hand: slice by slice of 2 mm, alternately one way and back, around a point.
void sort_for_hand(std::vector<EdgePlace>& places, const glm::dvec3& around_mm);

/// The proxy's path in a session with that scene. `felt`: the hand presses into the edge.
HandTrace trace_by_hand(const std::vector<EdgePlace>& way, const std::shared_ptr<const io::Volume>& scan,
                        modes::Scene scene, bool felt, unsigned seed);

}  // namespace palpate::plugin
