#pragma once

/// The images in a dataset and their places.

#include "io/dicom/file_header.h"

class DcmItem;

namespace palpate::io::internal {

/// The one image of a classic CT or MR file. Sets in `header` the unit of its values and why they are unfit, if they
/// are.
Plane classic_plane(DcmItem& dataset, FileHeader& header);

/// The frames of an enhanced multi-frame file, each from its own functional groups or the shared ones (PS3.3 C.7.6.16).
/// Each item is read by itself, so that a damaged group affects only what it says. Frames without a position have no
/// placement. Sets in `header` what classic_plane() sets.
std::vector<Plane> functional_group_planes(DcmItem& dataset, FileHeader& header, std::size_t frames);

/// The tiles of a Siemens mosaic: ImageType MOSAIC, and the private CSA header that says how many and along which
/// normal. Empty if it is no mosaic. Sets the size of a tile in `header`.
std::vector<Plane> mosaic_planes(DcmItem& dataset, FileHeader& header);

/// The tiles of a grid of UIH (ImageType VFRAME), a mosaic whose private sequence says where each slice lies. Empty
/// if it does not. Sets the size of a tile in `header`. Source: UIH's table in the notes of dcm2niix.
std::vector<Plane> grid_planes(DcmItem& dataset, FileHeader& header);

/// The frames of a file without functional groups, which lie behind one another: as GridFrameOffsetVector says (doses;
/// PS3.3 C.8.8.3.2), or SpacingBetweenSlices. If the file has neither, or its frames follow in time: only the first
/// frame, and `header` is unfit.
std::vector<Plane> stacked_planes(DcmItem& dataset, FileHeader& header, std::size_t frames);

/// Reads the modality look-up table, if there is one, and sets the unit. `header` is unfit if the table is damaged.
void read_modality_table(DcmItem& dataset, FileHeader& header);

}  // namespace palpate::io::internal
