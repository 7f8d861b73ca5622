#pragma once

#include "io/structures/mask.h"
#include "io/structures/structure.h"

namespace palpate::io {

/// Voxels that are inside, by their centers. Each reaches half of the way to the slices beside its own. Throws
/// DicomError if there is none.
StructureMeasures measures_of(const Mask& mask);

/// mm: from a slice to the next along their normal; beyond the ends, the distance of the two outermost slices.
double step_after(const Geometry& geometry, int k);

}  // namespace palpate::io
