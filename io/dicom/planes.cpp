#include "io/dicom/planes.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcitem.h>
#include <dcmtk/dcmdata/dcsequen.h>
#include <dcmtk/dcmdata/dcuid.h>

#include <charconv>
#include <cmath>

#include "io/dicom/b_value.h"
#include "io/dicom/dicom_value.h"
#include "io/dicom/velocity.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

std::string label_of(std::optional<double> value) {
  if (!value) return {};
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), *value).ptr};
}

std::string& at(Labels& labels, Label label) {
  return labels[static_cast<std::size_t>(label)];
}

// Looks into a frame's own functional groups first, then into the shared ones.
class FunctionalGroups {
 public:
  FunctionalGroups(DcmItem& own, DcmItem* shared) : own_(own), shared_(shared) {}

  DcmItem* group(const DcmTagKey& sequence) const {
    DcmItem* found = first_item(own_, sequence);
    return found != nullptr || shared_ == nullptr ? found : first_item(*shared_, sequence);
  }
  std::vector<double> numbers(const DcmTagKey& sequence, const DcmTagKey& tag) const {
    DcmItem* item = group(sequence);
    return item != nullptr ? numbers_of(*item, tag) : std::vector<double>();
  }
  std::optional<double> number(const DcmTagKey& sequence, const DcmTagKey& tag) const {
    const auto values = numbers(sequence, tag);
    return values.empty() ? std::nullopt : std::optional(values.front());
  }
  std::string text(const DcmTagKey& sequence, const DcmTagKey& tag) const {
    DcmItem* item = group(sequence);
    return item != nullptr ? text_of(*item, tag) : std::string();
  }

 private:
  DcmItem& own_;
  DcmItem* shared_;
};

Labels labels_of(const FunctionalGroups& groups) {
  Labels labels;
  for (const DcmTagKey& sequence : {DCM_MRImageFrameTypeSequence, DCM_CTImageFrameTypeSequence}) {
    at(labels, Label::image_type) +=
        groups.text(sequence, DCM_FrameType) + groups.text(sequence, DCM_ComplexImageComponent);
  }
  at(labels, Label::kernel) = groups.text(DCM_CTReconstructionSequence, DCM_ConvolutionKernel);
  at(labels, Label::laterality) = groups.text(DCM_FrameAnatomySequence, DCM_FrameLaterality);
  at(labels, Label::echo_time) = label_of(groups.number(DCM_MREchoSequence, DCM_EffectiveEchoTime));
  at(labels, Label::b_value) = label_of(groups.number(DCM_MRDiffusionSequence, DCM_DiffusionBValue));
  if (DcmItem* diffusion = groups.group(DCM_MRDiffusionSequence)) {
    if (DcmItem* direction = first_item(*diffusion, DCM_DiffusionGradientDirectionSequence)) {
      at(labels, Label::diffusion_direction) = text_of(*direction, DCM_DiffusionGradientOrientation);
    }
  }
  at(labels, Label::velocity_encoding) = groups.text(DCM_MRVelocityEncodingSequence, DCM_VelocityEncodingDirection);
  at(labels, Label::time_point) = label_of(groups.number(DCM_FrameContentSequence, DCM_TemporalPositionIndex));
  at(labels, Label::trigger_time) =
      label_of(groups.number(DCM_CardiacSynchronizationSequence, DCM_NominalCardiacTriggerDelayTime));
  return labels;
}

std::optional<Series::Window> window_of(std::optional<double> level, std::optional<double> width) {
  const bool sound = level && width && std::isfinite(*level) && std::isfinite(*width) && *width > 0;
  return sound ? std::optional(Series::Window{*level, *width}) : std::nullopt;
}

// A text that is not a number (a decimal comma) must not count as an absent attribute.
double rescale_number(DcmItem* item, const DcmTagKey& tag, double otherwise, FileHeader& header) {
  if (item == nullptr) return otherwise;
  const auto value = number_of(*item, tag);
  if (value) return *value;
  if (!text_of(*item, tag).empty()) header.unfit = say("rescale-is-no-number");
  return otherwise;
}

// `item`: the dataset, or a frame's functional group; null if there is none.
void read_rescale(DcmItem* item, FileHeader& header, Plane& plane) {
  plane.slope = rescale_number(item, DCM_RescaleSlope, 1, header);
  plane.intercept = rescale_number(item, DCM_RescaleIntercept, 0, header);
  if (plane.slope == 0) header.unfit = say("rescale-slope-is-0");
  if (header.modality != "CT") return;
  const bool rescaled = item != nullptr && !text_of(*item, DCM_RescaleIntercept).empty();
  const std::string type = item != nullptr ? text_of(*item, DCM_RescaleType) : std::string();
  header.unit = rescaled && (type.empty() || type == "HU") ? "HU" : "";
}

// A parametric map defines its values by a real world value mapping (PS3.3 C.7.6.16.2.11): slope, intercept and a UCUM
// unit. Of several mappings, the first linear one is used.
void read_real_world_values(const FunctionalGroups& groups, FileHeader& header, Plane& plane) {
  DcmItem* const mapping = groups.group(DCM_RealWorldValueMappingSequence);
  if (mapping == nullptr) return;
  const auto slope = number_of(*mapping, DCM_RealWorldValueSlope);
  const auto intercept = number_of(*mapping, DCM_RealWorldValueIntercept);
  if (!slope || !intercept) {
    header.unfit = say("real-world-values-need-a-table");
    return;
  }
  if (*slope == 0) header.unfit = say("rescale-slope-is-0");
  plane.slope = *slope;
  plane.intercept = *intercept;
  at(plane.labels, Label::image_type) += text_of(*mapping, DCM_LUTLabel);
  DcmItem* const unit = first_item(*mapping, DCM_MeasurementUnitsCodeSequence);
  // In UCUM, "1" and "{ratio}" mean no unit.
  const std::string code = unit != nullptr ? text_of(*unit, DCM_CodeValue) : std::string();
  header.unit = code == "1" || code.starts_with('{') ? "" : code == "[hnsf'U]" ? "HU" : code;
}

Plane plane_of(const FunctionalGroups& groups, std::uint32_t frame, FileHeader& header) {
  Plane plane;
  plane.frame = frame;
  plane.placement = make_placement(groups.numbers(DCM_PlanePositionSequence, DCM_ImagePositionPatient),
                                   groups.numbers(DCM_PlaneOrientationSequence, DCM_ImageOrientationPatient),
                                   groups.numbers(DCM_PixelMeasuresSequence, DCM_PixelSpacing));
  read_rescale(groups.group(DCM_PixelValueTransformationSequence), header, plane);
  plane.window = window_of(groups.number(DCM_FrameVOILUTSequence, DCM_WindowCenter),
                           groups.number(DCM_FrameVOILUTSequence, DCM_WindowWidth));
  plane.labels = labels_of(groups);
  if (header.sop_class == UID_ParametricMapStorage) read_real_world_values(groups, header, plane);
  std::string& type = at(plane.labels, Label::image_type);
  if (type.empty()) type = header.image_type;
  plane.velocity =
      velocity_of(groups.numbers(DCM_MRVelocityEncodingSequence, DCM_VelocityEncodingDirection),
                  groups.number(DCM_MRVelocityEncodingSequence, DCM_VelocityEncodingMaximumValue),
                  groups.text(DCM_PixelValueTransformationSequence, DCM_RescaleType), plane, header.format);
  return plane;
}

}  // namespace

Plane classic_plane(DcmItem& dataset, FileHeader& header) {
  Plane plane;
  plane.placement =
      make_placement(numbers_of(dataset, DCM_ImagePositionPatient), numbers_of(dataset, DCM_ImageOrientationPatient),
                     numbers_of(dataset, DCM_PixelSpacing));
  read_rescale(&dataset, header, plane);
  plane.window = window_of(number_of(dataset, DCM_WindowCenter), number_of(dataset, DCM_WindowWidth));
  at(plane.labels, Label::image_type) = header.image_type;
  at(plane.labels, Label::kernel) = text_of(dataset, DCM_ConvolutionKernel);
  at(plane.labels, Label::laterality) = text_of(dataset, DCM_ImageLaterality);
  at(plane.labels, Label::echo_time) = label_of(number_of(dataset, DCM_EchoTime));
  at(plane.labels, Label::b_value) = label_of(b_value_of(dataset));
  at(plane.labels, Label::diffusion_direction) = text_of(dataset, DCM_DiffusionGradientOrientation);
  at(plane.labels, Label::time_point) = label_of(number_of(dataset, DCM_TemporalPositionIdentifier));
  at(plane.labels, Label::trigger_time) = label_of(number_of(dataset, DCM_TriggerTime));
  at(plane.labels, Label::acquisition) = label_of(number_of(dataset, DCM_AcquisitionNumber));
  read_classic_velocity(dataset, header, plane);
  return plane;
}

std::vector<Plane> functional_group_planes(DcmItem& dataset, FileHeader& header, std::size_t frames) {
  std::vector<Plane> planes;
  DcmSequenceOfItems* per_frame = nullptr;
  if (dataset.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, per_frame).bad()) return planes;
  DcmItem* const shared = first_item(dataset, DCM_SharedFunctionalGroupsSequence);
  DcmObject* object = nullptr;
  // Not by index: that walks the list from its start for every frame.
  while (planes.size() < frames && (object = per_frame->nextInContainer(object)) != nullptr) {
    auto* own = dynamic_cast<DcmItem*>(object);
    if (own == nullptr) break;
    const FunctionalGroups groups(*own, shared);
    if (planes.empty() && !(header.thickness > 0)) {
      header.thickness = groups.number(DCM_PixelMeasuresSequence, DCM_SliceThickness).value_or(0);
      header.details.thickness_mm = header.thickness;
    }
    planes.push_back(plane_of(groups, static_cast<std::uint32_t>(planes.size()), header));
  }
  return planes;
}

}  // namespace palpate::io::internal
