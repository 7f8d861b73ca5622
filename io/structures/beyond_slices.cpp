#include "io/structures/beyond_slices.h"

#include <glm/vector_relational.hpp>

namespace palpate::io {

bool is_seen(const DistanceOptions& options, const Vec3& position_mm) {
  if (!options.scan) {
    return true;
  }
  const Vec3 index = options.scan->to_index(position_mm);
  return glm::all(glm::greaterThanEqual(index, Vec3(-0.5))) &&
         glm::all(glm::lessThanEqual(index, Vec3(options.scan->dimensions) - 0.5));
}

}  // namespace palpate::io
