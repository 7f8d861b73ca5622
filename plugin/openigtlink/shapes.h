#pragma once

/// What clients get to see of a scene beside its frames: surfaces of its structures and of its boundaries, and the
/// label maps of structures that were corrected here.

#include <string>
#include <vector>

#include "modes/scene/scene.h"
#include "plugin/openigtlink/bytes.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin::igtl {

struct Shape {
  std::string type;  ///< "POLYDATA" or "IMAGE"
  std::string name;  ///< of the device: at most 20 bytes, and no other of that type has it
  Bytes content;
};

/// Boundaries that a scan's values make are surfaces where they can be felt, by the names of their modes. A label map
/// is sent of each structure that has edits, on the voxels of the scan; none if the scan's slices are uneven, since
/// OpenIGTLink has a single step. None without a scan. On any
/// thread; takes up to seconds.
std::vector<Shape> shapes_of(const PreparedScene& felt, const modes::Scene& scene);

}  // namespace palpate::plugin::igtl
