#include "io/structures/beyond_slices.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::io {

bool is_seen(const DistanceOptions& options, const Vec3& position_mm, const Vec3& normal) {
  if (!options.scan) {
    return true;
  }
  const Geometry& scan = *options.scan;
  const Vec3 across = glm::normalize(glm::cross(scan.direction_i, scan.direction_j));
  const Vec3 along(std::abs(glm::dot(scan.direction_i, normal)), std::abs(glm::dot(scan.direction_j, normal)),
                   std::abs(glm::dot(across, normal)));
  const int axis = along.z >= std::max(along.x, along.y) ? 2 : (along.y > along.x ? 1 : 0);
  const double index = scan.to_index(position_mm)[axis];
  return index >= -0.5 && index <= scan.dimensions[axis] - 0.5;
}

}  // namespace palpate::io
