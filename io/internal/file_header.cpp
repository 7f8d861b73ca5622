#include "palpate/io/internal/file_header.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcfilefo.h>
#include <dcmtk/dcmdata/dcistrmf.h>
#include <dcmtk/dcmdata/dcmetinf.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <dcmtk/dcmdata/dcxfer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>

#include "palpate/io/errors.h"
#include "palpate/io/internal/dicom_value.h"

namespace palpate::io::internal {
namespace {

// A dataset without the preamble and "DICM" of part 10 starts with a low group and a believable length; nothing else is
// handed to the parser, which would take a large text or picture for thousands of attributes.
void refuse_foreign(const std::filesystem::path& path, std::uint64_t size) {
  if (size == 0) throw DicomError("empty file");
  std::ifstream file(path, std::ios::binary);
  std::array<char, 132> start{};
  if (!file.read(start.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(start.size(), size)))) {
    throw DicomError("cannot be read: check its permissions");
  }
  if (size >= 132 && std::memcmp(start.data() + 128, "DICM", 4) == 0) return;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(start[i]); };
  const bool little = (byte(0) == 8 || byte(0) == 2) && byte(1) == 0 && byte(3) == 0;
  const bool big = byte(0) == 0 && (byte(1) == 8 || byte(1) == 2) && byte(2) == 0;
  const bool vr = std::isupper(byte(4)) != 0 && std::isupper(byte(5)) != 0;
  const bool short_value = byte(6) == 0 && byte(7) == 0 && byte(5) == 0;
  if (size < 132 || !((little && (vr || short_value)) || (big && vr))) throw DicomError("not a DICOM file");
}

std::optional<Placement> placement_of(DcmItem& item) {
  const auto position = numbers_of(item, DCM_ImagePositionPatient);
  const auto orientation = numbers_of(item, DCM_ImageOrientationPatient);
  const auto spacing = numbers_of(item, DCM_PixelSpacing);
  if (position.size() != 3 || orientation.size() != 6 || spacing.size() != 2) return std::nullopt;
  return make_placement(position, orientation, spacing);
}

void read_identity(DcmItem& item, FileHeader& header) {
  const std::string characters = text_of(item, DCM_SpecificCharacterSet);
  header.sop_class = text_of(item, DCM_SOPClassUID);
  header.sop_instance = text_of(item, DCM_SOPInstanceUID);
  header.series = text_of(item, DCM_SeriesInstanceUID);
  header.study = text_of(item, DCM_StudyInstanceUID);
  header.modality = text_of(item, DCM_Modality);
  header.description = utf8_of(text_of(item, DCM_SeriesDescription), characters);
  header.image_type = text_of(item, DCM_ImageType);
  header.identity.patient_name = utf8_of(text_of(item, DCM_PatientName), characters);
  header.identity.patient_id = utf8_of(text_of(item, DCM_PatientID), characters);
  header.identity.study_date = text_of(item, DCM_StudyDate);
  header.instance_number = number_of(item, DCM_InstanceNumber).value_or(0);
  header.thickness = number_of(item, DCM_SliceThickness).value_or(0);
}

std::string what_it_is(const FileHeader& header) {
  const char* name = dcmFindNameOfUID(header.sop_class.c_str());
  return name != nullptr ? std::string(name) : header.modality.empty() ? "DICOM" : header.modality;
}

void read_format(DcmItem& item, FileHeader& header) {
  const auto whole = [&](const DcmTagKey& tag, int otherwise) {
    return static_cast<int>(std::clamp(number_of(item, tag).value_or(otherwise), -1.0, 65536.0));
  };
  PixelFormat& format = header.format;
  format.columns = whole(DCM_Columns, 0);
  format.rows = whole(DCM_Rows, 0);
  format.bits_allocated = whole(DCM_BitsAllocated, 0);
  format.bits_stored = whole(DCM_BitsStored, format.bits_allocated);
  format.high_bit = whole(DCM_HighBit, format.bits_stored - 1);
  format.is_signed = whole(DCM_PixelRepresentation, 0) == 1;
  if (format.columns < 1 || format.rows < 1) throw DicomError(what_it_is(header) + ": no image in it");

  const std::string photometric = text_of(item, DCM_PhotometricInterpretation);
  if (whole(DCM_SamplesPerPixel, 1) != 1 || (photometric != "MONOCHROME1" && photometric != "MONOCHROME2")) {
    header.unfit = "colour image (" + photometric + "): it has no values to feel";
  } else if ((format.bits_allocated != 8 && format.bits_allocated != 16) || format.bits_stored < 1 ||
             format.high_bit < format.bits_stored - 1 || format.high_bit >= format.bits_allocated) {
    header.unfit = "pixels of " + std::to_string(format.bits_stored) + " bits in " +
                   std::to_string(format.bits_allocated) + " cannot be read";
  }
}

void read_values(DcmItem& item, FileHeader& header, Plane& plane) {
  plane.slope = number_of(item, DCM_RescaleSlope).value_or(1);
  plane.intercept = number_of(item, DCM_RescaleIntercept).value_or(0);
  const std::string type = text_of(item, DCM_RescaleType);
  if (header.modality == "CT" && (type.empty() || type == "HU")) header.unit = "HU";

  const auto signed_value = [&](double v) { return header.format.is_signed && v > 32767 ? v - 65536 : v; };
  if (const auto padding = number_of(item, DCM_PixelPaddingValue)) {
    const auto limit = number_of(item, DCM_PixelPaddingRangeLimit).value_or(*padding);
    header.padding = std::minmax(signed_value(*padding), signed_value(limit));
  }
}

// The bytes just before the pixel data's value: its tag, VR and length. DCMTK stops right behind them.
void check_length(const std::filesystem::path& path, std::uint64_t size, const DcmXfer& syntax, std::size_t frames,
                  FileHeader& header) {
  std::array<unsigned char, 4> bytes{};
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(header.pixels_at) - 4);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), 4)) {
    header.defect = "truncated before its pixels";
    return;
  }
  if (syntax.getByteOrder() == EBO_BigEndian) std::reverse(bytes.begin(), bytes.end());
  const std::uint64_t claimed = bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint64_t>(bytes[3]) << 24;
  const std::uint64_t present = std::min(claimed, size - std::min(size, header.pixels_at));
  const std::uint64_t needed = header.format.bytes_per_frame() * frames;
  if (present < needed) {
    header.defect = "truncated: " + std::to_string(present) + " of " + std::to_string(needed) + " bytes of pixels";
  }
}

}  // namespace

std::optional<Placement> make_placement(const std::vector<double>& position, const std::vector<double>& orientation,
                                        const std::vector<double>& spacing) {
  Placement place;
  place.position = {position[0], position[1], position[2]};
  place.direction_i = {orientation[0], orientation[1], orientation[2]};
  place.direction_j = {orientation[3], orientation[4], orientation[5]};
  place.spacing_i = spacing[1];
  place.spacing_j = spacing[0];
  // Cosines are rounded in the file; a visibly wrong length or angle is not rounding.
  constexpr double tolerance = 0.01;
  if (std::abs(glm::length(place.direction_i) - 1) > tolerance ||
      std::abs(glm::length(place.direction_j) - 1) > tolerance ||
      std::abs(glm::dot(place.direction_i, place.direction_j)) > tolerance || !(place.spacing_i > 0) ||
      !(place.spacing_j > 0)) {
    return std::nullopt;
  }
  return place;
}

FileHeader read_file_header(const std::filesystem::path& path) {
  const std::uint64_t size = std::filesystem::file_size(path);
  refuse_foreign(path, size);

  DcmFileFormat file;
  DcmInputFileStream stream(OFFilename(path.c_str()));
  file.transferInit();
  const OFCondition read = file.readUntilTag(stream, EXS_Unknown, EGL_noChange, DCM_MaxReadLength, DCM_PixelData);
  file.transferEnd();
  DcmDataset& dataset = *file.getDataset();
  if (read.bad()) throw DicomError(std::string("damaged header: ") + read.text());

  FileHeader header;
  header.path = path;
  read_identity(dataset, header);
  if (header.sop_class == UID_MediaStorageDirectoryStorage ||
      text_of(*file.getMetaInfo(), DCM_MediaStorageSOPClassUID) == UID_MediaStorageDirectoryStorage) {
    throw DicomError("DICOMDIR: an index; the files themselves are looked at");
  }
  read_format(dataset, header);

  const DcmXfer syntax(dataset.getOriginalXfer());
  header.transfer_syntax = syntax.getXferID();
  header.pixels_at = static_cast<std::uint64_t>(stream.tell());

  const double frames = number_of(dataset, DCM_NumberOfFrames).value_or(1);
  if (frames != 1) header.unfit = "several frames in one file";
  Plane plane;
  plane.placement = placement_of(dataset);
  if (header.unfit.empty() && !plane.placement) header.unfit = "no position in the patient";
  read_values(dataset, header, plane);
  header.planes.push_back(plane);
  if (syntax.isEncapsulated() || syntax.getStreamCompression() != ESC_none) {
    header.unfit = std::string("compressed: ") + syntax.getXferName();
  } else {
    check_length(path, size, syntax, header.planes.size(), header);
  }
  return header;
}

}  // namespace palpate::io::internal
