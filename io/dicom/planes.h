#pragma once

/// From a dataset to the images it holds and where they lie.

#include "io/dicom/file_header.h"

class DcmItem;

namespace palpate::io::internal {

/// The one image of a classic CT or MR file. Sets the unit of its values in `header`, and whether they are unfit.
Plane classic_plane(DcmItem& dataset, FileHeader& header);

/// The frames of an enhanced multi-frame file, each from its own functional groups or the shared ones (PS3.3 C.7.6.16).
/// Read item by item, so that one broken group costs what it says and no more. Frames without a position have no
/// placement. Sets in `header` what classic_plane() sets.
std::vector<Plane> functional_group_planes(DcmItem& dataset, FileHeader& header, std::size_t frames);

/// The tiles of a Siemens mosaic: ImageType MOSAIC, and the private CSA header that says how many and along which
/// normal. Empty where it is none. Sets the size of a tile in `header`.
std::vector<Plane> mosaic_planes(DcmItem& dataset, FileHeader& header);

/// The tiles of a grid of UIH (ImageType VFRAME), a mosaic whose private sequence says where each slice lies. Empty
/// where it does not. Sets the size of a tile in `header`. Source: UIH's table in the notes of dcm2niix.
std::vector<Plane> grid_planes(DcmItem& dataset, FileHeader& header);

/// The frames of a file without functional groups, which lie behind one another: where GridFrameOffsetVector says
/// (doses; PS3.3 C.8.8.3.2), or SpacingBetweenSlices. Where neither does, or frames follow in time, the first alone,
/// and `header` is unfit.
std::vector<Plane> stacked_planes(DcmItem& dataset, FileHeader& header, std::size_t frames);

/// Reads the modality look-up table, where there is one: `header` is unfit where that is damaged. It sets the unit.
void read_modality_table(DcmItem& dataset, FileHeader& header);

}  // namespace palpate::io::internal
