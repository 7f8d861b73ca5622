// Reports and pictures, read back with DCMTK alone.

#include "io/results/measurement_report.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmsr/dsrdoc.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "io/archive/testing/says.h"
#include "io/errors.h"
#include "io/fresh_folder.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using testing::says;

/// Two images of a patient whose name is in Latin-1.
Series series_in(const fs::path& folder, const char* frame_of_reference = "1.2.3.4") {
  Series series;
  series.uid = "1.2.3.3";
  series.unit = "HU";
  for (const char* const instance : {"1.2.3.5", "1.2.3.6"}) {
    DcmFileFormat file;
    DcmDataset& data = *file.getDataset();
    data.putAndInsertString(DCM_SpecificCharacterSet, "ISO_IR 100");
    data.putAndInsertString(DCM_SOPClassUID, UID_CTImageStorage);
    data.putAndInsertString(DCM_SOPInstanceUID, instance);
    data.putAndInsertString(DCM_PatientName, "M\xFCller^Zo\xEB");
    data.putAndInsertString(DCM_PatientID, "4711");
    data.putAndInsertString(DCM_StudyDate, "20240229");
    data.putAndInsertString(DCM_StudyInstanceUID, "1.2.3.2");
    data.putAndInsertString(DCM_SeriesInstanceUID, "1.2.3.3");
    data.putAndInsertString(DCM_FrameOfReferenceUID, frame_of_reference);
    series.files.push_back(folder / instance);
    EXPECT_TRUE(file.saveFile(series.files.back().c_str(), EXS_LittleEndianExplicit).good());
  }
  return series;
}

const MeasurementReport two_marks{.software_version = "1.0",
                                  .points = {{"Mark 1", {1.25, -2.5, 300.125}, "sk\xC3\xB6n", 41.5, 0.75},
                                             {"Mark 2", {4.25, 1.5, 300.125}, "", {}, {}}},
                                  .lengths = {{"Mark 1 to Mark 2", {{1.25, -2.5, 300.125}, {4.25, 1.5, 300.125}}, 5}}};

std::string text(DcmItem& item, const DcmTagKey& key) {
  OFString value;
  item.findAndGetOFString(key, value);
  return value.c_str();
}

std::string refusal(const Series& series, const MeasurementReport& report, const fs::path& file) {
  try {
    write_measurement_report(series, report, file);
  } catch (const DicomError& error) {
    return error.what();
  }
  return "no refusal";
}

TEST(MeasurementReport, GoesIntoTheStudyOfItsImages) {
  const FreshFolder scratch = temporary_folder();
  const fs::path file = scratch.path() / "report.dcm";
  write_measurement_report(series_in(scratch.path()), two_marks, file);
  DcmFileFormat format;
  ASSERT_TRUE(format.loadFile(file.c_str()).good());
  DcmDataset& data = *format.getDataset();
  EXPECT_EQ(text(data, DCM_SOPClassUID), UID_Comprehensive3DSRStorage);
  EXPECT_EQ(text(data, DCM_StudyInstanceUID), "1.2.3.2");
  EXPECT_NE(text(data, DCM_SeriesInstanceUID), "1.2.3.3") << "a series of its own";
  EXPECT_EQ(text(data, DCM_PatientID), "4711");
  EXPECT_EQ(text(data, DCM_StudyDate), "20240229");
  EXPECT_EQ(text(data, DCM_SpecificCharacterSet), "ISO_IR 192");
  EXPECT_EQ(text(data, DCM_PatientName), "M\xC3\xBCller^Zo\xC3\xAB");
  DSRDocument document;
  ASSERT_TRUE(document.read(data).good());
  EXPECT_TRUE(document.isValid());
  EXPECT_EQ(document.getCurrentRequestedProcedureEvidence().getNumberOfInstances(), 2U);
  // The points and the distance, wherever in the tree they are.
  DSRDocumentTree& tree = document.getTree();
  std::vector<DSRGraphicData3DItem> points;
  std::vector<std::string> numbers;
  int images = 0;
  for (tree.gotoRoot(); tree.iterate() != 0;) {
    const DSRContentItem& item = tree.getCurrentContentItem();
    if (item.getValueType() == DSRTypes::VT_Image) ++images;
    if (item.getValueType() == DSRTypes::VT_Num) numbers.emplace_back(item.getNumericValue().getNumericValue().c_str());
    if (item.getValueType() != DSRTypes::VT_SCoord3D) continue;
    DSRSpatialCoordinates3DValue value = item.getSpatialCoordinates3D();
    EXPECT_EQ(value.getFrameOfReferenceUID(), "1.2.3.4");
    for (size_t n = 1; n <= value.getGraphicDataList().getNumberOfItems(); ++n) {
      points.push_back(value.getGraphicDataList().getItem(n));
    }
  }
  EXPECT_EQ(images, 2);
  EXPECT_EQ(numbers, (std::vector<std::string>{"41.5", "0.75", "5"}));
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[0].XCoord, 1.25F);
  EXPECT_EQ(points[0].YCoord, -2.5F);
  EXPECT_EQ(points[0].ZCoord, 300.125F);
  EXPECT_EQ(points[3].YCoord, 1.5F);
}

/// A line for each content item below this one: relationship, type and the code of its concept, by the file's bytes.
void outline(DcmItem& item, const std::string& indent, std::vector<std::string>& lines) {
  std::string line = indent;
  if (const std::string relation = text(item, DCM_RelationshipType); !relation.empty()) line += relation + " ";
  line += text(item, DCM_ValueType);
  DcmItem* part = nullptr;
  if (item.findAndGetSequenceItem(DCM_ConceptNameCodeSequence, part).good()) line += " " + text(*part, DCM_CodeValue);
  if (item.findAndGetSequenceItem(DCM_ContentTemplateSequence, part).good()) {
    line += ", template " + text(*part, DCM_TemplateIdentifier);
  }
  lines.push_back(line);
  for (long n = 0; item.findAndGetSequenceItem(DCM_ContentSequence, part, n).good(); ++n) {
    outline(*part, indent + "  ", lines);
  }
}

/// Source: DICOM PS3.16, templates 1500, 1501, 1600 and 1004, and the codes of its annex D.
TEST(MeasurementReport, HasTheTreeOfItsTemplates) {
  const FreshFolder scratch = temporary_folder();
  const fs::path file = scratch.path() / "report.dcm";
  write_measurement_report(series_in(scratch.path()), two_marks, file);
  DcmFileFormat format;
  ASSERT_TRUE(format.loadFile(file.c_str()).good());
  std::vector<std::string> lines;
  outline(*format.getDataset(), "", lines);
  const std::vector<std::string> wanted{"CONTAINER 126000, template 1500",
                                        "  HAS CONCEPT MOD CODE 121049",
                                        "  HAS OBS CONTEXT CODE 121005",
                                        "  HAS OBS CONTEXT UIDREF 121012",
                                        "  HAS OBS CONTEXT TEXT 121013",
                                        "  HAS CONCEPT MOD CODE 121058",
                                        "  CONTAINS CONTAINER 111028",
                                        "    CONTAINS CONTAINER 126200",
                                        "      CONTAINS IMAGE",
                                        "      CONTAINS IMAGE",
                                        "  CONTAINS CONTAINER 126010",
                                        "    CONTAINS CONTAINER 125007, template 1501",
                                        "      HAS OBS CONTEXT TEXT 112039",
                                        "      HAS OBS CONTEXT UIDREF 112040",
                                        "      CONTAINS TEXT 121106",
                                        "      CONTAINS SCOORD3D 111030",
                                        "      CONTAINS NUM 112031",
                                        "      CONTAINS NUM FORCE",
                                        "    CONTAINS CONTAINER 125007, template 1501",
                                        "      HAS OBS CONTEXT TEXT 112039",
                                        "      HAS OBS CONTEXT UIDREF 112040",
                                        "      CONTAINS TEXT 121106",
                                        "      CONTAINS SCOORD3D 111030",
                                        "    CONTAINS CONTAINER 125007, template 1501",
                                        "      HAS OBS CONTEXT TEXT 112039",
                                        "      HAS OBS CONTEXT UIDREF 112040",
                                        "      CONTAINS NUM 121206",
                                        "        INFERRED FROM SCOORD3D 121055",
                                        "  CONTAINS TEXT 121106"};
  EXPECT_EQ(lines, wanted);
}

TEST(MeasurementReport, RefusesWhatNothingCanReferTo) {
  const FreshFolder scratch = temporary_folder();
  const fs::path file = scratch.path() / "report.dcm";
  Series series = series_in(scratch.path());
  EXPECT_TRUE(says(refusal(series, two_marks, "/no/such/folder/report.dcm"),
                   "{} cannot be written: make room, or name another folder"));
  MeasurementReport nameless = two_marks;
  nameless.points.front().name = "";
  EXPECT_TRUE(says(refusal(series, nameless, file), "the report cannot be made: {}"));
  std::ofstream(series.files.back()) << "no longer DICOM";
  EXPECT_TRUE(says(refusal(series, two_marks, file), "{} cannot be read to its end, so nothing can refer to it"));
  EXPECT_TRUE(
      says(refusal(series_in(scratch.path(), ""), two_marks, file),
           "series {}: its images name no study, series or frame of reference (FrameOfReferenceUID), so nothing can "
           "refer to places in it: export the original images"));
  EXPECT_FALSE(fs::exists(file));
}

TEST(Pictures, AreASeriesOfTheStudy) {
  const FreshFolder scratch = temporary_folder();
  Picture picture{2, 1, {255, 0, 0, 0, 0, 255}, "red and blue"};
  write_pictures(series_in(scratch.path()), "1.0", std::vector{picture, picture}, scratch.path());
  DcmFileFormat first, second;
  ASSERT_TRUE(first.loadFile((scratch.path() / "picture-001.dcm").c_str()).good());
  ASSERT_TRUE(second.loadFile((scratch.path() / "picture-002.dcm").c_str()).good());
  DcmDataset& data = *first.getDataset();
  EXPECT_EQ(text(data, DCM_SOPClassUID), UID_SecondaryCaptureImageStorage);
  EXPECT_EQ(text(data, DCM_StudyInstanceUID), "1.2.3.2");
  EXPECT_EQ(text(data, DCM_SeriesInstanceUID), text(*second.getDataset(), DCM_SeriesInstanceUID));
  EXPECT_NE(text(data, DCM_SOPInstanceUID), text(*second.getDataset(), DCM_SOPInstanceUID));
  const Uint8* pixels = nullptr;
  unsigned long count = 0;
  ASSERT_TRUE(data.findAndGetUint8Array(DCM_PixelData, pixels, &count).good());
  EXPECT_EQ(std::vector<std::uint8_t>(pixels, pixels + count), picture.pixels);
}

}  // namespace
}  // namespace palpate::io
