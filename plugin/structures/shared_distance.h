#pragma once

/// The distance field of a structure on a scan. All callers share one field while any of them holds it, so that what is
/// drawn is what is felt.

#include <memory>

#include "io/geometry.h"
#include "io/structures/edit.h"
#include "io/structures/structure.h"

namespace palpate::plugin {

/// Whether each voxel of one lies where that of the other does, as in two frames of a series.
bool same_place(const io::Geometry& a, const io::Geometry& b) noexcept;

/// The field with exactly this reach. From any thread. Throws io::DicomError that names the file and the structure.
std::shared_ptr<const io::DistanceField> shared_distance(const io::Structure& structure, const io::Geometry& scan,
                                                         double reach_mm);

/// For drawing: a field with any reach, because the surface is the same with every reach.
std::shared_ptr<const io::DistanceField> shared_distance(const io::Structure& structure, const io::Geometry& scan);

/// The field of a structure that contours make, with exactly this reach. From any thread. Throws InvalidInput that
/// begins with "contours: ".
std::shared_ptr<const io::DistanceField> shared_distance(const io::ContoursEdit& contours, const io::Geometry& scan,
                                                         double reach_mm);

}  // namespace palpate::plugin
