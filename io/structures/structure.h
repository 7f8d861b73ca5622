#pragma once

/// Outlined structures: segments of a DICOM SEG, ROIs of an RTSTRUCT, labels of a label map. To list them, only headers
/// are read; a structure is decoded when it is measured or felt.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/progress.h"
#include "io/series.h"
#include "io/structures/distance_field.h"
#include "io/structures/registration.h"
#include "solver/text/message.h"

namespace palpate::io {

enum class StructureKind : std::uint8_t { segmentation, contours, label_map };

/// "SEG", "RTSTRUCT", "label map".
const char* name_of(StructureKind kind) noexcept;

/// The size of a structure, LPS, mm.
struct StructureMeasures {
  std::optional<std::uint64_t> voxels;    ///< of SEG and label maps
  std::optional<std::uint64_t> contours;  ///< of RTSTRUCT
  double volume_mm3 = 0;
  Vec3 centroid_mm{0};
  Vec3 box_low_mm{0};  ///< of voxel centers or contour points
  Vec3 box_high_mm{0};
  std::vector<Text> warnings;
};

/// A box that contains a structure, LPS, mm: around voxel centers or contour points.
struct StructureBox {
  Vec3 low_mm{0}, high_mm{0};
};

/// Whether the box is wholly outside the scan: more than a voxel away from its outermost voxels.
bool is_off(const StructureBox& box, const Geometry& scan);

/// A file that holds structures. Immutable; from any thread.
class StructureSource {
 public:
  StructureSource() = default;
  StructureSource(const StructureSource&) = delete;
  StructureSource& operator=(const StructureSource&) = delete;
  virtual ~StructureSource() = default;

  /// Both functions throw DicomError if the structure cannot be read or is empty. The reason does not name the file.
  /// `scan`: the scan to be felt with it, or null.
  virtual StructureMeasures measure(int number, const RigidMotion& motion, const Geometry* scan) const = 0;
  virtual std::shared_ptr<const DistanceField> distance(int number, const DistanceOptions& options) const = 0;
  /// Throws as measure() does. May be larger than the box of measure(), and need not decode anything.
  virtual StructureBox box(int number, const RigidMotion& motion) const;
};

struct Structure {
  std::filesystem::path file;
  std::filesystem::path voxels_file;  ///< of a label map whose voxels lie in a file beside `file`; else empty
  StructureKind kind = StructureKind::segmentation;
  int number = 0;                      ///< SegmentNumber, ROINumber or the label's value
  std::string name;                    ///< SegmentLabel, ROIName, ...; else the meaning of its code
  std::string code;                    ///< code of its type: "SCT 10200004 Liver", or empty
  std::string color;                   ///< "#rrggbb", or empty
  std::string frame_of_reference_uid;  ///< empty if the file does not say
  std::string study_uid;
  std::string patient_id, patient_name;  ///< compared with the scan's; never written or shown
  /// The motion from the frame of reference in which it was outlined to frame_of_reference_uid, from a registration
  /// (registration.h).
  RigidMotion motion;
  Text unfit;  ///< why it cannot be felt; empty if it can
  std::vector<Text> warnings;
  std::shared_ptr<const StructureSource> source;
};

struct StructureCatalogue {
  std::vector<Structure> structures;        ///< by file, then by number
  std::vector<Registration> registrations;  ///< found among them, by file
  std::vector<SkippedFile> skipped;         ///< files that claim to hold structures but do not
};

/// The structures in these files and folders, which are searched to the bottom. Files of other kinds are ignored. In a
/// folder, a file that holds labels or an image is a label map if its values look like labels. If a file is itself in
/// `paths`, its labels may be as thin as a voxel; if it holds an image instead, it is skipped with a reason. Throws
/// DicomError if a path does not exist, and Cancelled.
StructureCatalogue find_structures(std::span<const std::filesystem::path> paths, const Progress& progress = {});

/// The registrations among these files, in their order. Reads headers alone. Throws Cancelled.
std::vector<Registration> find_registrations(std::span<const std::filesystem::path> files,
                                             const Progress& progress = {});

/// Reads one structure's distance, moved by its motion. Throws DicomError that names the file and the structure.
std::shared_ptr<const DistanceField> load_distance(const Structure& structure, const DistanceOptions& options = {});

/// Measures the structure after its motion. If the file gives no thickness for contours in a single plane, the scan's
/// is used. Throws DicomError that names the file and the structure.
StructureMeasures measure(const Structure& structure, const Geometry* scan = nullptr);

/// A box that contains the structure after its motion; for label maps much faster than measure(). Throws as
/// measure() does.
StructureBox box_of(const Structure& structure);

}  // namespace palpate::io
