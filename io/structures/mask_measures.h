#pragma once

#include "io/structures/mask.h"
#include "io/structures/structure.h"

namespace palpate::io {

/// Voxels that are inside, by their centers. Each reaches half of the way to the slices beside its own. Throws
/// DicomError if there is none.
StructureMeasures measures_of(const Mask& mask);

}  // namespace palpate::io
