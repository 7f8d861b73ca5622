#pragma once

/// Boundaries of analytic values on grids that are oblique, tilted and not square.

#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <random>

#include "io/fields/field_source.h"
#include "io/geometry.h"

namespace palpate::io::testing {

/// One formula gives the values, and another the places that have a value. The gradient has the direction of the
/// boundary's normal; its length has no meaning.
class FormulaSource final : public FieldSource {
 public:
  std::function<double(const Vec3&)> value;
  std::function<bool(const Vec3&)> inside = [](const Vec3&) { return true; };
  Vec3 gradient{0};

  FieldSet available() const noexcept override { return FieldSet::value | FieldSet::gradient; }
  Sample sample(const Vec3& at, FieldSet wanted) const noexcept override {
    Sample sample;
    sample.inside = inside(at);
    if (!sample.inside) return sample;
    sample.value = value(at);
    if (contains(wanted, FieldSet::gradient)) sample.gradient = gradient;
    return sample;
  }
};

/// A hash of a place as a number, uniformly distributed between 0 and 1: the same for the same place.
inline double hashed(const Vec3& at) {
  std::uint64_t bits = 0x9E3779B97F4A7C15;
  for (int axis = 0; axis < 3; ++axis) {
    bits = (bits ^ static_cast<std::uint64_t>(std::llround(at[axis] * 1e6))) * 0xBF58476D1CE4E5B9;
    bits ^= bits >> 29;
  }
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// A normally distributed number of standard deviation one, by the place alone.
inline double gaussian_at(const Vec3& at) {
  const double u = hashed(at), v = hashed(at + Vec3(1e4, 0, 0));
  return std::sqrt(-2 * std::log(u + 1e-12)) * std::cos(2 * std::numbers::pi * v);
}

/// A step after a Gaussian blur: it rises from one flat value to another, with a slope of one and the value 0 in the
/// middle.
inline double blurred_step(double way_mm, double sigma_mm) {
  return std::sqrt(std::numbers::pi / 2) * sigma_mm * std::erf(way_mm / (std::numbers::sqrt2 * sigma_mm));
}

struct TiltedBoundary {
  Geometry geometry;
  Vec3 place{0}, normal{0};
  glm::dmat3 tangent{1};  // projects onto the boundary's plane
};

inline Vec3 any_unit(std::mt19937& random) {
  std::normal_distribution<double> any;
  const double x = any(random), y = any(random), z = any(random);
  return glm::normalize(Vec3(x, y, z));
}

inline TiltedBoundary tilted_boundary(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> mm(0.4, 3);
  TiltedBoundary made;
  Geometry& g = made.geometry;
  g.dimensions = {100, 100, 100};
  g.direction_i = any_unit(random);
  g.direction_j = glm::normalize(glm::cross(any_unit(random), g.direction_i));
  g.spacing_i = mm(random);
  g.spacing_j = mm(random);
  const double apart = mm(random), slide = mm(random);
  g.step = apart * glm::cross(g.direction_i, g.direction_j) + slide * g.direction_j - 0.5 * slide * g.direction_i;
  for (int k = 0; k < g.dimensions.z; ++k) g.slice_positions.push_back(static_cast<double>(k) * g.step);
  made.place = g.to_patient({50, 50, 50});
  made.normal = any_unit(random);
  made.tangent = glm::dmat3(1) - glm::outerProduct(made.normal, made.normal);
  return made;
}

}  // namespace palpate::io::testing
