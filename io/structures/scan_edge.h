#pragma once

/// The scan's own edge beside a structure's surface. Labels give the surface only to whole voxels, and a person may
/// have drawn it elsewhere; the scan's values show where the tissue changes, if it does there.
///
/// The values are read along a straight line through the surface. An edge is an interval in which they rise or fall. It
/// is cut at both ends where the slope is the same fraction of its maximum, and its place is where the value is
/// half-way between the two ends. So the place does not depend on the samples, and a neighboring edge that cuts one
/// side short does not shift it.
///
/// Blur shifts the edge of a round body towards the center of curvature: by half of the sum, over the two tangent
/// directions, of the blur's variance times the curvature. That shift is corrected. The blur is that of the voxel, of
/// the interpolation, and of the scanner, estimated from the width of the edge; the curvature is the structure's.

#include <memory>
#include <optional>

#include "io/fields/field_source.h"
#include "io/geometry.h"
#include "io/structures/distance_field.h"
#include "io/volume.h"

namespace palpate::io {

struct ScanEdge {
  double mm = 0;           ///< from the place, along `way`; negative: the edge is before the place
  double rise = 0;         ///< of the value along `way`, the scan's unit; negative: it falls
  double known_to_mm = 0;  ///< two standard deviations of `mm`, through noise and the phase between voxels, and a part
                           ///< of the blur's shift
};

/// The data in which the edge is searched for.
struct ScanValues {
  const FieldSource& source;  ///< the cubic value and its own gradient (GradientMethod::cubic)
  const Geometry& geometry;
};

/// The fields of a scan that the search for an edge reads.
std::shared_ptr<const FieldSource> edge_fields(const std::shared_ptr<const Volume>& scan);

/// The edge nearest to a place on the structure's surface (mm, patient space) along a direction (unit), within this
/// distance on both sides. Its rise or fall is at least six times the noise. None if there is no such edge, if the
/// direction is almost along the surface, or if the noise cannot be measured there, as at the end of the scan. Takes
/// some thousand samples: not for the tick.
std::optional<ScanEdge> scan_edge(const ScanValues& scan, const DistanceField& structure, const Vec3& place_mm,
                                  const Vec3& way, double within_mm);

}  // namespace palpate::io
