#pragma once

/// The distance field of a structure on a scan. All callers share one field while any of them holds it, so that drawing
/// and force use the same one.

#include <memory>

#include "io/geometry.h"
#include "io/structures/edit.h"
#include "io/structures/structure.h"

namespace palpate::plugin {

/// Whether the voxels of both have the same positions, as in two frames of a series.
bool same_place(const io::Geometry& a, const io::Geometry& b) noexcept;

/// The field with exactly this reach. From any thread. Throws io::DicomError that names the file and the structure.
std::shared_ptr<const io::DistanceField> shared_distance(const io::Structure& structure, const io::Geometry& scan,
                                                         double reach_mm);

/// For drawing: a field with any reach, because the surface is the same with every reach.
std::shared_ptr<const io::DistanceField> shared_distance(const io::Structure& structure, const io::Geometry& scan);

/// The field of a structure defined by contours, with exactly this reach. From any thread. Throws InvalidInput that
/// begins with "contours: ".
std::shared_ptr<const io::DistanceField> shared_distance(const io::ContoursEdit& contours, const io::Geometry& scan,
                                                         double reach_mm);

}  // namespace palpate::plugin
