#include "io/dicom/file_header.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <dcmtk/dcmdata/dcxfer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/dicom/character_set.h"
#include "io/dicom/dataset.h"
#include "io/dicom/decode.h"
#include "io/dicom/dicom_value.h"
#include "io/dicom/file_kind.h"
#include "io/dicom/planes.h"
#include "io/dicom/word_order.h"
#include "io/errors.h"
#include "io/messages.h"
#include "io/reach.h"

namespace palpate::io::internal {
namespace {

void read_identity(DcmItem& item, FileHeader& header) {
  const std::string characters = text_of(item, DCM_SpecificCharacterSet);
  header.sop_class = text_of(item, DCM_SOPClassUID);
  header.sop_instance = text_of(item, DCM_SOPInstanceUID);
  header.series = text_of(item, DCM_SeriesInstanceUID);
  header.frame_of_reference = text_of(item, DCM_FrameOfReferenceUID);
  header.study = text_of(item, DCM_StudyInstanceUID);
  header.modality = utf8_of(text_of(item, DCM_Modality), characters);
  header.description = utf8_of(text_of(item, DCM_SeriesDescription), characters);
  header.image_type = text_of(item, DCM_ImageType);
  header.identity.patient_name = utf8_of(text_of(item, DCM_PatientName), characters);
  header.identity.patient_id = utf8_of(text_of(item, DCM_PatientID), characters);
  header.identity.study_date = text_of(item, DCM_StudyDate);
  header.instance_number = number_of(item, DCM_InstanceNumber).value_or(0);
  header.acquisition_time = text_of(item, DCM_AcquisitionDate) + text_of(item, DCM_AcquisitionTime);
  header.content_time = text_of(item, DCM_ContentDate) + text_of(item, DCM_ContentTime);
  header.thickness = number_of(item, DCM_SliceThickness).value_or(0);
}

std::string first_of(DcmItem& item, std::initializer_list<DcmTagKey> tags) {
  for (const DcmTagKey& tag : tags) {
    if (std::string text = text_of(item, tag); !text.empty()) return text;
  }
  return {};
}

// PET says its unit in a word of its own (PS3.3 C.8.9.1).
std::string pet_unit_of(DcmItem& item) {
  const std::string units = text_of(item, DCM_Units);
  if (units == "BQML") return "Bq/ml";
  return units == "GML" ? "g/ml" : "";
}

void read_details(DcmItem& item, FileHeader& header) {
  const std::string characters = text_of(item, DCM_SpecificCharacterSet);
  Series::Details& details = header.details;
  if (const auto number = number_of(item, DCM_SeriesNumber)) {
    details.number = static_cast<int>(std::clamp(*number, -1e9, 1e9));
  }
  details.date = first_of(item, {DCM_SeriesDate, DCM_AcquisitionDate, DCM_StudyDate});
  details.time = first_of(item, {DCM_SeriesTime, DCM_AcquisitionTime});
  details.body_part = utf8_of(text_of(item, DCM_BodyPartExamined), characters);
  details.kernel = utf8_of(text_of(item, DCM_ConvolutionKernel), characters);
  std::replace(details.kernel.begin(), details.kernel.end(), '\\', ' ');
  details.sequence = utf8_of(first_of(item, {DCM_SequenceName, DCM_ScanningSequence}), characters);
  std::replace(details.sequence.begin(), details.sequence.end(), '\\', ' ');
  details.contrast = utf8_of(text_of(item, DCM_ContrastBolusAgent), characters);
  details.thickness_mm = header.thickness;
  details.is_derived = header.image_type.starts_with("DERIVED");
  for (const char* word : {"PROJECTION IMAGE", "MIP", "MINIP", "MAX_IP", "MIN_IP", "\\MAXIMUM", "\\MINIMUM"}) {
    details.is_projection |= header.image_type.find(word) != std::string::npos;
  }
  details.is_lossy = text_of(item, DCM_LossyImageCompression) == "01";
  // One ratio a compression, the first one first.
  for (const double ratio : numbers_of(item, DCM_LossyImageCompressionRatio)) {
    details.compression_ratio = std::max(details.compression_ratio, 1.0) * ratio;
  }
  if (header.modality == "PT") header.unit = pet_unit_of(item);
}

std::string what_it_is(const FileHeader& header) {
  const char* name = dcmFindNameOfUID(header.sop_class.c_str());
  return name != nullptr ? std::string(name) : header.modality.empty() ? "DICOM" : header.modality;
}

// Whether numbers of so many bits can be read.
bool can_read(const PixelFormat& format, bool is_double) {
  if (format.is_float) return format.bits_allocated == (is_double ? 64 : 32);
  return (format.bits_allocated == 8 || format.bits_allocated == 16 || format.bits_allocated == 32) &&
         format.bits_stored >= 1 && format.high_bit >= format.bits_stored - 1 &&
         format.high_bit < format.bits_allocated;
}

void read_format(DcmItem& item, const std::optional<PixelElement>& pixels, FileHeader& header) {
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
  format.is_float = pixels && pixels->is_float;
  if (format.columns < 1 || format.rows < 1) throw NotAnImage(say("no-image", what_it_is(header)), header.sop_class);

  header.columns = format.columns;
  header.rows = format.rows;

  const std::string photometric = text_of(item, DCM_PhotometricInterpretation);
  const bool gray = photometric.empty() || photometric == "MONOCHROME1" || photometric == "MONOCHROME2";
  if (whole(DCM_SamplesPerPixel, 1) != 1 || !gray) {
    header.unfit = say("color-image-it-has-no-values", photometric);
  } else if (!can_read(format, pixels && pixels->is_double)) {
    header.unfit = say("pixels-of-bits", format.bits_stored, format.bits_allocated, format.high_bit);
  }
}

// The value outside the patient's image. MR scanners write 0 here although 0 is also the value of air: as padding, it
// would hide the skin.
std::optional<std::pair<double, double>> padding_of(DcmItem& item, const FileHeader& header) {
  if (header.format.is_float) {
    const bool wide = header.format.bits_allocated == 64;
    const auto value = number_of(item, wide ? DCM_DoubleFloatPixelPaddingValue : DCM_FloatPixelPaddingValue);
    if (!value) return std::nullopt;
    return std::minmax(*value,
                       number_of(item, wide ? DCM_DoubleFloatPixelPaddingRangeLimit : DCM_FloatPixelPaddingRangeLimit)
                           .value_or(*value));
  }
  const auto signed_value = [&](double v) { return header.format.is_signed && v > 32767 ? v - 65536 : v; };
  const auto value = number_of(item, DCM_PixelPaddingValue);
  if (!value || (header.modality != "CT" && *value == 0)) return std::nullopt;
  const double limit = number_of(item, DCM_PixelPaddingRangeLimit).value_or(*value);
  return std::minmax(signed_value(*value), signed_value(limit));
}

void remark_on_lost_frames(double frames, FileHeader& header) {
  const auto placed = std::count_if(header.planes.begin(), header.planes.end(),
                                    [](const Plane& plane) { return plane.placement.has_value(); });
  if (placed == 0 || static_cast<double>(placed) >= frames) return;
  header.remarks.push_back(
      say("some-frames-have-no-place", header.path.filename().string(), placed, std::llround(frames)));
}

// How many frames a file's bytes can hold: a claim of more would cost time and memory for nothing.
double most_frames(const InputFile& file, const PixelElement& pixels, const FileHeader& header) {
  constexpr double least_compressed = 32, most_inflated = 1032;  // bytes a frame; bytes out of one
  const auto bytes = static_cast<double>(file.size());
  if (pixels.length == PixelElement::undefined_length) return bytes / least_compressed;
  const auto of_frame = static_cast<double>(std::max<std::size_t>(1, header.format.bytes_per_frame()));
  return (header.start.deflated ? most_inflated : 1) * bytes / of_frame;
}

std::vector<Plane> claimed_planes(DcmItem& item, const InputFile& file, const PixelElement& pixels, double frames,
                                  FileHeader& header) {
  constexpr double most_of_any = 1e6;
  const double most = std::clamp(most_frames(file, pixels, header), 1.0, most_of_any);
  if (frames > most) {
    constexpr double largest_is = 2147483647;  // PS3.5 6.2
    const double needed = std::min(frames, largest_is) * static_cast<double>(header.format.bytes_per_frame());
    header.defect = say("truncated-pixels", std::min<std::uint64_t>(file.size(), pixels.length),
                        static_cast<std::uint64_t>(needed));
  }
  return stacked_planes(item, header, static_cast<std::size_t>(std::clamp(frames, 1.0, most)));
}

// Planes that lie farther away than any patient lose their places.
bool drop_far_places(FileHeader& header) {
  bool any = false;
  for (Plane& plane : header.planes) {
    if (!plane.placement) continue;
    const Placement& place = *plane.placement;
    const double width = header.columns * place.spacing_i, height = header.rows * place.spacing_j;
    const bool is_near = glm::length(place.position) + width + height <= farthest_place_mm &&
                         std::min(place.spacing_i, place.spacing_j) >= least_spacing_mm;
    if (is_near) continue;
    plane.placement.reset();
    any = true;
  }
  return any;
}

void read_planes(DcmItem& item, const InputFile& file, const PixelElement& pixels, FileHeader& header) {
  const double frames = number_of(item, DCM_NumberOfFrames).value_or(1);
  header.padding = padding_of(item, header);
  const bool is_enhanced = first_item(item, DCM_PerFrameFunctionalGroupsSequence) != nullptr;
  if (is_enhanced) {
    header.planes = functional_group_planes(item, header, static_cast<std::size_t>(std::clamp(frames, 1.0, 1e6)));
  } else if (header.image_type.find("MOSAIC") != std::string::npos) {
    header.planes = mosaic_planes(item, header);
    if (header.planes.empty() && header.unfit.empty()) {
      header.unfit = say("siemens-mosaic-without-the-private-header");
    }
  } else if (header.image_type.find("VFRAME") != std::string::npos) {
    header.planes = grid_planes(item, header);
    if (header.planes.empty() && header.unfit.empty()) header.unfit = say("grid-without-the-places-of-its-slices");
  } else if (frames > 1 || header.modality == "RTDOSE") {
    header.planes = claimed_planes(item, file, pixels, frames, header);
  } else {
    header.planes.push_back(classic_plane(item, header));
  }
  const bool any_far = drop_far_places(header);
  if (is_enhanced) remark_on_lost_frames(frames, header);
  read_modality_table(item, header);
  if (header.modality == "RTDOSE") header.remarks.push_back(say("dose-its-values-are-no-density"));
  const bool placed =
      std::any_of(header.planes.begin(), header.planes.end(), [](const Plane& p) { return p.placement; });
  if (header.modality == "CT" && header.unit.empty()) {
    header.remarks.push_back(say("values-may-not-be-hounsfield-units"));
  }
  if (!placed && header.unfit.empty()) {
    header.unfit = any_far ? say("position-beyond-any-patient") : say("no-position-in-the-patient");
  }
}

void check_native_length(const InputFile& file, std::size_t frames, const PixelElement& pixels, FileHeader& header) {
  const std::uint64_t present =
      std::min<std::uint64_t>(pixels.length, file.size() - std::min(file.size(), header.pixels_at));
  const std::uint64_t needed = header.format.bytes_per_frame() * frames;
  if (present < needed) {
    header.defect = say("truncated-pixels", present, needed);
  }
}

void locate_pixels(const InputFile& file, const PixelElement& pixels, FileHeader& header) {
  std::size_t frames = 1;
  for (const Plane& plane : header.planes) frames = std::max<std::size_t>(frames, plane.frame + 1);
  const DcmXfer syntax(header.transfer_syntax.c_str());
  header.big_endian = syntax.getPixelDataByteOrder() == EBO_BigEndian;
  header.swapped_words = header.big_endian && header.format.bits_allocated == 8 && pixels.vr == "OW";
  header.pixels_at = header.start.deflated ? pixels.value_at : header.start.at + pixels.value_at;
  const bool encapsulated = pixels.length == PixelElement::undefined_length;
  if (encapsulated && !can_decode(header.transfer_syntax)) {
    if (header.unfit.empty()) header.unfit = why_not_decoded(header.transfer_syntax);
    return;
  }
  if (encapsulated && header.format.is_wide() && !is_packed(header.transfer_syntax)) {
    if (header.unfit.empty()) header.unfit = say("compressed-pixels-of-bits", header.format.bits_allocated);
    return;
  }
  if (!header.defect.empty()) return;
  try {
    if (encapsulated) {
      header.coding = PixelCoding::encapsulated;
      Encapsulated found = find_fragments(file, header.pixels_at, frames);
      header.fragments = std::move(found.frames);
      if (!found.has_end) header.remarks.push_back(say("compressed-pixels-have-no-end-mark"));
      check_density(header.transfer_syntax, header.format, frames, file.size());
    } else if (header.start.deflated) {
      header.coding = PixelCoding::deflated;
      check_density(header.transfer_syntax, header.format, frames, file.size());
      check_inflation(header.format.bytes_per_frame() * frames, file.size());
    } else if (can_decode(header.transfer_syntax)) {
      header.defect = say("pixels-are-not-compressed");
    } else {
      check_native_length(file, frames, pixels, header);
      const PixelFormat& format = header.format;
      header.swapped_wholes = header.big_endian && format.bits_allocated == 32 && !format.is_float &&
                              header.unfit.empty() && header.defect.empty() && swapped_as_wholes(file, header, frames);
    }
  } catch (const DicomError& error) {
    header.defect = error.text();
  }
}

}  // namespace

std::optional<Placement> make_placement(const std::vector<double>& position, const std::vector<double>& orientation,
                                        const std::vector<double>& spacing) {
  if (position.size() < 3 || orientation.size() < 6 || spacing.size() < 2) return std::nullopt;
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

bool FileHeader::padding_is_wide() const {
  if (!padding || format.bits_allocated != 16) return false;
  const double least = format.is_signed ? -std::ldexp(1.0, format.bits_stored - 1) : 0;
  const double most = std::ldexp(1.0, format.is_signed ? format.bits_stored - 1 : format.bits_stored) - 1;
  return padding->second < least || padding->first > most;
}

FileHeader read_file_header(const std::filesystem::path& stored_at) {
  const InputFile file(stored_at);
  FileHeader header;
  header.path = header.stored_at = stored_at;
  header.start = find_dataset(file);
  header.transfer_syntax = header.start.transfer_syntax;
  DcmDataset dataset;
  const auto pixels = parse_header(file, stored_at, header.start, dataset);
  if (dataset.tagExists(DCM_DirectoryRecordSequence)) {
    throw DicomError(say("dicomdir-an-index"));
  }
  read_identity(dataset, header);
  read_details(dataset, header);
  read_format(dataset, pixels, header);
  if (!pixels) throw NotAnImage(say("no-pixels", what_it_is(header)), header.sop_class);
  read_planes(dataset, file, *pixels, header);
  locate_pixels(file, *pixels, header);
  return header;
}

std::string name_of(const FileHeader& file) {
  return file.path.filename().string();
}

}  // namespace palpate::io::internal
