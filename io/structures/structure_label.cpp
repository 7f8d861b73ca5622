#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>

#include <cmath>

#include "io/dicom/character_set.h"
#include "io/dicom/dcmtk_start.h"
#include "io/dicom/dicom_value.h"
#include "io/errors.h"
#include "io/messages.h"
#include "io/structures/label_image.h"

namespace palpate::io {
namespace {

using internal::first_item;
using internal::text_of;

/// Texts of a dataset in UTF-8.
struct Texts {
  std::string characters;

  std::string operator()(DcmItem& item, const DcmTagKey& key) const {
    return internal::utf8_of(text_of(item, key), characters);
  }
  Code code(DcmItem* item) const {
    if (item == nullptr) return {};
    return {internal::code_value(*item), (*this)(*item, DCM_CodingSchemeDesignator), (*this)(*item, DCM_CodeMeaning)};
  }
};

/// The item of a sequence with this number; null if there is none.
DcmItem* item_of_number(DcmItem& dataset, const DcmTagKey& sequence, const DcmTagKey& key, int number) {
  DcmSequenceOfItems* items = nullptr;
  if (dataset.findAndGetSequence(sequence, items).bad()) return nullptr;
  DcmObject* object = nullptr;
  while ((object = items->nextInContainer(object)) != nullptr) {
    auto* item = dynamic_cast<DcmItem*>(object);
    const auto found = item != nullptr ? internal::number_of(*item, key) : std::nullopt;
    if (found && std::lround(*found) == number) return item;
  }
  return nullptr;
}

void read_segment(DcmItem& segment, const Texts& texts, StructureLabel& label) {
  label.category = texts.code(first_item(segment, DCM_SegmentedPropertyCategoryCodeSequence));
  label.tracking_id = texts(segment, DCM_TrackingID);
  label.tracking_uid = texts(segment, DCM_TrackingUID);
  DcmItem* type = first_item(segment, DCM_SegmentedPropertyTypeCodeSequence);
  label.type = texts.code(type);
  DcmSequenceOfItems* modifiers = nullptr;
  if (type == nullptr || type->findAndGetSequence(DCM_SegmentedPropertyTypeModifierCodeSequence, modifiers).bad()) {
    return;
  }
  DcmObject* object = nullptr;
  while ((object = modifiers->nextInContainer(object)) != nullptr) {
    if (auto* item = dynamic_cast<DcmItem*>(object)) label.modifiers.push_back(texts.code(item));
  }
}

void read_observation(DcmItem& observation, const Texts& texts, StructureLabel& label) {
  label.interpreted_type = texts(observation, DCM_RTROIInterpretedType);
  label.type = texts.code(first_item(observation, DCM_RTROIIdentificationCodeSequence));
  label.category = texts.code(first_item(observation, DCM_SegmentedPropertyCategoryCodeSequence));
}

}  // namespace

StructureLabel label_of(const Structure& structure) {
  StructureLabel label{.name = structure.name, .color = structure.color};
  if (structure.file.empty()) return label;  // it was made, not found
  StructureLabel::Origin origin{.file = structure.file, .number = structure.number};
  if (structure.kind != StructureKind::label_map) {
    internal::start_dcmtk();
    DcmFileFormat format;
    if (format
            .loadFileUntilTag(structure.file.c_str(), EXS_Unknown, EGL_noChange, DCM_MaxReadLength, ERM_autoDetect,
                              DCM_PixelData)
            .bad()) {
      throw DicomError(say("cannot-be-referred-to", structure.file.string()));
    }
    DcmDataset& data = *format.getDataset();
    const Texts texts{text_of(data, DCM_SpecificCharacterSet)};
    origin.sop_class = text_of(data, DCM_SOPClassUID);
    origin.instance = text_of(data, DCM_SOPInstanceUID);
    origin.series_uid = text_of(data, DCM_SeriesInstanceUID);
    origin.study_uid = text_of(data, DCM_StudyInstanceUID);
    if (DcmItem* segment = item_of_number(data, DCM_SegmentSequence, DCM_SegmentNumber, structure.number)) {
      read_segment(*segment, texts, label);
    }
    if (DcmItem* observation =
            item_of_number(data, DCM_RTROIObservationsSequence, DCM_ReferencedROINumber, structure.number)) {
      read_observation(*observation, texts, label);
    }
  }
  label.origin = std::move(origin);
  return label;
}

}  // namespace palpate::io
