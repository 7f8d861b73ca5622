#include "io/structures/structure.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <optional>
#include <stdexcept>

#include "io/dicom/asked_for.h"
#include "io/dicom/character_set.h"
#include "io/dicom/dcmtk_start.h"
#include "io/dicom/dicom_value.h"
#include "io/errors.h"
#include "io/files_below.h"
#include "io/messages.h"
#include "io/parallel.h"
#include "io/structures/structure_file.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using internal::text_of;

constexpr const char* segmentation_storage = "1.2.840.10008.5.1.4.1.1.66.4";
constexpr const char* label_map_segmentation_storage = "1.2.840.10008.5.1.4.1.1.66.7";
constexpr const char* surface_segmentation_storage = "1.2.840.10008.5.1.4.1.1.66.5";
constexpr const char* structure_set_storage = "1.2.840.10008.5.1.4.1.1.481.3";

/// The contents of a file; nothing if it is of another type. `is_named`: by the user, and not by its folder.
StructureCatalogue structures_in(const fs::path& path, bool is_named) {
  if (std::vector<Structure> labels = structures_of_label_map(path, is_named); !labels.empty())
    return {std::move(labels), {}, {}};
  std::optional<internal::InputFile> file;
  internal::DatasetStart start;
  DcmDataset dataset;
  std::optional<internal::PixelElement> pixels;
  std::string sop_class;
  try {
    file.emplace(path);
    start = internal::find_dataset(*file);
    pixels = internal::parse_header(*file, path, start, dataset, internal::is_asked_for_of_structures);
    sop_class = text_of(dataset, DCM_SOPClassUID);
  } catch (const DicomError&) {
    return {};  // no DICOM file, or none that can be read: find_series() says so
  }
  const StructureDataset read{path, start, pixels, dataset};
  if (auto registration = registration_in(dataset, path)) return {{}, {std::move(*registration)}, {}};
  std::vector<Structure> structures;
  if (sop_class == segmentation_storage || sop_class == label_map_segmentation_storage) {
    structures = structures_of_segmentation(read);
  } else if (sop_class == structure_set_storage) {
    structures = structures_of_contours(read);
  } else if (sop_class == surface_segmentation_storage) {
    throw DicomError(say("holds-surfaces"));
  }
  const std::string frame_of_reference = text_of(dataset, DCM_FrameOfReferenceUID);
  const std::string characters = text_of(dataset, DCM_SpecificCharacterSet);
  for (Structure& structure : structures) {
    structure.file = path;
    structure.study_uid = text_of(dataset, DCM_StudyInstanceUID);
    structure.patient_id = internal::utf8_of(text_of(dataset, DCM_PatientID), characters);
    structure.patient_name = internal::utf8_of(text_of(dataset, DCM_PatientName), characters);
    if (structure.frame_of_reference_uid.empty()) structure.frame_of_reference_uid = frame_of_reference;
  }
  return {std::move(structures), {}, {}};
}

std::string in_words(const Structure& structure) {
  return structure.file.filename().string() + ": " + name_of(structure.kind) + " \"" + structure.name + "\" (" +
         std::to_string(structure.number) + ")";
}

/// What `work` gives, with file and structure named where it throws.
template <typename Work>
auto named(const Structure& structure, const Work& work) {
  if (!structure.source || !structure.unfit.empty()) {
    throw DicomError(say("structure-cannot-be-felt", in_words(structure), structure.unfit));
  }
  try {
    return work(*structure.source);
  } catch (const std::exception& error) {
    throw DicomError(say("structure-cannot-be-read", in_words(structure), error.what()));
  }
}

}  // namespace

const char* name_of(StructureKind kind) noexcept {
  switch (kind) {
    case StructureKind::segmentation:
      return "SEG";
    case StructureKind::contours:
      return "RTSTRUCT";
    case StructureKind::label_map:
      return "label map";
  }
  return "";
}

StructureCatalogue find_structures(std::span<const fs::path> paths, const Progress& progress) {
  internal::start_dcmtk();
  StructureCatalogue catalogue;
  const std::vector<fs::path> files = internal::files_below(paths, catalogue.skipped, progress);
  std::vector<fs::path> named_paths(paths.begin(), paths.end());
  std::ranges::sort(named_paths);
  std::vector<StructureCatalogue> found(files.size());
  std::vector<Text> reasons(files.size());
  internal::parallel_for(
      files.size(),
      [&](std::size_t n) {
        try {
          found[n] = structures_in(files[n], std::ranges::binary_search(named_paths, files[n]));
        } catch (const Refusal& error) {
          reasons[n] = error.text();
        } catch (const std::exception& error) {
          reasons[n] = say("file-cannot-be-read", error.what());
        }
      },
      progress, 0);
  for (std::size_t n = 0; n < files.size(); ++n) {
    std::ranges::stable_sort(found[n].structures, {}, &Structure::number);
    std::ranges::move(found[n].structures, std::back_inserter(catalogue.structures));
    std::ranges::move(found[n].registrations, std::back_inserter(catalogue.registrations));
    if (!reasons[n].empty()) catalogue.skipped.push_back({files[n], reasons[n]});
  }
  return catalogue;
}

std::vector<Registration> find_registrations(std::span<const fs::path> files, const Progress& progress) {
  internal::start_dcmtk();
  std::vector<std::optional<Registration>> found(files.size());
  internal::parallel_for(
      files.size(),
      [&](std::size_t n) {
        try {
          const internal::InputFile file(files[n]);
          DcmDataset dataset;
          internal::parse_header(file, files[n], internal::find_dataset(file), dataset,
                                 internal::is_asked_for_of_registrations);
          found[n] = registration_in(dataset, files[n]);
        } catch (const std::exception&) {  // no DICOM file, or none that can be read: find_structures() says so
        }
      },
      progress, 0);
  std::vector<Registration> registrations;
  for (std::optional<Registration>& one : found) {
    if (one) registrations.push_back(std::move(*one));
  }
  return registrations;
}

std::shared_ptr<const DistanceField> load_distance(const Structure& structure, const DistanceOptions& options) {
  DistanceOptions moved = options;
  moved.motion = structure.motion;
  return named(structure, [&](const StructureSource& source) { return source.distance(structure.number, moved); });
}

StructureMeasures measure(const Structure& structure, const Geometry* scan) {
  return named(structure,
               [&](const StructureSource& source) { return source.measure(structure.number, structure.motion, scan); });
}

StructureBox box_of(const Structure& structure) {
  return named(structure,
               [&](const StructureSource& source) { return source.box(structure.number, structure.motion); });
}

StructureBox StructureSource::box(int number, const RigidMotion& motion) const {
  const StructureMeasures measures = measure(number, motion, nullptr);
  return {measures.box_low_mm, measures.box_high_mm};
}

bool is_off(const StructureBox& box, const Geometry& scan) {
  Vec3 low(std::numeric_limits<double>::infinity());
  Vec3 high(-std::numeric_limits<double>::infinity());
  for (int corner = 0; corner < 8; ++corner) {
    const auto end = [&](int axis) { return (corner >> axis) % 2 == 0 ? box.low_mm[axis] : box.high_mm[axis]; };
    const Vec3 index = scan.to_index({end(0), end(1), end(2)});
    low = glm::min(low, index);
    high = glm::max(high, index);
  }
  const Vec3 ends(scan.dimensions);  // a voxel beyond the outermost ones
  return glm::any(glm::lessThan(high, Vec3(-1))) || glm::any(glm::greaterThan(low, ends));
}

}  // namespace palpate::io
