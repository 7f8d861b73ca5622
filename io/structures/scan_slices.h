#pragma once

#include "io/structures/mask.h"

namespace palpate::io {

/// Adds the empty slices that a segmentation leaves out. If the mask's slices are slices of the scan, the mask gets all
/// slices of the scan between its ends and up to `around_mm` beyond them, and no others. So a step over a lost slice,
/// or a larger slice distance, stays one step. The mask does not change if its slices are not the scan's, or if it has
/// fewer slices than the scan throughout (no two of them are neighbors in the scan). A single slice whose file gives no
/// thickness becomes as thick as the smaller step beside it in the scan.
void take_slices_of(const Geometry& scan, double around_mm, Mask& mask);

/// Whether all steps between the scan's slices are multiples of the least one, to a fiftieth of it: then one lattice of
/// nodes holds all slices.
bool has_whole_steps(const Geometry& scan);

}  // namespace palpate::io
