#include "plugin/paraview/client/views/anatomy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace palpate::plugin {
namespace {

struct Convention {
  glm::dvec3 along;
  glm::dvec3 up;
};
// In LPS: from the feet up, the front up; from the front to the back; from the left to the right.
constexpr std::array<Convention, 3> conventions{Convention{{0, 0, 1}, {0, -1, 0}}, Convention{{0, 1, 0}, {0, 0, 1}},
                                                Convention{{-1, 0, 0}, {0, 0, 1}}};

glm::dvec3 normal_of(int axis, const std::array<glm::dvec3, 3>& directions) {
  return glm::normalize(glm::cross(directions[(axis + 1) % 3], directions[(axis + 2) % 3]));
}

/// Index axes for axial, coronal and sagittal: the assignment whose normals agree best altogether.
std::array<int, 3> index_axes(const std::array<glm::dvec3, 3>& directions) {
  std::array<int, 3> order{0, 1, 2};
  std::array<int, 3> best = order;
  double best_fit = -1;
  do {
    double fit = 0;
    for (std::size_t plane = 0; plane < 3; ++plane) {
      fit += std::abs(glm::dot(normal_of(order[plane], directions), conventions[plane].along));
    }
    if (fit > best_fit) {
      best_fit = fit;
      best = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

glm::dvec3 turned_towards(const glm::dvec3& vector, const glm::dvec3& aim) {
  return glm::dot(vector, aim) < 0 ? -vector : vector;
}

}  // namespace

glm::dvec3 upwards(Plane plane) {
  switch (plane) {
    case Plane::axial:
      return {0, 0, 1};
    case Plane::coronal:
      return {0, -1, 0};
    case Plane::sagittal:
      break;
  }
  return {1, 0, 0};
}

std::string letters_of(const glm::dvec3& direction) {
  constexpr std::array<std::array<char, 2>, 3> names{{{'L', 'R'}, {'P', 'A'}, {'H', 'F'}}};
  constexpr double visible = 0.17365;  // sin 10 degrees
  std::array<int, 3> axes{0, 1, 2};
  std::ranges::stable_sort(axes, [&](int a, int b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  const double length = glm::length(direction);
  std::string letters;
  for (const int axis : {axes[0], axes[1]}) {
    const bool shown = letters.empty() ? length > 0 : std::abs(direction[axis]) > visible * length;
    if (shown) letters += names[static_cast<std::size_t>(axis)][direction[axis] < 0];
  }
  return letters;
}

std::string place_text(const glm::dvec3& place_mm, Coordinates coordinates) {
  const glm::dvec3 tenths = glm::round(10.0 * place_mm) + 0.0;  // + 0: no "-0.0", and no "R 0.0"
  const glm::dvec3 p = tenths / 10.0;
  if (coordinates == Coordinates::ras) return fmt::format("RAS {:.1f} {:.1f} {:.1f} mm", 0 - p.x, 0 - p.y, p.z);
  return fmt::format("{} {:.1f} {} {:.1f} {} {:.1f} mm", p.x < 0 ? 'R' : 'L', std::abs(p.x), p.y < 0 ? 'A' : 'P',
                     std::abs(p.y), p.z < 0 ? 'F' : 'H', std::abs(p.z));
}

Sight sight_of(Plane plane, const std::array<glm::dvec3, 3>& directions) {
  const auto which = static_cast<std::size_t>(plane);
  const Convention& wanted = conventions[which];
  const auto axes = index_axes(directions);
  Sight sight{.index_axis = axes[which]};
  sight.along = turned_towards(normal_of(sight.index_axis, directions), wanted.along);
  // Up is the nearest edge of the slice, so that a tilted scan is upright in its own slices.
  const glm::dvec3& a = directions[static_cast<std::size_t>((sight.index_axis + 1) % 3)];
  const glm::dvec3& b = directions[static_cast<std::size_t>((sight.index_axis + 2) % 3)];
  const glm::dvec3& edge = std::abs(glm::dot(a, wanted.up)) > std::abs(glm::dot(b, wanted.up)) ? a : b;
  const glm::dvec3 up = turned_towards(edge, wanted.up);
  sight.up = glm::normalize(up - glm::dot(up, sight.along) * sight.along);
  return sight;
}

}  // namespace palpate::plugin
