#pragma once

/// A volume as a DICOM CT series: one file a slice, as a scanner sends it (CT Image Storage, explicit little endian).

#include <filesystem>
#include <string>

#include "palpate/io/volume.h"

namespace palpate::testdata {

/// What the series says of itself. No person is behind it: PatientName and PatientID are `subject`, dates are empty,
/// PatientIdentityRemoved is YES.
struct SeriesLabel {
  std::string description = "phantom";  ///< SeriesDescription
  std::string subject = "PHANTOM";
  std::string comments;  ///< ImageComments of every slice
  int number = 1;        ///< SeriesNumber
};

/// Writes slice_0001.dcm and on into `folder`, which must not exist or be empty: all of them or, on an error, none.
/// UIDs follow from the content, so the same volume gives the same bytes.
///
/// Throws std::runtime_error naming the file for what cannot be written, std::invalid_argument for what a CT series
/// cannot hold (float voxels, a slice larger than 65535 on a side).
void write_series(const io::Volume& volume, const std::filesystem::path& folder, const SeriesLabel& label = {});

}  // namespace palpate::testdata
