#pragma once

/// Rays from the center of an outlined ball.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>

#include "io/structures/distance_field.h"

namespace palpate::plugin {

/// A unit vector with a uniform distribution of directions. `any` has mean 0 and standard deviation 1.
inline glm::dvec3 any_direction(std::mt19937& random, std::normal_distribution<double>& any) {
  const double x = any(random), y = any(random), z = any(random);
  return glm::normalize(glm::dvec3(x, y, z));
}

/// The distance from the center at which the ray leaves the structure, mm; at most `most_mm`.
inline double radius_along(const io::DistanceField& structure, const glm::dvec3& center, const glm::dvec3& way,
                           double most_mm) {
  double in = 0, out = most_mm;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (in + out);
    (structure.sample(center + middle * way).mm > 0 ? in : out) = middle;
  }
  return in;
}

}  // namespace palpate::plugin
