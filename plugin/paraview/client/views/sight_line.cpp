#include "plugin/paraview/client/views/sight_line.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::plugin {
namespace {

constexpr double step_mm = 1;
constexpr double before_mm = 3;      // of the place: its own surface
constexpr double farthest_mm = 600;  // beyond any scan, towards the eye
constexpr double opaque = 0.98;

double opacity_of(std::span<const OpacityNode> nodes, double value) {
  if (nodes.empty()) return 0;
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), value,
                                      [](double at, const OpacityNode& node) { return at < node.value; });
  if (above == nodes.begin()) return nodes.front().opacity;
  if (above == nodes.end()) return nodes.back().opacity;
  const OpacityNode& below = *(above - 1);
  const double part = (value - below.value) / (above->value - below.value);
  return below.opacity + part * (above->opacity - below.opacity);
}

}  // namespace

double hidden_part(const io::FieldSource& source, std::span<const OpacityNode> opacity, const glm::dvec3& eye,
                   const glm::dvec3& place) {
  const double distance = glm::length(eye - place);
  if (!(distance > before_mm)) return 0;
  const glm::dvec3 towards_eye = (eye - place) / distance;
  double passes = 1;
  for (double at = before_mm; at < std::min(distance, farthest_mm); at += step_mm) {
    const io::Sample sample = source.sample(place + at * towards_eye, io::FieldSet::value);
    if (sample.inside) passes *= 1 - std::clamp(opacity_of(opacity, sample.value), 0.0, 1.0);
    if (passes < 1 - opaque) break;
  }
  return 1 - passes;
}

std::optional<glm::dvec3> first_seen(const io::FieldSource& source, std::span<const OpacityNode> opacity,
                                     const glm::dvec3& from, const glm::dvec3& to) {
  constexpr double fine_mm = 0.5, half = 0.5;
  const double distance = glm::length(to - from);
  if (!(distance > 0)) return {};
  const glm::dvec3 along = (to - from) / distance;
  double passes = 1;
  for (double at = 0; at < distance; at += fine_mm) {
    const io::Sample sample = source.sample(from + at * along, io::FieldSet::value);
    if (!sample.inside) continue;
    passes *= std::pow(1 - std::clamp(opacity_of(opacity, sample.value), 0.0, 1.0), fine_mm);
    if (passes < half) return from + at * along;
  }
  return {};
}

}  // namespace palpate::plugin
