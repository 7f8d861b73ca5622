#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcsequen.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <optional>

#include "io/dicom/character_set.h"
#include "io/dicom/dicom_value.h"
#include "io/dicom/file_header.h"
#include "io/dicom/stacking.h"
#include "io/errors.h"
#include "io/messages.h"
#include "io/reach.h"
#include "io/structures/color.h"
#include "io/structures/mask_source.h"
#include "io/structures/placed_frames.h"
#include "io/structures/segment_frames.h"
#include "io/structures/structure_file.h"

namespace palpate::io {
namespace {

using internal::first_item;
using internal::number_of;
using internal::numbers_of;
using internal::Placement;
using internal::text_of;

/// One frame: its segment (0: all, in a label map), and its slice of the lattice.
struct SegmentFrame {
  int segment = 0;
  int slice = 0;
};

Mask::Fractions fractions_of(SegmentationType type) {
  if (type == SegmentationType::probability) return Mask::Fractions::probability;
  return type == SegmentationType::occupancy ? Mask::Fractions::occupancy : Mask::Fractions::none;
}

class SegmentationSource final : public MaskSource {
 public:
  SegmentationSource(SegmentationPixels pixels, SegmentationType type, double most,
                     const std::vector<PlacedFrame>& frames)
      : pixels_(std::move(pixels)), type_(type), most_(most) {
    const Placement& reference = frames.front().placement;
    const Vec3 normal = glm::normalize(glm::cross(reference.direction_i, reference.direction_j));
    for (const PlacedFrame& frame : frames) {
      if (!share_lattice(frame.placement, reference)) {
        throw DicomError(say("frames-have-several-orientations-or-pixel"));
      }
    }
    const FrameSlices slices = slices_of(frames, normal);
    const std::vector<int> steps = steps_between(slices, frames);
    std::vector<Vec3> positions;
    frames_.resize(frames.size());
    for (std::size_t k = 0; k < slices.position.size(); ++k) {
      for (const std::size_t n : slices.frames[k]) frames_[n] = {frames[n].segment, static_cast<int>(positions.size())};
      positions.push_back(slices.position[k]);
      if (k == steps.size()) break;
      const Vec3 step = (slices.position[k + 1] - slices.position[k]) / static_cast<double>(steps[k]);
      for (int n = 1; n < steps[k]; ++n) {
        assumed_slices_.push_back(static_cast<int>(positions.size()));
        positions.push_back(slices.position[k] + static_cast<double>(n) * step);
      }
    }
    const double spacing = frames.front().spacing;
    const double thickness = spacing > 0 ? spacing : frames.front().thickness;
    geometry_ = internal::stack_geometry(pixels_.format.columns, pixels_.format.rows, reference, std::move(positions),
                                         {}, thickness);
    geometry_.gaps.clear();
    has_no_thickness_ = geometry_.dimensions.z == 1 && !(thickness > 0);
  }

  /// Whether there is one slice and nothing says how thick it is.
  bool has_no_thickness() const { return has_no_thickness_; }

 private:
  struct Cut {
    int slice = 0;
    glm::ivec2 low{0}, size{0};
    std::vector<std::uint8_t> occupancy;
  };

  std::uint8_t occupancy_of(std::uint16_t stored, int number) const {
    if (type_ == SegmentationType::label_map) {
      return stored == number ? Mask::full : 0;
    }
    const double share = std::min(stored / most_, 1.0);
    return static_cast<std::uint8_t>(std::lround(share * Mask::full));
  }

  /// The part of a frame that contains some of the segment; of size zero if there is none.
  Cut cut_frame(FrameReader& reader, std::size_t n, int number, std::vector<std::uint16_t>& values) const {
    reader.read(static_cast<std::uint32_t>(n), values);
    Cut cut{.slice = frames_[n].slice};
    const int columns = geometry_.dimensions.x;
    glm::ivec2 low(std::numeric_limits<int>::max());
    glm::ivec2 high(-1);
    for (int j = 0; j < geometry_.dimensions.y; ++j) {
      for (int i = 0; i < columns; ++i) {
        const std::size_t at =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
        values[at] = occupancy_of(values[at], number);
        if (values[at] != 0) {
          low = glm::min(low, glm::ivec2(i, j));
          high = glm::max(high, glm::ivec2(i, j));
        }
      }
    }
    if (high.x < 0) {
      return cut;
    }
    cut.low = low;
    cut.size = high - low + 1;
    for (int j = low.y; j <= high.y; ++j) {
      const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(columns);
      for (int i = low.x; i <= high.x; ++i) {
        cut.occupancy.push_back(static_cast<std::uint8_t>(values[row + static_cast<std::size_t>(i)]));
      }
    }
    return cut;
  }

  Mask mask_of(int number) const override {
    std::vector<std::uint16_t> values(static_cast<std::size_t>(geometry_.dimensions.x) *
                                      static_cast<std::size_t>(geometry_.dimensions.y));
    FrameReader reader(pixels_);
    std::vector<Cut> cuts;
    glm::ivec3 low(std::numeric_limits<int>::max());
    glm::ivec3 high(-1);
    for (std::size_t n = 0; n < frames_.size(); ++n) {
      if (type_ != SegmentationType::label_map && frames_[n].segment != number) {
        continue;
      }
      Cut cut = cut_frame(reader, n, number, values);
      if (cut.size.x > 0) {
        low = glm::min(low, glm::ivec3(cut.low, cut.slice));
        high = glm::max(high, glm::ivec3(cut.low + cut.size - 1, cut.slice));
        cuts.push_back(std::move(cut));
      }
    }
    Mask mask;
    mask.geometry = geometry_;
    mask.fractions = fractions_of(type_);
    mask.assumed_slices = assumed_slices_;
    mask.has_no_thickness = has_no_thickness_;
    if (cuts.empty()) {
      return mask;
    }
    mask.low = low;
    mask.size = high - low + 1;
    mask.occupancy.assign(static_cast<std::size_t>(mask.size.x) * static_cast<std::size_t>(mask.size.y) *
                              static_cast<std::size_t>(mask.size.z),
                          0);
    for (const Cut& cut : cuts) {
      for (int j = 0; j < cut.size.y; ++j) {
        const auto from = cut.occupancy.begin() + static_cast<std::ptrdiff_t>(j) * cut.size.x;
        std::uint8_t* into =
            mask.occupancy.data() + mask.offset(cut.low.x - low.x, cut.low.y + j - low.y, cut.slice - low.z);
        for (int i = 0; i < cut.size.x; ++i) into[i] = std::max(into[i], from[i]);
      }
    }
    return mask;
  }

  SegmentationPixels pixels_;
  SegmentationType type_;
  double most_;
  Geometry geometry_;
  bool has_no_thickness_ = false;
  std::vector<SegmentFrame> frames_;
  std::vector<int> assumed_slices_;  ///< those of the lattice that no frame lies on
};

/// "SCT 10200004 Liver".
std::string code_in(DcmItem& segment) {
  DcmItem* code = first_item(segment, DCM_SegmentedPropertyTypeCodeSequence);
  if (code == nullptr) {
    return {};
  }
  return text_of(*code, DCM_CodingSchemeDesignator) + ' ' + internal::code_value(*code) + ' ' +
         text_of(*code, DCM_CodeMeaning);
}

std::string meaning_in(DcmItem& segment) {
  DcmItem* code = first_item(segment, DCM_SegmentedPropertyTypeCodeSequence);
  return code != nullptr ? text_of(*code, DCM_CodeMeaning) : std::string();
}

std::vector<Structure> segments_in(DcmItem& dataset) {
  std::vector<Structure> structures;
  const std::string characters = text_of(dataset, DCM_SpecificCharacterSet);
  DcmSequenceOfItems* segments = nullptr;
  if (dataset.findAndGetSequence(DCM_SegmentSequence, segments).bad()) {
    throw DicomError(say("names-no-segments"));
  }
  DcmObject* object = nullptr;
  while ((object = segments->nextInContainer(object)) != nullptr) {
    auto* segment = dynamic_cast<DcmItem*>(object);
    const auto number = segment != nullptr ? number_of(*segment, DCM_SegmentNumber) : std::nullopt;
    if (!number) continue;
    Structure structure;
    structure.number = static_cast<int>(std::clamp(*number, 0.0, 65535.0));
    structure.name = internal::utf8_of(text_of(*segment, DCM_SegmentLabel), characters);
    if (structure.name.empty()) structure.name = internal::utf8_of(meaning_in(*segment), characters);
    if (structure.name.empty()) structure.name = "segment " + std::to_string(structure.number);
    structure.code = internal::utf8_of(code_in(*segment), characters);
    structure.color = color_of_lab(numbers_of(*segment, DCM_RecommendedDisplayCIELabValue));
    structures.push_back(std::move(structure));
  }
  return structures;
}

/// A label map may also describe its background, which is not a structure.
void take_background_away(DcmItem& dataset, std::vector<Structure>& structures) {
  const auto padding =
      static_cast<int>(std::clamp(number_of(dataset, DCM_PixelPaddingValue).value_or(0), -1.0, 65535.0));
  std::erase_if(structures, [&](const Structure& structure) {
    return structure.number == padding || structure.code.starts_with("DCM 125040 ");
  });
}

/// Segments that frames name and the list of segments does not.
void add_undescribed(const std::vector<PlacedFrame>& frames, std::vector<Structure>& structures) {
  for (const PlacedFrame& frame : frames) {
    if (std::ranges::find(structures, frame.segment, &Structure::number) != structures.end()) continue;
    Structure& added = structures.emplace_back();
    added.number = frame.segment;
    added.name = "segment " + std::to_string(frame.segment);
    added.warnings.push_back(say("segment-is-not-described"));
  }
}

SegmentationType type_in(DcmItem& dataset, const std::string& sop_class) {
  const std::string type = text_of(dataset, DCM_SegmentationType);
  if (type == "LABELMAP" || sop_class == "1.2.840.10008.5.1.4.1.1.66.7") return SegmentationType::label_map;
  if (type == "FRACTIONAL") {
    const bool is_share = text_of(dataset, DCM_SegmentationFractionalType) == "OCCUPANCY";
    return is_share ? SegmentationType::occupancy : SegmentationType::probability;
  }
  if (type == "BINARY") return SegmentationType::binary;
  throw DicomError(say("segmentation-type-is-unknown", type));
}

internal::PixelFormat format_in(DcmItem& dataset) {
  const auto whole = [&](const DcmTagKey& tag, int otherwise) {
    return static_cast<int>(std::clamp(number_of(dataset, tag).value_or(otherwise), -1.0, 65535.0));
  };
  internal::PixelFormat format;
  format.columns = whole(DCM_Columns, 0);
  format.rows = whole(DCM_Rows, 0);
  format.bits_allocated = whole(DCM_BitsAllocated, 0);
  format.bits_stored = whole(DCM_BitsStored, format.bits_allocated);
  format.high_bit = whole(DCM_HighBit, format.bits_stored - 1);
  return format;
}

}  // namespace

std::vector<Structure> structures_of_segmentation(const StructureDataset& file) {
  DcmItem& dataset = file.dataset;
  if (dataset.tagExists(DCM_TotalPixelMatrixColumns)) {
    throw DicomError(say("outlines-a-microscope-slide"));
  }
  if (!file.pixels) {
    throw DicomError(say("no-pixels-export"));
  }
  const SegmentationType type = type_in(dataset, text_of(dataset, DCM_SOPClassUID));
  std::vector<Structure> structures = segments_in(dataset);
  const auto count = static_cast<std::size_t>(std::clamp(number_of(dataset, DCM_NumberOfFrames).value_or(1), 1.0, 1e6));
  const std::vector<PlacedFrame> frames = placed_frames(dataset, type, count);
  if (type == SegmentationType::label_map) {
    take_background_away(dataset, structures);
  } else {
    add_undescribed(frames, structures);
  }
  const bool is_fractional = fractions_of(type) != Mask::Fractions::none;
  const double most = is_fractional ? number_of(dataset, DCM_MaximumFractionalValue).value_or(255) : 1;
  if (!(most > 0)) {
    throw DicomError(say("maximumfractionalvalue-is-not-above-0"));
  }
  const auto source = std::make_shared<const SegmentationSource>(
      find_pixels(file.path, file.start, *file.pixels, format_in(dataset), count), type, most, frames);
  for (Structure& structure : structures) {
    structure.kind = StructureKind::segmentation;
    structure.source = source;
    if (source->has_no_thickness()) structure.warnings.push_back(say("one-slice-of-no-thickness"));
  }
  return structures;
}

}  // namespace palpate::io
