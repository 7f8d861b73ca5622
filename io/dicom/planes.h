#pragma once

/// The images in a dataset and their positions.

#include "io/dicom/file_header.h"

class DcmItem;

namespace palpate::io::internal {

/// The one image of a classic CT or MR file. Sets in `header` the unit of its values and `unfit`,
/// the reason why it cannot be part of a volume (empty: it can).
Plane classic_plane(DcmItem& dataset, FileHeader& header);

/// The frames of an enhanced multi-frame file, each from its own functional groups or the shared ones (PS3.3 C.7.6.16).
/// Items are read one by one, so a broken group affects only its own attributes. Frames without a position have no
/// placement. Sets in `header` what classic_plane() sets.
std::vector<Plane> functional_group_planes(DcmItem& dataset, FileHeader& header, std::size_t frames);

/// The tiles of a Siemens mosaic: ImageType MOSAIC, with their number and normal in the private CSA header. Empty if
/// the image is not a mosaic. Sets the size of a tile in `header`.
std::vector<Plane> mosaic_planes(DcmItem& dataset, FileHeader& header);

/// The tiles of a UIH grid (ImageType VFRAME): a mosaic with the position of each slice in a private sequence. Empty if
/// these are missing. Sets the size of a tile in `header`. Source: UIH's table in the notes of dcm2niix.
std::vector<Plane> grid_planes(DcmItem& dataset, FileHeader& header);

/// The frames of a multi-frame file without functional groups, spaced by GridFrameOffsetVector (doses; PS3.3 C.8.8.3.2)
/// or SpacingBetweenSlices. If both are missing, or the frames are time points, only the first one is returned and
/// `header` is unfit.
std::vector<Plane> stacked_planes(DcmItem& dataset, FileHeader& header, std::size_t frames);

/// Reads the modality look-up table, if there is one, and its unit. `header` is unfit if the table is damaged.
void read_modality_table(DcmItem& dataset, FileHeader& header);

}  // namespace palpate::io::internal
