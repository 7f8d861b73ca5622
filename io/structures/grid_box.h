#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "io/structures/structure.h"

namespace palpate::io {

/// Voxels of a scan, both ends included.
struct IndexBox {
  glm::ivec3 low{0}, high{-1};
};

/// The scan's voxels in a box, and one more on each side. All voxels if there is no box.
IndexBox index_box(const Geometry& scan, const std::optional<StructureBox>& within);

}  // namespace palpate::io
