#pragma once

/// Encodes label maps as whole files, for `LabelFormat::bytes`.

#include <string>
#include <string_view>

#include "io/structures/label_image.h"

namespace palpate::io {

/// NIfTI-1; ".nii.gz" is gzipped.
std::string nifti_bytes(const LabelImage& image, std::string_view ending);
/// ".seg.nrrd" has the fields that 3D Slicer reads.
std::string nrrd_bytes(const LabelImage& image, std::string_view ending);
std::string meta_image_bytes(const LabelImage& image, std::string_view ending);

}  // namespace palpate::io
