#pragma once

/// Rows on a scan whose organs somebody has outlined: the truth is what the outlines feel like.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "io/structures/mask.h"
#include "io/structures/structure.h"
#include "io/volume.h"
#include "plugin/bench/force_study.h"

namespace palpate::plugin {

/// The group whose rows are scenes.
inline constexpr const char* scenes_group = "scenes of a scan";

/// A mask of the whole lattice of a scan.
io::Mask empty_mask(const io::Geometry& geometry);

/// The body: what lies above -300 HU in one piece, the largest, and all that air from outside does not reach through
/// voxels below -300 HU.
io::Mask body_in(const io::Volume& volume);

/// One voxel less, or more, on each side that has a neighbor in a slice.
io::Mask eroded(const io::Mask& mask, int voxels);
/// All voxels by so many columns.
io::Mask shifted(const io::Mask& mask, int columns);
/// The edge moved by up to so many voxels, in or out, alike over patches of four voxels.
io::Mask ragged(const io::Mask& mask, int voxels, std::uint64_t seed);

/// The automatic scene, the scan's starting scene, and labels that are wrong by a known amount. Throws InputRefused
/// if no structure of the catalogue lies on the scan.
std::vector<ForceGroup> label_groups(const std::shared_ptr<const io::Volume>& volume,
                                     const io::StructureCatalogue& structures, std::uint64_t seed);

}  // namespace palpate::plugin
