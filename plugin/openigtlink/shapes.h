#pragma once

/// The geometry of a scene for clients: surfaces of its structures and boundaries, and label maps of structures that
/// were corrected here.

#include <string>
#include <vector>

#include "io/progress.h"
#include "modes/scene/scene.h"
#include "plugin/openigtlink/bytes.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin::igtl {

struct Shape {
  std::string type;  ///< "POLYDATA" or "IMAGE"
  std::string name;  ///< of the device: at most 20 bytes, unique within its type
  Bytes content;
};

/// Boundaries of a scan's values are surfaces where they can be felt, with the names of their modes. Each structure
/// with edits is sent as a label map on the voxels of the scan, unless the scan's slices are uneven, since OpenIGTLink
/// has a single step. Empty without a scan. On any thread; takes up to seconds. `progress` is asked only whether to go
/// on. Throws io::Cancelled.
std::vector<Shape> shapes_of(const PreparedScene& felt, const modes::Scene& scene, const io::Progress& progress = {});

}  // namespace palpate::plugin::igtl
