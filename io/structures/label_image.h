#pragma once

/// A structure that is to be written: its name and codes, the scan's voxels that are inside it, its contours on the
/// scan's slices, and the files that hold them.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/geometry.h"
#include "io/progress.h"
#include "io/series.h"
#include "io/structures/structure.h"

namespace palpate::io {

/// The signed distance of a point in patient space, mm: positive inside. It is called from several threads at once.
using SignedDistance = std::function<double(const Vec3& position_mm)>;

/// A coded concept (DICOM PS3.3, 8.8).
struct Code {
  std::string value, scheme, meaning;

  bool operator==(const Code&) const = default;
};

/// Name, codes and origin of a structure. All texts are UTF-8.
struct StructureLabel {
  std::string name;
  std::string color;                      ///< "#rrggbb", or empty
  Code category, type;                    ///< SegmentedPropertyCategory and -Type; without a value if unknown
  std::vector<Code> modifiers;            ///< of the type: "Right", ...
  std::string tracking_id, tracking_uid;  ///< of the lesion or organ, the same in all of its outlines; or empty
  std::string interpreted_type;           ///< RTROIInterpretedType: "ORGAN", "PTV", ...; or empty

  /// The file and the object in it that was corrected; without an instance if it is not DICOM.
  struct Origin {
    std::filesystem::path file;
    std::string sop_class, instance, series_uid, study_uid;
    int number = 0;
  };
  std::optional<Origin> origin;
};

/// The label of a structure that was found. Reads its file's header. Throws DicomError if that cannot be read. Without
/// a file it has only name and color.
StructureLabel label_of(const Structure& structure);

/// A structure on a scan's grid, which may be oblique, tilted or uneven.
struct LabelImage {
  StructureLabel label;
  Geometry geometry;
  std::vector<std::uint8_t> inside;  ///< 1 inside, 0 outside; of all voxels, i fastest, then j, then k

  std::size_t offset(int i, int j, int k) const noexcept {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(geometry.dimensions.y) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(geometry.dimensions.x) +
           static_cast<std::size_t>(i);
  }
};

/// The voxels of the scan whose centers have a distance above 0. All voxels outside the box `within` count as
/// outside; `distance` is not called there. Throws Cancelled.
LabelImage sample_labels(StructureLabel label, const Geometry& scan, const SignedDistance& distance,
                         const std::optional<StructureBox>& within = {}, const Progress& progress = {});

/// The edge of a structure on a scan's slices.
struct SliceContours {
  StructureLabel label;
  Geometry geometry;
  struct Slice {
    int k = 0;                                ///< of the scan
    std::vector<std::vector<Vec3>> contours;  ///< closed, in the slice's plane; the last point is joined to the first
  };
  std::vector<Slice> slices;  ///< those that have a contour, ascending
};

/// Contours where the distance is 0, from a lattice in each slice that is twice as fine as its voxels. A hole is
/// joined to the contour around it by a line there and back ("keyhole"). The structure ends at the scan's outermost
/// voxels' edges. Throws as sample_labels().
SliceContours trace_slices(StructureLabel label, const Geometry& scan, const SignedDistance& distance,
                           const std::optional<StructureBox>& within = {}, const Progress& progress = {});

struct WriteOptions {
  bool overwrite = false;        ///< an existing file; never the one that was corrected
  std::string software_version;  ///< Palpate's
  int frame = 0;                 ///< of the series (frames_per_position): the frame of the correction
};

/// DICOM Segmentation, BINARY and SEMIAUTOMATIC, with a frame for each slice from the structure's first to its last
/// one. It belongs to the study of the scan, as a series of its own, and refers to the images of these slices and to
/// the corrected object.
///
/// This and all other writers write whole files or nothing. They throw DicomError if the structure is empty, the
/// file exists or cannot be written, or the format cannot hold the structure.
void write_segmentation(const LabelImage& image, const Series& scan, const std::filesystem::path& file,
                        const WriteOptions& options);

/// DICOM RT Structure Set with one ROI; otherwise as write_segmentation().
void write_contours(const SliceContours& contours, const Series& scan, const std::filesystem::path& file,
                    const WriteOptions& options);

/// A label map in the format of the file's name (label_formats()). It has a single step between slices, so a scan with
/// uneven slices is refused.
void write_label_map(const LabelImage& image, const std::filesystem::path& file, const WriteOptions& options);

/// The kind of object that a file's name asks for.
enum class StructureForm : std::uint8_t { segmentation, contours, label_map };

/// By its ending: ".dcm" is a segmentation, or contours if `rtstruct`. Throws DicomError for any other ending than
/// those above, and if `rtstruct` does not fit.
StructureForm form_of(const std::filesystem::path& file, bool rtstruct);

/// Samples or traces the structure and writes it in that form. `scan`: the series; `geometry`: of the frame of the
/// correction.
void write_structure(const StructureLabel& label, const Series& scan, const Geometry& geometry,
                     const SignedDistance& distance, const std::optional<StructureBox>& within, StructureForm form,
                     const std::filesystem::path& file, const WriteOptions& options, const Progress& progress = {});

}  // namespace palpate::io
