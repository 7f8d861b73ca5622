#pragma once

/// The readers of each kind of file. Each adds the structures of one file; they throw DicomError with a reason that
/// does not name the file.

#include <filesystem>
#include <vector>

#include "io/dicom/dataset.h"
#include "io/interchange/voxel_file.h"
#include "io/structures/structure.h"

class DcmDataset;

namespace palpate::io {

/// A DICOM file whose header has been read.
struct StructureDataset {
  std::filesystem::path path;
  internal::DatasetStart start;
  std::optional<internal::PixelElement> pixels;
  DcmDataset& dataset;
};

std::vector<Structure> structures_of_segmentation(const StructureDataset& file);
std::vector<Structure> structures_of_contours(const StructureDataset& file);
/// NIfTI, NRRD and MetaImage. Adds none if it is another kind of file, or an image. `is_named`: the user says that this
/// file is a label map; then its labels may be as thin as a voxel, and an image is refused.
std::vector<Structure> structures_of_label_map(const std::filesystem::path& path, bool is_named);
/// Whether the values of such a file are labels and not a scan. Reads no more than it needs.
bool is_label_map(const VoxelFile& file);

}  // namespace palpate::io
