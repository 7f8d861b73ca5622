#pragma once

/// A volume as a DICOM series: one file a slice, as a scanner sends it (CT or MR Image Storage, explicit little
/// endian).

#include <filesystem>
#include <optional>
#include <string>

#include "io/series.h"
#include "io/volume.h"
#include "testdata/shape.h"

namespace palpate::testdata {

/// What a phase-contrast series measured.
struct PhaseContrast {
  Vec3 direction{0, 0, 1};  ///< unit, patient axes: the stored values are speeds along it
  double venc_cm_per_s = 0;
};

/// The series' own attributes. It shows no person: PatientName and PatientID are `subject`, dates are empty,
/// PatientIdentityRemoved is YES.
struct SeriesLabel {
  std::string description = "phantom";  ///< SeriesDescription
  std::string subject = "PHANTOM";
  std::string comments;         ///< ImageComments of every slice
  int number = 1;               ///< SeriesNumber
  int bits_stored = 16;         ///< of the 16 that a voxel has
  std::string modality = "CT";  ///< or "MR"
  /// If not empty: volumes with the same study text belong to one study, and those of them with the same number to one
  /// series.
  std::string study;
  std::optional<io::Series::Window> window;  ///< WindowCenter and WindowWidth
  std::optional<double> trigger_time_ms;     ///< TriggerTime: the time in the heart's cycle
  std::optional<PhaseContrast> phase_contrast;
};

/// Writes slice_0001.dcm and on into `folder`, which must not exist or be empty: all of them, or none if there is an
/// error. UIDs follow from the content, so the same volume gives the same bytes.
///
/// Throws std::runtime_error naming the file if it cannot be written, and std::invalid_argument for a volume that such
/// a series cannot hold (float voxels, a slice larger than 65535 on a side).
void write_series(const io::Volume& volume, const std::filesystem::path& folder, const SeriesLabel& label = {});

}  // namespace palpate::testdata
