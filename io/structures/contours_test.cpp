// Contours written by DCMTK: their measures, and refusals in words.
#include "io/structures/structure.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/testing/test_image.h"

namespace palpate::io {
namespace {

using internal::put;
using internal::TestFolder;
using internal::TestImage;
using ::testing::HasSubstr;

StructureCatalogue structures_in(const TestFolder& folder) {
  return find_structures(std::array{folder.path()});
}

DcmItem& new_item(DcmItem& item, const DcmTagKey& sequence) {
  DcmItem* added = nullptr;
  internal::succeed(item.findOrCreateSequenceItem(sequence, added, -2));
  return *added;
}

struct TestContour {
  std::string type;
  std::string points;
};

std::string square(double half, double z) {
  const auto n = [](double v) { return std::to_string(v); };
  return n(-half) + "\\" + n(-half) + "\\" + n(z) + "\\" + n(half) + "\\" + n(-half) + "\\" + n(z) + "\\" + n(half) +
         "\\" + n(half) + "\\" + n(z) + "\\" + n(-half) + "\\" + n(half) + "\\" + n(z);
}

StructureCatalogue contours_in(const std::vector<TestContour>& contours, const TestFolder& folder) {
  TestImage image;
  image.edit = [&](DcmDataset& dataset) {
    dataset.findAndDeleteElement(DCM_PixelData);
    put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.481.3");
    DcmItem& roi = new_item(dataset, DCM_StructureSetROISequence);
    roi.putAndInsertString(DCM_ROINumber, "7");
    roi.putAndInsertString(DCM_ROIName, "Aorta");
    roi.putAndInsertString(DCM_ReferencedFrameOfReferenceUID, "1.2.3.9");
    DcmItem& drawn = new_item(dataset, DCM_ROIContourSequence);
    drawn.putAndInsertString(DCM_ReferencedROINumber, "7");
    drawn.putAndInsertString(DCM_ROIDisplayColor, "255\\0\\128");
    for (const TestContour& contour : contours) {
      DcmItem& item = new_item(drawn, DCM_ContourSequence);
      item.putAndInsertString(DCM_ContourGeometricType, contour.type.c_str());
      item.putAndInsertString(DCM_ContourData, contour.points.c_str());
    }
  };
  internal::write(image, folder / "rt.dcm");
  return structures_in(folder);
}

TEST(Contours, AreMeasuredByTheirPolygons) {
  const TestFolder folder;
  const auto catalogue = contours_in(
      {{"CLOSED_PLANAR", square(10, 0)}, {"CLOSED_PLANAR", square(10, 3)}, {"CLOSED_PLANAR", square(4, 3)}}, folder);
  ASSERT_EQ(catalogue.structures.size(), 1U);
  const Structure& aorta = catalogue.structures[0];
  EXPECT_EQ(aorta.kind, StructureKind::contours);
  EXPECT_EQ(aorta.number, 7);
  EXPECT_EQ(aorta.name, "Aorta");
  EXPECT_EQ(aorta.color, "#ff0080");
  EXPECT_EQ(aorta.frame_of_reference_uid, "1.2.3.9");
  EXPECT_EQ(aorta.unfit, "");
  EXPECT_NEAR(measure(aorta).volume_mm3, 3 * (400 + 400 - 64), 1e-6);
}

std::string unfit_of(const std::vector<TestContour>& contours) {
  const TestFolder folder;
  return contours_in(contours, folder).structures.at(0).unfit;
}

TEST(Contours, AreRefusedInWords) {
  EXPECT_EQ(unfit_of({}), "it is empty: it has no contour");
  EXPECT_EQ(unfit_of({{"OPEN_PLANAR", square(3, 0)}, {"POINT", "1\\2\\3"}}),
            "it has no closed contour, only 1 OPEN_PLANAR, 1 POINT");
  EXPECT_EQ(unfit_of({{"CLOSED_PLANAR", "0\\0\\0\\1\\0\\0\\0\\1"}}),
            "a contour of it has 8 numbers, not three for each point");
  EXPECT_EQ(unfit_of({{"CLOSED_PLANAR", "0\\0\\0\\10\\0\\0\\10\\10\\5\\0\\10\\0"}}),
            "its contours do not lie in parallel planes: export it as SEG");
  EXPECT_EQ(unfit_of({{"CLOSED_PLANAR", "0\\0\\0\\1\\0\\0\\2\\0\\0"}}), "its contours have no area");
}

TEST(Contours, AreRefusedWholeInWords) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& dataset) { put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.481.3"); };
  internal::write(image, folder / "rt.dcm");
  EXPECT_EQ(structures_in(folder).skipped.at(0).reason, "it names no ROI (StructureSetROISequence): export it again");
}

std::string refusal_of_contours(const std::vector<TestContour>& contours) {
  const TestFolder folder;
  const StructureCatalogue catalogue = contours_in(contours, folder);
  const Structure& structure = catalogue.structures.at(0);
  if (!structure.unfit.empty()) return structure.unfit;
  try {
    load_distance(structure);
  } catch (const DicomError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Contours, ThatAreTooLargeAreRefusedInWords) {
  EXPECT_THAT(refusal_of_contours({{"CLOSED_PLANAR", square(30000, 0)}, {"CLOSED_PLANAR", square(30000, 900)}}),
              ::testing::AllOf(HasSubstr("rt.dcm: RTSTRUCT \"Aorta\" (7) cannot be read: its contours span "),
                               HasSubstr("mm: more than can be felt")));
  std::vector<TestContour> many;
  for (int n = 0; n < 4097; ++n) many.push_back({"CLOSED_PLANAR", square(3, 0.1 * n)});
  EXPECT_EQ(refusal_of_contours(many), "its contours lie in 4097 planes; at most 4096 are allowed");
}

TEST(Contours, ThatCannotBeFeltSayWhy) {
  const TestFolder folder;
  const StructureCatalogue catalogue = contours_in({}, folder);
  try {
    measure(catalogue.structures.at(0));
    FAIL() << "was measured";
  } catch (const DicomError& error) {
    EXPECT_STREQ(error.what(), "rt.dcm: RTSTRUCT \"Aorta\" (7) cannot be felt: it is empty: it has no contour");
  }
}

// What has fewer than three points has no inside; and an exclusive-or of closed ones is drawn like them.
TEST(Contours, OfEitherClosedTypeAreDrawnIfTheyHaveAnArea) {
  for (const char* const type : {"CLOSED_PLANAR", "CLOSEDPLANAR_XOR"}) {
    const TestFolder folder;
    const auto catalogue = contours_in(
        {{type, square(10, 0)}, {type, square(10, 3)}, {type, "1\\2\\3"}, {type, "1\\2\\3\\4\\5\\3"}}, folder);
    const Structure& structure = catalogue.structures.at(0);
    EXPECT_EQ(structure.unfit, "");
    const StructureMeasures measures = measure(structure);
    EXPECT_EQ(measures.contours, 2U);
    EXPECT_NEAR(measures.volume_mm3, 2 * 400 * 3, 1e-6);
  }
}

TEST(Contours, ThatAreOpenAreLeftOutAndSaid) {
  const TestFolder folder;
  const auto catalogue = contours_in({{"CLOSED_PLANAR", square(3, 0)}, {"OPEN_PLANAR", square(3, 2)}}, folder);
  EXPECT_THAT(catalogue.structures.at(0).warnings,
              ::testing::ElementsAre("contours that are not closed are left out: 1 OPEN_PLANAR"));
}

TEST(Contours, AreCutShortWithoutACrash) {
  // Every length of the file: refused or read, never more.
  const TestFolder folder;
  contours_in({{"CLOSED_PLANAR", square(10, 0)}, {"CLOSED_PLANAR", square(10, 3)}}, folder);
  const auto whole = std::filesystem::file_size(folder / "rt.dcm");
  for (std::uintmax_t size = whole; size > 0; size -= std::min<std::uintmax_t>(size, 7)) {
    std::filesystem::resize_file(folder / "rt.dcm", size);
    for (const Structure& structure : structures_in(folder).structures) {
      if (structure.unfit.empty()) {
        EXPECT_NO_THROW(measure(structure));
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
