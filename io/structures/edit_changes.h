#pragma once

/// The effect of each type of edit on a field.

#include "io/structures/edits.h"
#include "io/structures/field_change.h"

namespace palpate::io::internal {

using Field = std::shared_ptr<const DistanceField>;

/// A path without the points that are nearer than `mm` to the last one kept. Both ends are kept; no point of the old
/// path is farther than that from the new one.
std::vector<Vec3> thinned_path(const std::vector<Vec3>& path, double mm);

/// Each throws InvalidInput with a reason that does not name the edit.
Field traced(const Field& before, const TraceEdit& edit, int threads, EditOutcome& outcome);
Field joined(const Field& before, const Tube& tube, int threads, EditOutcome& outcome);
Field cut(const Field& before, const Tube& tube, int threads, EditOutcome& outcome);
Field moved_to_scan_edge(const Field& before, const ScanEdgeEdit& edit, const EditOptions& options,
                         EditOutcome& outcome);
Field of_contours(const ContoursEdit& edit, const EditOptions& options);

}  // namespace palpate::io::internal
