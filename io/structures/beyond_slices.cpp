#include "io/structures/beyond_slices.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::io {

bool is_seen(const DistanceOptions& options, const Vec3& position_mm) {
  if (!options.scan) {
    return true;
  }
  const double slice = options.scan->to_index(position_mm).z;
  return slice >= -0.5 && slice <= options.scan->dimensions.z - 0.5;
}

void add_empty_slices(const DistanceOptions& options, Mask& mask) {
  Geometry& geometry = mask.geometry;
  const double spacing = std::max(geometry.slice_spacing(), 1e-3);
  const int count = static_cast<int>(std::clamp(std::ceil((options.reach_mm + 20) / spacing), 1.0, 64.0));
  const Vec3 middle = geometry.direction_i * (geometry.spacing_i * (mask.low.x + 0.5 * mask.size.x)) +
                      geometry.direction_j * (geometry.spacing_j * (mask.low.y + 0.5 * mask.size.y));
  auto& slices = geometry.slice_positions;
  for (int n = 0; n < count; ++n) {
    const Vec3 before = slices.front() - geometry.step;
    const Vec3 behind = slices.back() + geometry.step;
    const bool seen_before = is_seen(options, before + middle);
    const bool seen_behind = is_seen(options, behind + middle);
    if (seen_behind) {
      slices.push_back(behind);
    }
    if (seen_before) {
      slices.insert(slices.begin(), before);
      ++mask.low.z;
    }
  }
  geometry.dimensions.z = static_cast<int>(slices.size());
}

}  // namespace palpate::io
