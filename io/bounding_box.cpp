#include "io/bounding_box.h"

#include <glm/common.hpp>
#include <limits>

namespace palpate::io {

Box bounding_box(const Geometry& geometry) {
  Box box{Vec3(std::numeric_limits<double>::infinity()), Vec3(-std::numeric_limits<double>::infinity())};
  for (const int k : {0, geometry.dimensions.z - 1}) {
    for (const int j : {0, geometry.dimensions.y - 1}) {
      for (const int i : {0, geometry.dimensions.x - 1}) {
        const Vec3 corner = geometry.to_patient({i, j, k});
        box.low = glm::min(box.low, corner);
        box.high = glm::max(box.high, corner);
      }
    }
  }
  return box;
}

}  // namespace palpate::io
