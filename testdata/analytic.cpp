#include "testdata/analytic.h"

#include <cmath>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace palpate::testdata {

AnalyticSource::AnalyticSource(Phantom phantom, double softness_mm, const Vec3& lower, const Vec3& upper)
    : phantom_(std::move(phantom)), softness_(softness_mm), lower_(lower), upper_(upper) {
  if (!(softness_mm > 0)) {
    throw std::invalid_argument("analytic source: the softness of the edges has to be above 0 mm");
  }
}

io::Sample AnalyticSource::sample(const Vec3& position_mm, io::FieldSet wanted) const noexcept {
  io::Sample s;
  if (glm::any(glm::lessThan(position_mm, lower_)) || glm::any(glm::greaterThan(position_mm, upper_))) {
    return s;
  }
  s.inside = true;
  double value = phantom_.background;
  Vec3 gradient(0);
  for (const Body& body : phantom_.bodies) {
    const Distance d = distance_to(body.shape, position_mm);
    const double z = d.signed_mm / softness_;
    const double weight = 0.5 * std::erfc(z / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * z * z) / (softness_ * std::sqrt(2 * std::numbers::pi));
    gradient = (1 - weight) * gradient - ((body.value - value) * density) * d.normal;
    value += weight * (body.value - value);
  }
  if (contains(wanted, io::FieldSet::value)) {
    s.value = value;
  }
  if (contains(wanted, io::FieldSet::gradient)) {
    s.gradient = gradient;
  }
  return s;
}

}  // namespace palpate::testdata
