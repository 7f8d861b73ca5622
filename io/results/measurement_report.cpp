#include "io/results/measurement_report.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmsr/codes/dcm.h>
#include <dcmtk/dcmsr/codes/sct.h>
#include <dcmtk/dcmsr/codes/ucum.h>
#include <dcmtk/dcmsr/dsrdoc.h>
#include <fmt/format.h>

#include "io/errors.h"
#include "io/messages.h"
#include "io/results/dicom_object.h"
#include "io/results/study_header.h"

namespace palpate::io {
namespace {

constexpr const char* comment = "Measured by research software, which is not a medical device.";

/// A code that no standard has.
DSRCodedEntryValue own_code(const char* value, const char* meaning) {
  return {value, "99PALPATE", meaning};
}

/// The content tree, by TID 1500. What DCMTK refuses is a fault of ours, and is found by check().
class Tree {
 public:
  Tree(DSRDocumentTree& tree, const StudyHeader& header) : tree_(tree), header_(header) {}

  void fill(const MeasurementReport& report, const std::string& unit) {
    tree_.addContentItem(DSRTypes::RT_isRoot, DSRTypes::VT_Container);
    check(item().setConceptName(CODE_DCM_ImagingMeasurementReport));
    check(item().setTemplateIdentification("1500", "DCMR"));
    const DSRCodedEntryValue english("en", "RFC5646", "English");
    add_code(DSRTypes::RT_hasConceptMod, CODE_DCM_LanguageOfContentItemAndDescendants, english);
    add_observer(report.software_version);
    add_code(DSRTypes::RT_hasConceptMod, CODE_DCM_ProcedureReported, CODE_SCT_ImagingProcedure);
    add_images();
    begin(DSRTypes::RT_contains, DSRTypes::VT_Container, CODE_DCM_ImagingMeasurements);
    for (const MarkedPoint& point : report.points) add_point(point, unit);
    for (const MeasuredLength& length : report.lengths) add_length(length);
    for (const MeasuredAngle& angle : report.angles) add_angle(angle);
    end();
    add_text(DSRTypes::RT_contains, CODE_DCM_Comment, comment);
  }

 private:
  static void check(const OFCondition& condition) {
    if (condition.bad()) throw DicomError(say("report-cannot-be-made", condition.text()));
  }
  DSRContentItem& item() { return tree_.getCurrentContentItem(); }

  /// A child of the current item, which becomes the current one until end().
  void begin(DSRTypes::E_RelationshipType relation, DSRTypes::E_ValueType type,
             const DSRCodedEntryValue& concept_name) {
    if (tree_.addContentItem(relation, type, DSRTypes::AM_belowCurrent) == 0) {
      throw DicomError(say("report-cannot-be-made", concept_name.getCodeMeaning().c_str()));
    }
    if (concept_name.isComplete()) check(item().setConceptName(concept_name));
  }
  void end() { tree_.goUp(); }

  void add_code(DSRTypes::E_RelationshipType relation, const DSRCodedEntryValue& name,
                const DSRCodedEntryValue& value) {
    begin(relation, DSRTypes::VT_Code, name);
    check(item().setCodeValue(value));
    end();
  }
  void add_text(DSRTypes::E_RelationshipType relation, const DSRCodedEntryValue& name, const std::string& value) {
    begin(relation, DSRTypes::VT_Text, name);
    check(item().setStringValue(value.c_str()));
    end();
  }
  void add_uid(DSRTypes::E_RelationshipType relation, const DSRCodedEntryValue& name, const std::string& value) {
    begin(relation, DSRTypes::VT_UIDRef, name);
    check(item().setStringValue(value.c_str()));
    end();
  }

  // TID 1004.
  void add_observer(const std::string& version) {
    add_code(DSRTypes::RT_hasObsContext, CODE_DCM_ObserverType, CODE_DCM_Device);
    add_uid(DSRTypes::RT_hasObsContext, CODE_DCM_DeviceObserverUID, new_uid());
    add_text(DSRTypes::RT_hasObsContext, CODE_DCM_DeviceObserverName, "Palpate " + version);
  }

  // TID 1600.
  void add_images() {
    begin(DSRTypes::RT_contains, DSRTypes::VT_Container, CODE_DCM_ImageLibrary);
    begin(DSRTypes::RT_contains, DSRTypes::VT_Container, CODE_DCM_ImageLibraryGroup);
    for (const ReferencedImage& image : header_.images) {
      begin(DSRTypes::RT_contains, DSRTypes::VT_Image, DSRCodedEntryValue());
      check(item().setImageReference(DSRImageReferenceValue(image.sop_class.c_str(), image.instance.c_str())));
      end();
    }
    end();
    end();
  }

  // TID 1501.
  void begin_group(const std::string& name) {
    begin(DSRTypes::RT_contains, DSRTypes::VT_Container, CODE_DCM_MeasurementGroup);
    check(item().setTemplateIdentification("1501", "DCMR"));
    add_text(DSRTypes::RT_hasObsContext, CODE_DCM_TrackingIdentifier, name);
    add_uid(DSRTypes::RT_hasObsContext, CODE_DCM_TrackingUniqueIdentifier, new_uid());
  }

  void begin_number(const DSRCodedEntryValue& name, double value, const DSRCodedEntryValue& unit) {
    begin(DSRTypes::RT_contains, DSRTypes::VT_Num, name);
    check(item().setNumericValue(DSRNumericMeasurementValue(fmt::format("{:.6g}", value).c_str(), unit)));
  }

  void add_coordinates(DSRTypes::E_RelationshipType relation, const DSRCodedEntryValue& name,
                       const std::vector<glm::dvec3>& points) {
    DSRSpatialCoordinates3DValue value(points.size() == 1 ? DSRTypes::GT3_Point : DSRTypes::GT3_Polyline);
    for (const glm::dvec3& point : points) {
      value.getGraphicDataList().addItem(static_cast<Float32>(point.x), static_cast<Float32>(point.y),
                                         static_cast<Float32>(point.z));
    }
    check(value.setFrameOfReferenceUID(header_.frame_of_reference_uid.c_str()));
    begin(relation, DSRTypes::VT_SCoord3D, name);
    check(item().setSpatialCoordinates3D(value));
    end();
  }

  void add_point(const MarkedPoint& point, const std::string& unit) {
    begin_group(point.name);
    add_text(DSRTypes::RT_contains, CODE_DCM_Comment,
             point.structure.empty() ? "No boundary felt" : "Felt boundary: " + point.structure);
    add_coordinates(DSRTypes::RT_contains, CODE_DCM_ImageRegion, {point.position_mm});
    if (point.value) {
      // The other units of a series are UCUM's own names (PS3.16 CID 82).
      const bool is_hu = unit == "HU";
      const DSRCodedEntryValue other = unit.empty() || unit.size() > 16
                                           ? DSRCodedEntryValue("1", "UCUM", "no units")
                                           : DSRCodedEntryValue(unit.c_str(), "UCUM", unit.c_str());
      begin_number(is_hu ? CODE_DCM_AttenuationCoefficient : own_code("VALUE", "Value of the image"), *point.value,
                   is_hu ? DSRCodedEntryValue("[hnsf'U]", "UCUM", "Hounsfield unit") : other);
      end();
    }
    if (point.force_n) {
      begin_number(own_code("FORCE", "Force of the stylus"), *point.force_n, DSRCodedEntryValue("N", "UCUM", "newton"));
      end();
    }
    end();
  }

  void add_length(const MeasuredLength& length) {
    const bool straight = length.points_mm.size() == 2;
    begin_group(length.name);
    begin_number(straight ? DSRCodedEntryValue(CODE_DCM_Distance) : own_code("PATH", "Length of the felt path"),
                 length.length_mm, CODE_UCUM_Millimeter);
    add_coordinates(DSRTypes::RT_inferredFrom, CODE_DCM_Path, length.points_mm);
    end();
    end();
  }

  void add_angle(const MeasuredAngle& angle) {
    begin_group(angle.name);
    begin_number(CODE_DCM_Angle, angle.degrees, DSRCodedEntryValue("deg", "UCUM", "degree"));
    add_coordinates(DSRTypes::RT_inferredFrom, CODE_DCM_Path, {angle.points_mm.begin(), angle.points_mm.end()});
    end();
    end();
  }

  DSRDocumentTree& tree_;
  const StudyHeader& header_;
};

void save(DcmFileFormat& format, const std::filesystem::path& file) {
  const OFCondition saved = format.saveFile(file.c_str(), EXS_LittleEndianExplicit);
  if (saved.bad()) throw DicomError(say("report-cannot-be-written", file.string()));
}

void put(DcmItem& item, const DcmTagKey& key, const std::string& value) {
  item.putAndInsertString(key, value.c_str());
}

void put_equipment(DcmItem& item, const std::string& version) {
  put(item, DCM_Manufacturer, "Palpate");
  put(item, DCM_ManufacturerModelName, "Palpate");
  put(item, DCM_DeviceSerialNumber, "0");  // type 1, and software has none
  put(item, DCM_SoftwareVersions, version);
}

}  // namespace

void write_measurement_report(const Series& series, const MeasurementReport& report,
                              const std::filesystem::path& file) {
  const StudyHeader header = read_study_header(series);
  DSRDocument document(DSRTypes::DT_Comprehensive3DSR);
  document.createNewSeriesInStudy(header.study_uid.c_str());
  document.setSpecificCharacterSetType(DSRTypes::CS_UTF8);
  document.setSeriesDescription("Palpate: marks and measurements");
  document.setManufacturer("Palpate");
  document.setManufacturerModelName("Palpate");
  document.setDeviceSerialNumber("0");
  document.setSoftwareVersions(report.software_version.c_str());
  Tree(document.getTree(), header).fill(report, series.unit);
  for (const ReferencedImage& image : header.images) {
    document.getCurrentRequestedProcedureEvidence().addItem(header.study_uid.c_str(), image.series_uid.c_str(),
                                                            image.sop_class.c_str(), image.instance.c_str());
  }
  DcmFileFormat format;
  const OFCondition written = document.write(*format.getDataset());
  if (written.bad()) throw DicomError(say("report-cannot-be-made", written.text()));
  put_study(header, *format.getDataset());
  save(format, file);
}

void write_pictures(const Series& series, const std::string& software_version, std::span<const Picture> pictures,
                    const std::filesystem::path& folder) {
  const StudyHeader header = read_study_header(series);
  const std::string series_uid = new_uid();
  OFString date, time;
  DcmDate::getCurrentDate(date);
  DcmTime::getCurrentTime(time);
  int number = 0;
  for (const Picture& picture : pictures) {
    ++number;
    DcmFileFormat format;
    DcmDataset& data = *format.getDataset();
    put_study(header, data);
    put_equipment(data, software_version);
    put(data, DCM_SOPClassUID, UID_SecondaryCaptureImageStorage);
    put(data, DCM_SOPInstanceUID, new_uid());
    put(data, DCM_Modality, "OT");
    put(data, DCM_SeriesInstanceUID, series_uid);
    put(data, DCM_SeriesNumber, "");
    put(data, DCM_SeriesDescription, "Palpate: pictures");
    put(data, DCM_ConversionType, "WSD");
    put(data, DCM_InstanceNumber, fmt::format("{}", number));
    put(data, DCM_PatientOrientation, "");
    put(data, DCM_Laterality, "");
    put(data, DCM_ImageType, "DERIVED\\SECONDARY");
    put(data, DCM_ContentDate, date.c_str());
    put(data, DCM_ContentTime, time.c_str());
    put(data, DCM_BurnedInAnnotation, "NO");
    put(data, DCM_DerivationDescription, picture.description);
    put(data, DCM_ImageComments, comment);
    put(data, DCM_PhotometricInterpretation, "RGB");
    data.putAndInsertUint16(DCM_SamplesPerPixel, 3);
    data.putAndInsertUint16(DCM_PlanarConfiguration, 0);
    data.putAndInsertUint16(DCM_Rows, static_cast<Uint16>(picture.rows));
    data.putAndInsertUint16(DCM_Columns, static_cast<Uint16>(picture.columns));
    data.putAndInsertUint16(DCM_BitsAllocated, 8);
    data.putAndInsertUint16(DCM_BitsStored, 8);
    data.putAndInsertUint16(DCM_HighBit, 7);
    data.putAndInsertUint16(DCM_PixelRepresentation, 0);
    data.putAndInsertUint8Array(DCM_PixelData, picture.pixels.data(), picture.pixels.size());
    save(format, folder / fmt::format("picture-{:03}.dcm", number));
  }
}

}  // namespace palpate::io
