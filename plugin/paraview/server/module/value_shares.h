#pragma once

/// Single values of a scan, and the distribution of its values.

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "io/series.h"
#include "io/volume.h"

namespace palpate::plugin {

/// 101 values, ascending: n percent of the voxels, without padding, lie below the n-th. Estimated in a tenth of a
/// second from a few slices that are spread evenly over the first frame, so the values are the same on every server.
/// Slices come from the store if it holds the scan, and are read otherwise. Throws as io::load().
std::vector<double> value_shares(const io::Series& series);

/// The voxel nearest to a place (patient space, mm), and its value; none outside and in a gap, no value in padding.
std::optional<glm::ivec3> nearest_voxel(const io::Geometry& geometry, const glm::dvec3& place);
std::optional<double> nearest_value(const io::Volume& volume, const glm::dvec3& place);

}  // namespace palpate::plugin
