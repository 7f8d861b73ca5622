#include "device/safety/sustained.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::device {

namespace {

double square(double x) {
  return x * x;
}

double most_heat(const SustainedLimit& limit) {
  return (square(limit.peak) - square(limit.continuous)) * limit.time;
}

}  // namespace

double SustainedLoad::allowed(const SustainedLimit& limit) const noexcept {
  if (!(limit.continuous > 0) || !(limit.peak > limit.continuous)) return std::numeric_limits<double>::infinity();
  const double left = std::max(0.0, most_heat(limit) - heat_);
  // What is left is spent within a quarter of the time: the full peak until then, and no step at the end.
  return std::sqrt(square(limit.continuous) + left / (limit.time / 4));
}

void SustainedLoad::add(const SustainedLimit& limit, double size, double elapsed) noexcept {
  if (!(elapsed > 0) || !std::isfinite(size)) return;
  heat_ = std::clamp(heat_ + (square(size) - square(limit.continuous)) * elapsed, 0.0, std::max(0.0, most_heat(limit)));
}

}  // namespace palpate::device
