#pragma once

/// Single values of a scan, and how they are spread.

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "io/series.h"
#include "io/volume.h"

namespace palpate::plugin {

/// 101 values, ascending: below the n-th are n percent of the voxels, padding left out. From a few slices spread evenly
/// over the first frame, taken from the store where it holds the scan and read where not: the same values on every
/// server, in a tenth of a second. Throws as io::load().
std::vector<double> value_shares(const io::Series& series);

/// The voxel nearest to a place (patient space, mm), and its value; none outside and in a gap, no value in padding.
std::optional<glm::ivec3> nearest_voxel(const io::Geometry& geometry, const glm::dvec3& place);
std::optional<double> nearest_value(const io::Volume& volume, const glm::dvec3& place);

}  // namespace palpate::plugin
