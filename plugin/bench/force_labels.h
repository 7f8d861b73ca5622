#pragma once

/// Rows on a scan with outlined organs: the force of the outlines is the truth.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "io/structures/mask.h"
#include "io/structures/structure.h"
#include "io/volume.h"
#include "plugin/bench/force_study.h"

namespace palpate::plugin {

/// The group with scenes as rows.
inline constexpr const char* scenes_group = "scenes of a scan";

/// A mask of the whole lattice of a scan.
io::Mask empty_mask(const io::Geometry& geometry);

/// The body: the largest connected piece above -300 HU, and everything that outside air does not reach through voxels
/// below -300 HU.
io::Mask body_in(const io::Volume& volume);

/// Removes (or adds) voxels on each side that has a neighbor in a slice.
io::Mask eroded(const io::Mask& mask, int voxels);
/// Shifts all voxels by so many columns.
io::Mask shifted(const io::Mask& mask, int columns);
/// Moves the edge by up to so many voxels, in or out, by the same amount over patches of four voxels.
io::Mask ragged(const io::Mask& mask, int voxels, std::uint64_t seed);

/// The automatic scene, the scan's starting scene, and labels with errors of a known size. Throws InputRefused if no
/// structure of the catalogue lies on the scan.
std::vector<ForceGroup> label_groups(const std::shared_ptr<const io::Volume>& volume,
                                     const io::StructureCatalogue& structures, std::uint64_t seed);

}  // namespace palpate::plugin
