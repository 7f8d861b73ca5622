#include "testdata/write_series.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "io/fresh_folder.h"

namespace palpate::testdata {
namespace {

namespace fs = std::filesystem;
using io::Vec3;

/// A DS value: the closest decimal in at most 16 characters, whatever the locale.
std::string decimal(double value) {
  constexpr int longest = 16;
  char text[32];
  for (int digits = std::numeric_limits<double>::max_digits10; digits > 0; --digits) {
    const auto end = std::to_chars(std::begin(text), std::end(text), value, std::chars_format::general, digits).ptr;
    if (end - text <= longest) {
      return {text, end};
    }
  }
  throw std::invalid_argument("a number does not fit in a DICOM decimal string");
}

std::string decimals(std::initializer_list<double> values) {
  std::string text;
  for (const double v : values) {
    if (!text.empty()) {
      text += '\\';
    }
    text += decimal(v);
  }
  return text;
}

/// FNV-1a, 64 bit: enough to tell phantoms apart.
class Digest {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t n = 0; n < bytes; ++n) {
      state_ = (state_ ^ byte[n]) * 0x100000001b3U;
    }
  }
  void add(const std::string& text) { add(text.data(), text.size()); }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325U;
};

std::uint64_t digest_of(const io::Volume& volume, const SeriesLabel& label) {
  Digest digest;
  std::visit([&](const auto& voxels) { digest.add(voxels.data(), voxels.size() * sizeof(voxels[0])); }, volume.voxels);
  for (const Vec3& position : volume.geometry.slice_positions) {
    digest.add(decimals({position.x, position.y, position.z}));
  }
  const Vec3& i = volume.geometry.direction_i;
  const Vec3& j = volume.geometry.direction_j;
  digest.add(decimals({i.x, i.y, i.z, j.x, j.y, j.z, volume.geometry.spacing_i, volume.geometry.spacing_j, volume.slope,
                       volume.intercept}));
  digest.add(label.description + label.subject + std::to_string(label.number));
  if (label.trigger_time_ms) {
    digest.add(decimal(*label.trigger_time_ms));
  }
  return digest.value();
}

/// What tells studies and series apart: the content of each, or what the label says they share.
struct Identity {
  std::uint64_t content = 0;
  std::uint64_t study = 0;
  std::uint64_t series = 0;
};

Identity identity_of(const io::Volume& volume, const SeriesLabel& label) {
  const std::uint64_t content = digest_of(volume, label);
  if (label.study.empty()) {
    return {content, content, content};
  }
  Digest study;
  study.add(label.study);
  Digest series = study;
  series.add(std::to_string(label.number));
  return {content, study.value(), series.value()};
}

/// A UID under 2.25, made of the content's digest and what it names: the same content, the same UID.
std::string uid(std::uint64_t content, const std::string& what) {
  Digest digest;
  digest.add(&content, sizeof content);
  digest.add(what);
  return "2.25." + std::to_string(digest.value());
}

void put(DcmItem& item, const DcmTagKey& tag, const std::string& value) {
  if (item.putAndInsertString(tag, value.c_str()).bad()) {
    throw std::runtime_error("DICOM attribute " + std::string(tag.toString().c_str()) + " cannot be set to " + value);
  }
}

void put(DcmItem& item, const DcmTagKey& tag, Uint16 value) {
  if (item.putAndInsertUint16(tag, value).bad()) {
    throw std::runtime_error("DICOM attribute " + std::string(tag.toString().c_str()) + " cannot be set");
  }
}

double normal_distance(const io::Geometry& g) {
  return std::abs(glm::dot(g.step, glm::normalize(glm::cross(g.direction_i, g.direction_j))));
}

void put_patient_and_study(DcmItem& item, const SeriesLabel& label, const Identity& identity) {
  put(item, DCM_PatientName, label.subject);
  put(item, DCM_PatientID, label.subject);
  put(item, DCM_PatientBirthDate, "");
  put(item, DCM_PatientSex, "");
  put(item, DCM_PatientIdentityRemoved, "YES");
  put(item, DCM_DeidentificationMethod, "made or rewritten by palpate-testdata");
  put(item, DCM_StudyInstanceUID, uid(identity.study, "study"));
  put(item, DCM_StudyDate, "");
  put(item, DCM_StudyTime, "");
  put(item, DCM_ReferringPhysicianName, "");
  put(item, DCM_StudyID, "1");
  put(item, DCM_AccessionNumber, "");
}

void put_series_and_equipment(DcmItem& item, const SeriesLabel& label, const Identity& identity) {
  put(item, DCM_Modality, label.modality);
  put(item, DCM_SeriesInstanceUID, uid(identity.series, "series"));
  put(item, DCM_SeriesNumber, std::to_string(label.number));
  put(item, DCM_SeriesDescription, label.description);
  put(item, DCM_Laterality, "");
  put(item, DCM_PatientPosition, "HFS");
  put(item, DCM_FrameOfReferenceUID, uid(identity.study, "frame of reference"));
  put(item, DCM_PositionReferenceIndicator, "");
  put(item, DCM_Manufacturer, "Palpate");
  if (label.modality == "CT") {
    put(item, DCM_KVP, "");
  }
}

void put_numbers(DcmItem& item, const DcmTagKey& tag, const double* values, unsigned long count) {
  if (item.putAndInsertFloat64Array(tag, values, count).bad()) {
    throw std::runtime_error("DICOM attribute " + std::string(tag.toString().c_str()) + " cannot be set");
  }
}

/// The attributes of the standard's MR Velocity Encoding, which single-frame images may carry too.
void put_phase_contrast(DcmItem& item, const PhaseContrast& encoding) {
  const double direction[] = {encoding.direction.x, encoding.direction.y, encoding.direction.z};
  const double least = -encoding.venc_cm_per_s;
  put(item, DCM_ComplexImageComponent, "PHASE");
  put_numbers(item, DCM_VelocityEncodingDirection, direction, 3);
  put_numbers(item, DCM_VelocityEncodingMinimumValue, &least, 1);
  put_numbers(item, DCM_VelocityEncodingMaximumValue, &encoding.venc_cm_per_s, 1);
}

void put_image(DcmItem& item, const io::Volume& volume, const SeriesLabel& label, int slice, bool is_signed) {
  const io::Geometry& g = volume.geometry;
  const Vec3& origin = g.slice_positions[static_cast<std::size_t>(slice)];
  const Vec3& i = g.direction_i;
  const Vec3& j = g.direction_j;
  const char* const kind = label.modality == "CT" ? "AXIAL" : label.phase_contrast ? "P" : "M";
  put(item, DCM_ImageType, std::string("DERIVED\\SECONDARY\\") + kind);
  put(item, DCM_InstanceNumber, std::to_string(slice + 1));
  put(item, DCM_AcquisitionNumber, "");
  if (!label.comments.empty()) {
    put(item, DCM_ImageComments, label.comments);
  }
  put(item, DCM_ImagePositionPatient, decimals({origin.x, origin.y, origin.z}));
  put(item, DCM_ImageOrientationPatient, decimals({i.x, i.y, i.z, j.x, j.y, j.z}));
  put(item, DCM_PixelSpacing, decimals({g.spacing_j, g.spacing_i}));  // between rows first
  put(item, DCM_SliceThickness, decimal(normal_distance(g)));
  put(item, DCM_SamplesPerPixel, Uint16{1});
  put(item, DCM_PhotometricInterpretation, "MONOCHROME2");
  put(item, DCM_Rows, static_cast<Uint16>(g.dimensions.y));
  put(item, DCM_Columns, static_cast<Uint16>(g.dimensions.x));
  put(item, DCM_BitsAllocated, Uint16{16});
  put(item, DCM_BitsStored, static_cast<Uint16>(label.bits_stored));
  put(item, DCM_HighBit, static_cast<Uint16>(label.bits_stored - 1));
  put(item, DCM_PixelRepresentation, static_cast<Uint16>(is_signed ? 1 : 0));
  put(item, DCM_RescaleIntercept, decimal(volume.intercept));
  put(item, DCM_RescaleSlope, decimal(volume.slope));
  put(item, DCM_RescaleType, label.modality == "CT" ? "HU" : "US");
  if (label.window) {
    put(item, DCM_WindowCenter, decimal(label.window->level));
    put(item, DCM_WindowWidth, decimal(label.window->width));
  }
  if (label.trigger_time_ms) {
    put(item, DCM_TriggerTime, decimal(*label.trigger_time_ms));
  }
  if (label.phase_contrast) {
    put_phase_contrast(item, *label.phase_contrast);
  }
}

void put_padding(DcmItem& item, const io::Volume& volume, bool is_signed) {
  const auto put_stored = [&](const DcmTagKey& tag, double stored) {
    const auto bits = static_cast<Uint16>(static_cast<std::int32_t>(stored));
    const OFCondition set = is_signed ? item.putAndInsertSint16(DcmTag(tag, EVR_SS), static_cast<Sint16>(stored))
                                      : item.putAndInsertUint16(DcmTag(tag, EVR_US), bits);
    if (set.bad()) {
      throw std::runtime_error("the pixel padding value cannot be set");
    }
  };
  if (volume.padding) {
    put_stored(DCM_PixelPaddingValue, volume.padding->first);
    if (volume.padding->second != volume.padding->first) {
      put_stored(DCM_PixelPaddingRangeLimit, volume.padding->second);
    }
  }
}

template <typename Stored>
void write_slices(const io::Volume& volume, const std::vector<Stored>& voxels, const fs::path& folder,
                  const SeriesLabel& label) {
  constexpr bool is_signed = std::is_signed_v<Stored>;
  const Identity identity = identity_of(volume, label);
  const std::size_t slice_voxels = volume.offset(0, 0, 1);
  std::vector<Uint16> pixels(slice_voxels);
  for (int k = 0; k < volume.geometry.dimensions.z; ++k) {
    DcmFileFormat file;
    DcmDataset& item = *file.getDataset();
    put(item, DCM_SOPClassUID, label.modality == "CT" ? UID_CTImageStorage : UID_MRImageStorage);
    put(item, DCM_SOPInstanceUID, uid(identity.content, "slice " + std::to_string(k)));
    put_patient_and_study(item, label, identity);
    put_series_and_equipment(item, label, identity);
    put_image(item, volume, label, k, is_signed);
    put_padding(item, volume, is_signed);
    std::memcpy(pixels.data(), voxels.data() + volume.offset(0, 0, k), slice_voxels * sizeof(Uint16));
    char name[32];
    std::snprintf(name, sizeof name, "slice_%04d.dcm", k + 1);
    const fs::path path = folder / name;
    OFCondition done =
        item.putAndInsertUint16Array(DCM_PixelData, pixels.data(), static_cast<unsigned long>(slice_voxels));
    if (done.good()) {
      done = file.saveFile(path.c_str(), EXS_LittleEndianExplicit);
    }
    if (done.bad()) {
      throw std::runtime_error(path.string() + ": cannot be written (" + done.text() + ")");
    }
  }
}

}  // namespace

void write_series(const io::Volume& volume, const fs::path& folder, const SeriesLabel& label) {
  const glm::ivec3 size = volume.geometry.dimensions;
  constexpr int largest = std::numeric_limits<Uint16>::max();
  if (size.x < 1 || size.y < 1 || size.z < 1 || size.x > largest || size.y > largest) {
    throw std::invalid_argument("a series has 1 to 65535 rows and columns and at least one slice");
  }
  if (!dcmDataDict.isDictionaryLoaded()) {
    throw std::runtime_error("DCMTK's data dictionary is not loaded; set DCMDICTPATH to dicom.dic");
  }
  io::FreshFolder fresh(folder);
  std::visit(
      [&](const auto& voxels) {
        if constexpr (std::is_floating_point_v<typename std::decay_t<decltype(voxels)>::value_type>) {
          throw std::invalid_argument("float voxels cannot be written: make the phantom quantised");
        } else {
          write_slices(volume, voxels, fresh.path(), label);
        }
      },
      volume.voxels);
  fresh.commit();
}

}  // namespace palpate::testdata
