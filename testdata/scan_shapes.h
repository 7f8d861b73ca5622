#pragma once

/// A CT of a chest as scanners send it: with padding, uneven or tilted slices, as floats, and so on. All have the same
/// voxels, except for the difference that the name states.

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "io/volume.h"

namespace palpate::testdata {

/// The plain one: 16 bits, no padding, straight and even slices, of which every eighth is the same. Along x and y it
/// reaches over 360 mm.
std::shared_ptr<const io::Volume> plain_chest(const glm::ivec3& size);

struct ScanShape {
  std::string name;
  std::function<std::shared_ptr<const io::Volume>(const io::Volume& plain)> from;
};
const std::vector<ScanShape>& scan_shapes();

/// Processor times, s, and their ratio.
struct CostRatio {
  double plain_s = 0, shape_s = 0;
  double ratio() const noexcept { return shape_s / plain_s; }
};
/// The least of `rounds` runs of each, alternately, so that other load on the machine affects both. Runs on the calling
/// thread; only that thread's time counts.
CostRatio compare_costs(int rounds, const std::function<void()>& plain, const std::function<void()>& shape);

}  // namespace palpate::testdata
