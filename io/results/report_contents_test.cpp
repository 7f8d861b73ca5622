// Every value in reports and pictures, against the standard's codes and the input; read with DCMTK alone.

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/fresh_folder.h"
#include "io/results/measurement_report.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;

struct Told {
  DcmTagKey key;
  std::string first, second;  // in the first image and in the second
};

/// What the images say of patient and study (DICOM PS3.3 C.7.1.1, C.7.2.1): another value in each.
const std::vector<Told>& told() {
  static const std::vector<Told> all{{DCM_PatientName, "Doe^Jane", "Roe^Richard"},
                                     {DCM_PatientID, "4711", "4712"},
                                     {DCM_IssuerOfPatientID, "Here", "There"},
                                     {DCM_PatientBirthDate, "19610203", "19620304"},
                                     {DCM_PatientSex, "F", "M"},
                                     {DCM_StudyInstanceUID, "1.2.3.2", "1.2.3.22"},
                                     {DCM_StudyDate, "20240229", "20240301"},
                                     {DCM_StudyTime, "101112", "131415"},
                                     {DCM_StudyID, "S1", "S2"},
                                     {DCM_AccessionNumber, "A1", "A2"},
                                     {DCM_StudyDescription, "Head", "Foot"},
                                     {DCM_ReferringPhysicianName, "Smith^A", "Smith^B"}};
  return all;
}

Series told_series(const fs::path& folder, bool empty = false) {
  Series series;
  series.uid = "1.2.3.3";
  series.unit = "HU";
  for (const bool second : {false, true}) {
    DcmFileFormat file;
    DcmDataset& data = *file.getDataset();
    data.putAndInsertString(DCM_SOPClassUID, second ? UID_MRImageStorage : UID_CTImageStorage);
    data.putAndInsertString(DCM_SOPInstanceUID, second ? "1.2.3.6" : "1.2.3.5");
    for (const Told& one : told()) {
      if (empty && one.key != DCM_StudyInstanceUID) continue;
      data.putAndInsertString(one.key, (second ? one.second : one.first).c_str());
    }
    data.putAndInsertString(DCM_SeriesInstanceUID, second ? "1.2.3.33" : "1.2.3.3");
    data.putAndInsertString(DCM_FrameOfReferenceUID, second ? "1.2.3.44" : "1.2.3.4");
    series.files.push_back(folder / (second ? "second" : "first"));
    EXPECT_TRUE(file.saveFile(series.files.back().c_str(), EXS_LittleEndianExplicit).good());
  }
  return series;
}

/// Of an item itself, not of one within it.
std::string said(DcmItem& item, const DcmTagKey& key) {
  OFString value;
  if (item.findAndGetOFStringArray(key, value).bad()) return "absent";
  return value.c_str();
}

bool is_uid(const std::string& text) {
  return !text.empty() && text.size() <= 64 && text.find_first_not_of("0123456789.") == std::string::npos;
}

std::string code_in(DcmItem& item, const DcmTagKey& sequence) {
  DcmItem* code = nullptr;
  if (item.findAndGetSequenceItem(sequence, code).bad()) return "none";
  return said(*code, DCM_CodeValue) + " " + said(*code, DCM_CodingSchemeDesignator) + " '" +
         said(*code, DCM_CodeMeaning) + "'";
}

std::string coordinates_in(DcmItem& item) {
  std::string text = said(item, DCM_GraphicType) + " in " + said(item, DCM_ReferencedFrameOfReferenceUID) + ":";
  const Float32* numbers = nullptr;
  unsigned long count = 0;
  item.findAndGetFloat32Array(DCM_GraphicData, numbers, &count);
  for (unsigned long n = 0; n < count; ++n) text += " " + std::to_string(static_cast<double>(numbers[n]));
  return text;
}

/// What a content item says, by the attributes of its value type (DICOM PS3.3 C.17.3); UIDs that are made are named so.
std::string value_in(DcmItem& item, std::set<std::string>& made) {
  const std::string type = said(item, DCM_ValueType);
  if (type == "CODE") return code_in(item, DCM_ConceptCodeSequence);
  if (type == "TEXT") return said(item, DCM_TextValue);
  if (type == "SCOORD3D") return coordinates_in(item);
  if (type == "CONTAINER") return said(item, DCM_ContinuityOfContent);
  DcmItem* part = nullptr;
  if (type == "UIDREF") {
    const std::string uid = said(item, DCM_UID);
    EXPECT_TRUE(is_uid(uid)) << uid;
    EXPECT_TRUE(made.insert(uid).second) << uid << " is there twice";
    return "made";
  }
  if (type == "NUM" && item.findAndGetSequenceItem(DCM_MeasuredValueSequence, part).good()) {
    return said(*part, DCM_NumericValue) + " " + code_in(*part, DCM_MeasurementUnitsCodeSequence);
  }
  if (type == "IMAGE" && item.findAndGetSequenceItem(DCM_ReferencedSOPSequence, part).good()) {
    return said(*part, DCM_ReferencedSOPClassUID) + " " + said(*part, DCM_ReferencedSOPInstanceUID);
  }
  return "?";
}

void contents(DcmItem& item, std::set<std::string>& made, std::vector<std::string>& lines) {
  lines.push_back(said(item, DCM_ValueType) + ", " + code_in(item, DCM_ConceptNameCodeSequence) + ": " +
                  value_in(item, made));
  DcmItem* part = nullptr;
  for (long n = 0; item.findAndGetSequenceItem(DCM_ContentSequence, part, n).good(); ++n) contents(*part, made, lines);
}

std::vector<std::string> contents_of(const Series& series, const MeasurementReport& report, const fs::path& file) {
  write_measurement_report(series, report, file);
  DcmFileFormat format;
  EXPECT_TRUE(format.loadFile(file.c_str()).good());
  std::vector<std::string> lines;
  std::set<std::string> made;
  contents(*format.getDataset(), made, lines);
  return lines;
}

/// Codes: DICOM PS3.16 annex D, SNOMED CT, UCUM. The numbers are those that were measured, in the units they have.
TEST(ReportContents, AreTheStandardsCodesAndWhatWasMeasured) {
  const FreshFolder scratch = temporary_folder();
  const MeasurementReport report{
      .software_version = "1.7",
      .points = {{"Mark 1", {1.25, -2.5, 300.125}, "sk\xC3\xB6n", -41.5, 0.75}, {"Mark 2", {4, 1, 2}, "", {}, {}}},
      .lengths = {{"Mark 1 to Mark 2", {{1.25, -2.5, 300.125}, {4, 1, 2}}, 1234.5678},
                  {"Way", {{1, 2, 3}, {4, 5, 6}, {7, 8, 9.5}}, 10.5}},
      .angles = {{"Angle at Mark 2", {{{1, 2, 3}, {4, 1, 2}, {7, 8, 9.5}}}, 101.25}}};
  const std::vector<std::string> expected{
      "CONTAINER, 126000 DCM 'Imaging Measurement Report': SEPARATE",
      "CODE, 121049 DCM 'Language of Content Item and Descendants': en RFC5646 'English'",
      "CODE, 121005 DCM 'Observer Type': 121007 DCM 'Device'",
      "UIDREF, 121012 DCM 'Device Observer UID': made",
      "TEXT, 121013 DCM 'Device Observer Name': Palpate 1.7",
      "CODE, 121058 DCM 'Procedure Reported': 363679005 SCT 'Imaging procedure'",
      "CONTAINER, 111028 DCM 'Image Library': SEPARATE",
      "CONTAINER, 126200 DCM 'Image Library Group': SEPARATE",
      "IMAGE, none: 1.2.840.10008.5.1.4.1.1.2 1.2.3.5",
      "IMAGE, none: 1.2.840.10008.5.1.4.1.1.4 1.2.3.6",
      "CONTAINER, 126010 DCM 'Imaging Measurements': SEPARATE",
      "CONTAINER, 125007 DCM 'Measurement Group': SEPARATE",
      "TEXT, 112039 DCM 'Tracking Identifier': Mark 1",
      "UIDREF, 112040 DCM 'Tracking Unique Identifier': made",
      "TEXT, 121106 DCM 'Comment': Felt boundary: sk\xC3\xB6n",
      "SCOORD3D, 111030 DCM 'Image Region': POINT in 1.2.3.4: 1.250000 -2.500000 300.125000",
      "NUM, 112031 DCM 'Attenuation Coefficient': -41.5 [hnsf'U] UCUM 'Hounsfield unit'",
      "NUM, FORCE 99PALPATE 'Force of the stylus': 0.75 N UCUM 'newton'",
      "CONTAINER, 125007 DCM 'Measurement Group': SEPARATE",
      "TEXT, 112039 DCM 'Tracking Identifier': Mark 2",
      "UIDREF, 112040 DCM 'Tracking Unique Identifier': made",
      "TEXT, 121106 DCM 'Comment': No boundary felt",
      "SCOORD3D, 111030 DCM 'Image Region': POINT in 1.2.3.4: 4.000000 1.000000 2.000000",
      "CONTAINER, 125007 DCM 'Measurement Group': SEPARATE",
      "TEXT, 112039 DCM 'Tracking Identifier': Mark 1 to Mark 2",
      "UIDREF, 112040 DCM 'Tracking Unique Identifier': made",
      "NUM, 121206 DCM 'Distance': 1234.57 mm UCUM 'millimeter'",
      "SCOORD3D, 121055 DCM 'Path': POLYLINE in 1.2.3.4: 1.250000 -2.500000 300.125000 4.000000 1.000000 2.000000",
      "CONTAINER, 125007 DCM 'Measurement Group': SEPARATE",
      "TEXT, 112039 DCM 'Tracking Identifier': Way",
      "UIDREF, 112040 DCM 'Tracking Unique Identifier': made",
      "NUM, PATH 99PALPATE 'Length of the felt path': 10.5 mm UCUM 'millimeter'",
      "SCOORD3D, 121055 DCM 'Path': POLYLINE in 1.2.3.4: 1.000000 2.000000 3.000000 4.000000 5.000000 6.000000 "
      "7.000000 8.000000 9.500000",
      "CONTAINER, 125007 DCM 'Measurement Group': SEPARATE",
      "TEXT, 112039 DCM 'Tracking Identifier': Angle at Mark 2",
      "UIDREF, 112040 DCM 'Tracking Unique Identifier': made",
      "NUM, 110859 DCM 'Angle': 101.25 deg UCUM 'degree'",
      "SCOORD3D, 121055 DCM 'Path': POLYLINE in 1.2.3.4: 1.000000 2.000000 3.000000 4.000000 1.000000 2.000000 "
      "7.000000 8.000000 9.500000",
      "TEXT, 121106 DCM 'Comment': Measured by research software, which is not a medical device."};
  // Letter by letter but for capitals, in which DCMTK's lists of codes differ.
  const auto small = [](std::vector<std::string> lines) {
    for (std::string& line : lines) {
      std::ranges::transform(line, line.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    }
    return lines;
  };
  EXPECT_EQ(small(contents_of(told_series(scratch.path()), report, scratch.path() / "report")), small(expected));
}

/// Of a scan without a unit, of a PET, a dose, a flow, and of a map whose unit is too long for a code.
TEST(ReportContents, SayTheUnitOfTheScan) {
  const FreshFolder scratch = temporary_folder();
  Series series = told_series(scratch.path());
  const MeasurementReport report{.software_version = "1", .points = {{"Mark", {1, 2, 3}, "", 7.25, {}}}, .lengths = {}};
  for (const auto& [unit, expected] : {std::pair{"", "1 UCUM 'no units'"},
                                       {"Bq/ml", "Bq/ml UCUM 'Bq/ml'"},
                                       {"Gy", "Gy UCUM 'Gy'"},
                                       {"m/s", "m/s UCUM 'm/s'"},
                                       {"10*-6.mm2/s.kg.m.A", "1 UCUM 'no units'"}}) {
    series.unit = unit;
    const auto lines = contents_of(series, report, scratch.path() / "report");
    const std::string line = std::string("NUM, VALUE 99PALPATE 'Value of the image': 7.25 ") + expected;
    EXPECT_EQ(std::ranges::count(lines, line), 1) << unit;
  }
}

/// What each file says once, whoever made it and whatever is in it.
void expect_header(const fs::path& file, const std::map<std::string, std::string>& expected) {
  DcmFileFormat format;
  ASSERT_TRUE(format.loadFile(file.c_str()).good());
  for (const auto& [name, value] : expected) {
    DcmTag tag;
    ASSERT_TRUE(DcmTag::findTagFromName(name.c_str(), tag).good()) << name;
    EXPECT_EQ(said(*format.getDataset(), tag), value) << name << " of " << file.filename();
  }
}

const std::vector<Picture>& two_pictures() {
  static const std::vector<Picture> two{{3, 2, std::vector<std::uint8_t>(18, 7), "first"},
                                        {1, 2, {1, 2, 3, 4, 5, 6}, "second"}};
  return two;
}

/// Of a series of two patients by mistake, the first image counts. All of type 1 or 2 is there, and no more.
TEST(ReportContents, AreOfThePatientAndStudyOfTheFirstImage) {
  const FreshFolder scratch = temporary_folder();
  write_measurement_report(told_series(scratch.path()), {.software_version = "1", .points = {}, .lengths = {}},
                           scratch.path() / "report");
  write_pictures(told_series(scratch.path()), "1", two_pictures(), scratch.path());
  std::map<std::string, std::string> expected;
  for (const Told& one : told()) expected[DcmTag(one.key).getTagName()] = one.first;
  for (const char* const file : {"report", "picture-001.dcm", "picture-002.dcm"}) {
    expect_header(scratch.path() / file, expected);
  }
}

TEST(ReportContents, LeaveOutOnlyWhatMayBeLeftOut) {
  const FreshFolder scratch = temporary_folder();
  write_pictures(told_series(scratch.path(), true), "1", two_pictures(), scratch.path());
  std::map<std::string, std::string> expected;
  for (const Told& one : told()) {
    const bool optional = one.key == DCM_IssuerOfPatientID || one.key == DCM_StudyDescription;
    expected[DcmTag(one.key).getTagName()] = optional ? "absent" : one.key == DCM_StudyInstanceUID ? one.first : "";
  }
  expect_header(scratch.path() / "picture-001.dcm", expected);
}

TEST(ReportContents, NameWhatMadeThem) {
  const FreshFolder scratch = temporary_folder();
  const Series series = told_series(scratch.path());
  write_measurement_report(series, {.software_version = "2.5", .points = {}, .lengths = {}}, scratch.path() / "report");
  write_pictures(series, "2.5", two_pictures(), scratch.path());
  std::map<std::string, std::string> expected{{"Manufacturer", "Palpate"},
                                              {"ManufacturerModelName", "Palpate"},
                                              {"DeviceSerialNumber", "0"},
                                              {"SoftwareVersions", "2.5"},
                                              {"SpecificCharacterSet", "ISO_IR 192"}};
  expected["SeriesDescription"] = "Palpate: marks and measurements";
  expected["Modality"] = "SR";
  expected["SOPClassUID"] = UID_Comprehensive3DSRStorage;
  expect_header(scratch.path() / "report", expected);
  expected["SeriesDescription"] = "Palpate: pictures";
  expected["Modality"] = "OT";
  expected["SOPClassUID"] = UID_SecondaryCaptureImageStorage;
  expect_header(scratch.path() / "picture-001.dcm", expected);
}

TEST(ReportContents, ReferToEachImageOfItsSeries) {
  const FreshFolder scratch = temporary_folder();
  write_measurement_report(told_series(scratch.path()), {.software_version = "1", .points = {}, .lengths = {}},
                           scratch.path() / "report");
  DcmFileFormat format;
  ASSERT_TRUE(format.loadFile((scratch.path() / "report").c_str()).good());
  DcmItem *study = nullptr, *series = nullptr, *image = nullptr;
  ASSERT_TRUE(format.getDataset()->findAndGetSequenceItem(DCM_CurrentRequestedProcedureEvidenceSequence, study).good());
  EXPECT_EQ(said(*study, DCM_StudyInstanceUID), "1.2.3.2");
  std::vector<std::string> images;
  for (long s = 0; study->findAndGetSequenceItem(DCM_ReferencedSeriesSequence, series, s).good(); ++s) {
    for (long n = 0; series->findAndGetSequenceItem(DCM_ReferencedSOPSequence, image, n).good(); ++n) {
      images.push_back(said(*series, DCM_SeriesInstanceUID) + " " + said(*image, DCM_ReferencedSOPClassUID) + " " +
                       said(*image, DCM_ReferencedSOPInstanceUID));
    }
  }
  EXPECT_EQ(images, (std::vector<std::string>{std::string("1.2.3.3 ") + UID_CTImageStorage + " 1.2.3.5",
                                              std::string("1.2.3.33 ") + UID_MRImageStorage + " 1.2.3.6"}));
}

/// DICOM PS3.3 C.7.6.3 and C.8.6: colors of 8 bits, pixel by pixel, from a workstation, derived; no patient's data in
/// the pixels.
TEST(PictureContents, AreThoseOfASecondaryCapture) {
  const FreshFolder scratch = temporary_folder();
  write_pictures(told_series(scratch.path()), "1", two_pictures(), scratch.path());
  std::map<std::string, std::string> expected{
      {"SeriesNumber", ""},
      {"ConversionType", "WSD"},
      {"PatientOrientation", ""},
      {"Laterality", ""},
      {"ImageType", "DERIVED\\SECONDARY"},
      {"BurnedInAnnotation", "NO"},
      {"ImageComments", "Measured by research software, which is not a medical device."},
      {"PhotometricInterpretation", "RGB"},
      {"SamplesPerPixel", "3"},
      {"PlanarConfiguration", "0"},
      {"BitsAllocated", "8"},
      {"BitsStored", "8"},
      {"HighBit", "7"},
      {"PixelRepresentation", "0"}};
  int number = 0;
  for (const Picture& picture : two_pictures()) {
    ++number;
    expected["InstanceNumber"] = std::to_string(number);
    expected["Rows"] = std::to_string(picture.rows);
    expected["Columns"] = std::to_string(picture.columns);
    expected["DerivationDescription"] = picture.description;
    const fs::path file = scratch.path() / ("picture-00" + std::to_string(number) + ".dcm");
    expect_header(file, expected);
    DcmFileFormat format;
    ASSERT_TRUE(format.loadFile(file.c_str()).good());
    DcmDataset& data = *format.getDataset();
    for (const DcmTagKey& key : {DCM_SOPInstanceUID, DCM_SeriesInstanceUID}) EXPECT_TRUE(is_uid(said(data, key)));
    EXPECT_EQ(said(data, DCM_ContentDate).size(), 8U);
    EXPECT_GE(said(data, DCM_ContentTime).size(), 6U);
    const Uint8* pixels = nullptr;
    unsigned long count = 0;
    ASSERT_TRUE(data.findAndGetUint8Array(DCM_PixelData, pixels, &count).good());
    EXPECT_EQ(std::vector<std::uint8_t>(pixels, pixels + count), picture.pixels);
  }
}

TEST(PictureContents, AreRefusedWhereTheyCannotBeWritten) {
  const FreshFolder scratch = temporary_folder();
  EXPECT_THROW(write_pictures(told_series(scratch.path()), "1", two_pictures(), "/no/such/folder"), DicomError);
}

/// Each of study, series and frame of reference is needed.
TEST(ReportContents, NeedEachOfWhatTheyReferTo) {
  const FreshFolder scratch = temporary_folder();
  for (const DcmTagKey& missing : {DCM_StudyInstanceUID, DCM_SeriesInstanceUID, DCM_FrameOfReferenceUID}) {
    const Series series = told_series(scratch.path());
    DcmFileFormat first;
    ASSERT_TRUE(first.loadFile(series.files.front().c_str()).good());
    first.loadAllDataIntoMemory();
    first.getDataset()->findAndDeleteElement(missing);
    ASSERT_TRUE(first.saveFile(series.files.front().c_str(), EXS_LittleEndianExplicit).good());
    EXPECT_THROW(write_measurement_report(series, {.software_version = "1", .points = {}, .lengths = {}},
                                          scratch.path() / "report"),
                 DicomError)
        << DcmTag(missing).getTagName();
  }
}

}  // namespace
}  // namespace palpate::io
