#pragma once

/// The distance from a structure on a scan: one for all who ask for it while somebody holds it, so that what is drawn
/// is what is felt.

#include <memory>

#include "io/geometry.h"
#include "io/structures/structure.h"

namespace palpate::plugin {

/// With exactly that reach. From any thread. Throws io::DicomError that names the file and the structure.
std::shared_ptr<const io::DistanceField> shared_distance(const io::Structure& structure, const io::Geometry& scan,
                                                         double reach_mm);

/// To be looked at: whichever there is, for the surface is the same with every reach.
std::shared_ptr<const io::DistanceField> shared_distance(const io::Structure& structure, const io::Geometry& scan);

}  // namespace palpate::plugin
