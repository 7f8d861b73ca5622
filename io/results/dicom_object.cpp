#include "io/results/dicom_object.h"

#include <dcmtk/dcmdata/dcostrmb.h>
#include <fmt/format.h>

#include <array>
#include <glm/geometric.hpp>
#include <limits>

#include "io/dicom/series_source.h"
#include "io/errors.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

/// The frame's images; null if it has none of its own.
const SeriesSource::Frame* frame_of(const SeriesSource& source, int frame, const SeriesSource*& owner) {
  const auto n = static_cast<std::size_t>(frame);
  owner = &source;
  if (n < source.frames.size()) return &source.frames[n];
  if (n >= source.velocities.size()) return nullptr;
  const SeriesSource::Component& component = source.velocities[n].front();
  owner = component.source.get();
  return &owner->frames[component.frame];
}

bool has_several_frames(const internal::FileHeader& file) {
  return std::ranges::any_of(file.planes, [](const internal::Plane& plane) { return plane.frame > 0; });
}

/// PS3.3 C.12.4: what an object was made of, which is an image or not.
void put_origin(const StructureLabel::Origin& origin, DcmDataset& data) {
  const bool is_contours = origin.sop_class == UID_RTStructureSetStorage;
  const DcmTagKey sequence = is_contours ? DCM_SourceInstanceSequence : DCM_SourceImageSequence;
  DcmItem* item = nullptr;
  succeed(data.findOrCreateSequenceItem(sequence, item, 0));
  succeed(item->putAndInsertString(DCM_ReferencedSOPClassUID, origin.sop_class.c_str()));
  succeed(item->putAndInsertString(DCM_ReferencedSOPInstanceUID, origin.instance.c_str()));
  if (is_contours) return;
  succeed(item->putAndInsertUint16(DCM_ReferencedSegmentNumber, static_cast<Uint16>(origin.number)));
  put_code(*item, DCM_PurposeOfReferenceCodeSequence, {"121322", "DCM", "Source image for image processing operation"});
}

}  // namespace

std::string new_uid() {
  std::array<char, 100> text{};
  return dcmGenerateUniqueIdentifier(text.data(), SITE_INSTANCE_UID_ROOT);
}

std::string decimal(double number) {
  constexpr std::size_t most = 16;
  if (number == 0) return "0";  // no -0
  std::string text;
  for (int digits = 15; digits > 0; --digits) {
    text = fmt::format("{:.{}g}", number, digits);
    if (text.size() <= most) break;
  }
  return text;
}

std::string long_string(const std::string& utf8) {
  constexpr int most = 64;
  std::string line;
  int characters = 0;
  for (const char c : utf8) {
    const auto byte = static_cast<unsigned char>(c);
    const bool begins = (byte & 0xC0U) != 0x80U;
    if (begins && ++characters > most) break;
    line += byte < 0x20 || byte == 0x7F ? ' ' : c == '\\' ? '/' : c;
  }
  return line;
}

std::string bytes_of(DcmFileFormat& format, E_TransferSyntax syntax) {
  std::vector<char> buffer(std::size_t{1} << 20);
  DcmOutputBufferStream stream(buffer.data(), static_cast<offile_off_t>(buffer.size()));
  std::string bytes;
  succeed(format.getDataset()->chooseRepresentation(syntax, nullptr));
  succeed(format.validateMetaInfo(syntax));
  format.transferInit();
  OFCondition condition = EC_Normal;
  do {
    condition = format.write(stream, syntax, EET_ExplicitLength, nullptr, EGL_recalcGL, EPD_withoutPadding);
    void* part = nullptr;
    offile_off_t count = 0;
    stream.flushBuffer(part, count);
    bytes.append(static_cast<const char*>(part), static_cast<std::size_t>(count));
  } while (condition == EC_StreamNotifyClient);
  format.transferEnd();
  succeed(condition);
  return bytes;
}

void succeed(const OFCondition& condition) {
  if (condition.bad()) throw DicomError(say("outline-cannot-be-made", condition.text()));
}

std::vector<SliceImage> images_of_slices(const Series& scan, const Geometry& geometry, int frame) {
  const SeriesSource* owner = nullptr;
  const SeriesSource::Frame* images = scan.source ? frame_of(*scan.source, frame, owner) : nullptr;
  if (images == nullptr) throw DicomError(say("outline-has-no-study", written_endings_in_words()));
  constexpr double same_place_mm = 0.01;
  std::vector<SliceImage> found;
  for (const Vec3& position : geometry.slice_positions) {
    SliceImage& image = found.emplace_back();
    double nearest = same_place_mm;
    for (const SeriesSource::Slice& slice : images->slices) {
      const internal::Plane& plane = owner->plane_of(slice);
      const double apart =
          plane.placement ? glm::length(plane.placement->position - position) : std::numeric_limits<double>::infinity();
      if (apart > nearest) continue;
      nearest = apart;
      const internal::FileHeader& file = owner->file_of(slice);
      image = {{file.sop_class, file.sop_instance}, has_several_frames(file) ? plane.frame + 1 : 0};
    }
  }
  return found;
}

void put_code(DcmItem& item, const DcmTagKey& sequence, const Code& code) {
  DcmItem* inner = nullptr;
  succeed(item.findOrCreateSequenceItem(sequence, inner, 0));
  put_code(*inner, code);
}

void put_code(DcmItem& item, const Code& code) {
  // PS3.3 8.1: a value has one of three places.
  constexpr std::size_t longest_short_string = 16;
  const bool is_urn = code.value.starts_with("urn:") || code.value.find("://") != std::string::npos;
  const DcmTagKey place = is_urn                                     ? DCM_URNCodeValue
                          : code.value.size() > longest_short_string ? DCM_LongCodeValue
                                                                     : DCM_CodeValue;
  for (const DcmTagKey& other : {DCM_CodeValue, DCM_LongCodeValue, DCM_URNCodeValue}) item.findAndDeleteElement(other);
  succeed(item.putAndInsertString(place, code.value.c_str()));
  succeed(item.putAndInsertString(DCM_CodingSchemeDesignator, code.scheme.c_str()));
  succeed(item.putAndInsertString(DCM_CodeMeaning, code.meaning.c_str()));
}

void put_common(const StudyHeader& header, const StructureLabel& label, const Series& scan, const WriteOptions& options,
                DcmDataset& data) {
  const auto put = [&](const DcmTagKey& key, const std::string& value) {
    succeed(data.putAndInsertString(key, value.c_str()));
  };
  OFString date, time;
  DcmDate::getCurrentDate(date);
  DcmTime::getCurrentTime(time);
  put_study(header, data);
  put(DCM_SOPInstanceUID, new_uid());
  put(DCM_SeriesInstanceUID, new_uid());
  put(DCM_InstanceCreationDate, date.c_str());
  put(DCM_InstanceCreationTime, time.c_str());
  put(DCM_SeriesDate, date.c_str());
  put(DCM_SeriesTime, time.c_str());
  constexpr int beyond_scans = 1000;
  put(DCM_SeriesNumber, std::to_string(beyond_scans + scan.details.number.value_or(0)));
  put(DCM_SeriesDescription, long_string("Palpate: " + label.name));
  put(DCM_Manufacturer, "Palpate");
  put(DCM_ManufacturerModelName, "Palpate");
  put(DCM_DeviceSerialNumber, "0");  // type 1, and software has none
  put(DCM_SoftwareVersions, long_string(options.software_version));
  if (label.origin && !label.origin->instance.empty()) put_origin(*label.origin, data);
}

}  // namespace palpate::io
