#include "io/results/study_header.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>

#include "io/dicom/character_set.h"
#include "io/dicom/dcmtk_start.h"
#include "io/dicom/series_source.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

// DICOM PS3.3 C.7.1.1, C.7.2.1: all attributes of type 1 and 2, and those by which archives match.
const DcmTagKey copied[] = {DCM_PatientName, DCM_PatientID,        DCM_IssuerOfPatientID, DCM_PatientBirthDate,
                            DCM_PatientSex,  DCM_StudyInstanceUID, DCM_StudyDate,         DCM_StudyTime,
                            DCM_StudyID,     DCM_AccessionNumber,  DCM_StudyDescription,  DCM_ReferringPhysicianName};
const DcmTagKey left_out_when_empty[] = {DCM_IssuerOfPatientID, DCM_StudyDescription};

std::string value_of(DcmItem& item, const DcmTagKey& key) {
  OFString value, set;
  item.findAndGetOFStringArray(key, value);
  item.findAndGetOFStringArray(DCM_SpecificCharacterSet, set);
  return internal::utf8_of(value.c_str(), set.c_str());
}

std::uint32_t number_of(const DcmTagKey& key) {
  return static_cast<std::uint32_t>(key.getGroup()) << 16U | key.getElement();
}

/// Where a file of the series is stored: an archive's may be unpacked.
std::filesystem::path stored_at(const Series& series, const std::filesystem::path& file) {
  if (!series.source || !series.source->files) return file;
  const auto found = std::ranges::find(*series.source->files, file, &internal::FileHeader::path);
  return found == series.source->files->end() ? file : found->stored_at;
}

void read_image(const Series& series, const std::filesystem::path& file, StudyHeader& header) {
  DcmFileFormat format;
  if (format
          .loadFileUntilTag(stored_at(series, file).c_str(), EXS_Unknown, EGL_noChange, 4096, ERM_autoDetect,
                            DCM_PixelData)
          .bad()) {
    throw DicomError(say("cannot-be-referred-to", file.string()));
  }
  DcmDataset& data = *format.getDataset();
  header.images.push_back(
      {value_of(data, DCM_SOPClassUID), value_of(data, DCM_SOPInstanceUID), value_of(data, DCM_SeriesInstanceUID)});
  if (header.images.size() > 1) return;
  header.study_uid = value_of(data, DCM_StudyInstanceUID);
  header.series_uid = value_of(data, DCM_SeriesInstanceUID);
  header.frame_of_reference_uid = value_of(data, DCM_FrameOfReferenceUID);
  for (const DcmTagKey& key : copied) {
    const std::string value = value_of(data, key);
    const bool wanted = key != left_out_when_empty[0] && key != left_out_when_empty[1];
    if (wanted || !value.empty()) header.attributes.emplace_back(number_of(key), value);
  }
}

}  // namespace

StudyHeader read_study_header(const Series& series) {
  internal::start_dcmtk();
  StudyHeader header;
  for (const std::filesystem::path& file : series.files) read_image(series, file, header);
  if (header.study_uid.empty() || header.series_uid.empty() || header.frame_of_reference_uid.empty()) {
    throw DicomError(say("series-its-images-name-no-study", series.uid));
  }
  return header;
}

void put_study(const StudyHeader& header, DcmItem& dataset) {
  dataset.putAndInsertString(DCM_SpecificCharacterSet, "ISO_IR 192");
  for (const auto& [number, value] : header.attributes) {
    const DcmTagKey key(static_cast<Uint16>(number >> 16U), static_cast<Uint16>(number & 0xFFFFU));
    dataset.putAndInsertString(key, value.c_str());
  }
}

}  // namespace palpate::io
