#pragma once

#include "io/geometry.h"

namespace palpate::io {

/// Two opposite corners of the box around all voxel centers, patient space, mm.
struct Box {
  Vec3 low{0};
  Vec3 high{0};
};
Box bounding_box(const Geometry& geometry);

}  // namespace palpate::io
