#pragma once

/// Finds the series in folders. Every file is judged by its content; images are grouped into series that can become a
/// volume; skipped files are listed with a reason. Only headers are read here; load() reads the voxels.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/geometry.h"
#include "io/progress.h"
#include "solver/text/message.h"

namespace palpate::io {

struct SeriesSource;  ///< the place of each slice on disk; only for load()

/// Images that share a series UID, an orientation and a size. All text is UTF-8.
struct Series {
  std::string uid;          ///< SeriesInstanceUID
  std::string study_uid;    ///< StudyInstanceUID
  std::string modality;     ///< Modality: "CT", "MR", ...
  std::string description;  ///< SeriesDescription
  /// The label that distinguishes it if several overlapping volumes share this UID, such as "acquisition 2". Otherwise
  /// empty.
  std::string part;
  std::string unit;  ///< of the rescaled values: "HU", or empty if the modality has none

  /// How it was acquired, so that a user can tell it from others. Empty if the file does not say.
  struct Details {
    std::optional<int> number;     ///< SeriesNumber
    std::string date;              ///< SeriesDate, else AcquisitionDate or StudyDate: YYYYMMDD
    std::string time;              ///< SeriesTime, else AcquisitionTime: HHMMSS.FFFFFF
    std::string body_part;         ///< BodyPartExamined
    std::string kernel;            ///< ConvolutionKernel
    std::string sequence;          ///< SequenceName, else ScanningSequence
    std::string contrast;          ///< ContrastBolusAgent
    std::string orientation;       ///< "axial", "coronal", "sagittal", "oblique"; empty without a position
    double thickness_mm = 0;       ///< SliceThickness; 0 if unknown
    bool is_derived = false;       ///< ImageType DERIVED: computed from other images
    bool is_projection = false;    ///< a maximum or minimum of several slices
    bool is_lossy = false;         ///< LossyImageCompression
    double compression_ratio = 0;  ///< LossyImageCompressionRatio; 0 if unknown
  } details;

  std::vector<std::filesystem::path> files;    ///< in the order of the slices that they hold
  std::vector<std::string> transfer_syntaxes;  ///< UIDs, sorted, each once
  Geometry geometry;                           ///< of its first frame
  /// The number of images at one position (time, b-value, echo, phase): each is a frame, a volume of its own.
  int frames_per_position = 1;
  std::vector<std::string> frame_names;  ///< such as "b = 1000 s/mm2"; one for each frame, empty if unknown

  /// The file's own window: rescaled values below level - width / 2 are black, above level + width / 2 white
  /// (WindowCenter and WindowWidth, the first of several, of the middle slice of the first frame).
  struct Window {
    double level = 0;
    double width = 1;
  };
  std::optional<Window> window;

  /// Whether it is a volume: placed in the patient, scalar, at least two slices, no localizer. load() may still read a
  /// series that is not usable (one slice, a localizer), and its message says so if it cannot.
  bool usable = false;
  std::vector<Text> warnings;  ///< what a user should know: missing slices, files left out, why it is not usable

  /// The patient and the date. Shown on the screen, on request, to verify the scan. Never written to a log, recording,
  /// picture or report.
  struct Identity {
    std::string patient_name;
    std::string patient_id;
    std::string study_date;  ///< YYYYMMDD
  } identity;

  std::shared_ptr<const SeriesSource> source;
};

struct SkippedFile {
  std::filesystem::path path;
  Text reason;
  std::string kind = {};  ///< in a radiologist's words: "structured report", "scout", "other file", ...
};

struct Catalogue {
  std::vector<Series> series;        ///< usable ones first, then by date and UID of the study, series number, path
  std::vector<SkippedFile> skipped;  ///< by path
  /// Velocity fields. Each joins three series of phase contrast along three directions, which are in `series`, too.
  /// load() makes it a vector field (Volume::vectors) in m/s.
  std::vector<Series> velocity_fields;
};

/// The series in these files and folders. Folders are searched to the bottom; names and extensions do not matter. A
/// DICOMDIR among the paths stands for its folder; its own records are not used. A damaged file is left out; the others
/// are read. Throws DicomError if a path does not exist or cannot be listed, or if DICOM's data dictionary is missing.
/// Throws Cancelled.
Catalogue find_series(std::span<const std::filesystem::path> paths, const Progress& progress = {});

}  // namespace palpate::io
