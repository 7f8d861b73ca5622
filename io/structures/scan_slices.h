#pragma once

#include "io/structures/mask.h"

namespace palpate::io {

/// Segmentations leave out empty slices. Where the mask's slices are slices of the scan, the empty ones are those of
/// the scan, and no others: the mask's slices become the scan's, up to `around_mm` beyond the mask's ends. So a step
/// over a lost slice, or a larger slice distance, stays one step. Otherwise the mask stays as it is; so does one that
/// has fewer slices than the scan throughout. A slice alone whose file does not say how thick it is becomes as thick as
/// the smaller step beside it.
void take_slices_of(const Geometry& scan, double around_mm, Mask& mask);

/// Whether all steps between the scan's slices are multiples of the least one, to a fiftieth of it: then one lattice of
/// nodes holds all slices.
bool has_whole_steps(const Geometry& scan);

}  // namespace palpate::io
