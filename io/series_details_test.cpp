// The details of series, which one to feel first, and which files are skipped, against headers written here.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "io/choose_first.h"
#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

using Attributes = std::vector<std::pair<DcmTagKey, std::string>>;

Series series_with(const Attributes& attributes, double step = 2, int count = 3) {
  const TestFolder folder;
  write_stack(folder.path(), count, [&](int k, TestImage& image) {
    image.z = step * k;
    image.edit = [&](DcmDataset& d) {
      for (const auto& [tag, value] : attributes) put(d, tag, value);
    };
  });
  return find_in(folder).series.at(0);
}

TEST(SeriesDetails, AreWhatTheHeaderSays) {
  const Series::Details said = series_with({{DCM_SpecificCharacterSet, "ISO_IR 100"},
                                            {DCM_SeriesNumber, "7"},
                                            {DCM_StudyDate, "20260101"},
                                            {DCM_AcquisitionDate, "20260102"},
                                            {DCM_SeriesDate, "20260103"},
                                            {DCM_AcquisitionTime, "101112"},
                                            {DCM_SeriesTime, "101500.25"},
                                            {DCM_BodyPartExamined, "HEAD"},
                                            {DCM_ConvolutionKernel, "I30f\\3"},
                                            {DCM_SequenceName, "*tfl3d1"},
                                            {DCM_ScanningSequence, "GR\\IR"},
                                            {DCM_ContrastBolusAgent, "l\xF6slich"},
                                            {DCM_SliceThickness, "2.5"}})
                                   .details;
  EXPECT_EQ(said.number, 7);
  EXPECT_EQ(said.date, "20260103");
  EXPECT_EQ(said.time, "101500.25");
  EXPECT_EQ(said.body_part, "HEAD");
  EXPECT_EQ(said.kernel, "I30f 3");
  EXPECT_EQ(said.sequence, "*tfl3d1");
  EXPECT_EQ(said.contrast, "l\xC3\xB6slich");
  EXPECT_EQ(said.thickness_mm, 2.5);
  EXPECT_FALSE(said.is_derived || said.is_projection || said.is_lossy);

  const Series::Details older = series_with({{DCM_StudyDate, "20260101"},
                                             {DCM_AcquisitionDate, "20260102"},
                                             {DCM_AcquisitionTime, "101112"},
                                             {DCM_ScanningSequence, "GR\\IR"}})
                                    .details;
  EXPECT_EQ(older.date, "20260102");
  EXPECT_EQ(older.time, "101112");
  EXPECT_EQ(older.sequence, "GR IR");
  EXPECT_EQ(series_with({{DCM_StudyDate, "20260101"}}).details.date, "20260101");

  const Series::Details silent = series_with({{DCM_SliceThickness, ""}}).details;
  EXPECT_FALSE(silent.number);
  EXPECT_EQ(silent.date + silent.time + silent.body_part + silent.kernel + silent.sequence + silent.contrast, "");
  EXPECT_EQ(silent.thickness_mm, 0);
}

TEST(SeriesDetails, OrientationIsThatOfTheSlices) {
  struct Case {
    const char* directions;
    const char* name;
    std::array<double, 3> step;
  };
  const std::array cases{Case{"1\\0\\0\\0\\1\\0", "axial", {0, 0, 2}},
                         Case{"1\\0\\0\\0\\0.96592583\\0.25881905", "axial", {0, -0.5176, 1.9319}},  // 15 degrees
                         Case{"1\\0\\0\\0\\0\\-1", "coronal", {0, 2, 0}},
                         Case{"0\\1\\0\\0\\0\\-1", "sagittal", {-2, 0, 0}},
                         Case{"0\\-1\\0\\0\\0\\-1", "sagittal", {2, 0, 0}},
                         Case{"1\\0\\0\\0\\0.70710678\\0.70710678", "oblique", {0, -1.4142, 1.4142}}};
  for (const Case& is : cases) {
    const TestFolder folder;
    write_stack(folder.path(), 3, [&](int k, TestImage& image) {
      image.edit = [&, k](DcmDataset& d) {
        put(d, DCM_ImageOrientationPatient, is.directions);
        std::string position;
        for (const double along : is.step) position += (position.empty() ? "" : "\\") + std::to_string(k * along);
        put(d, DCM_ImagePositionPatient, position);
      };
    });
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.series, SizeIs(1)) << is.directions;
    EXPECT_EQ(found.series[0].details.orientation, is.name) << is.directions;
  }
}

TEST(SeriesDetails, NotesTellWhereWhatIsFeltIsNotWhatIsThought) {
  const Series series = series_with({{DCM_Modality, "PT"},
                                     {DCM_Units, "BQML"},
                                     {DCM_SliceThickness, "5"},
                                     {DCM_ImageType, "DERIVED\\PRIMARY\\MIP"},
                                     {DCM_LossyImageCompression, "01"},
                                     {DCM_LossyImageCompressionRatio, "12.5"}},
                                    20);
  EXPECT_THAT(
      series.warnings,
      ::testing::IsSupersetOf(
          {"slices are 5.00 mm thick and 20.00 mm apart: what lies between them was not scanned",
           "its slices are projections (the largest or least value of several): depth is not felt at its true place",
           "lossy compression of 12.5 to 1: fine edges may be artifacts",
           "PET: its values are uptake, not density; a scene made for CT does not fit"}));
  EXPECT_EQ(series.unit, "Bq/ml");
  EXPECT_EQ(series_with({{DCM_Modality, "PT"}, {DCM_Units, "GML"}}).unit, "g/ml");
  EXPECT_EQ(series_with({{DCM_Modality, "PT"}, {DCM_Units, "CNTS"}}).unit, "");
  EXPECT_EQ(series_with({{DCM_Modality, "MR"}, {DCM_Units, "BQML"}}).unit, "");
  EXPECT_THAT(series_with({{DCM_LossyImageCompression, "01"}}).warnings,
              Contains("lossy compression: fine edges may be artifacts"));
  EXPECT_THAT(series_with({{DCM_LossyImageCompression, "01"}, {DCM_LossyImageCompressionRatio, "4\\2.5"}}).warnings,
              Contains("lossy compression of 10.0 to 1: fine edges may be artifacts"));
  const char* computed = "its images were computed from others: choose the original images where fine edges matter";
  EXPECT_THAT(series_with({{DCM_ImageType, "DERIVED\\SECONDARY\\MPR"}}).warnings, Contains(computed));
  EXPECT_THAT(series.warnings, Not(Contains(computed)));  // the projection is said
}

TEST(SeriesDetails, NotesAreGivenWhereTheyAreTrueOnly) {
  const std::string gap = "what lies between them was not scanned";
  for (const auto& [thickness, has_gap] : {std::pair{"2", false}, {"1.5", false}, {"1.25", true}, {"0.5", true}}) {
    const Series series = series_with({{DCM_SliceThickness, thickness}});  // 2 mm apart
    EXPECT_THAT(series.warnings, has_gap ? ::testing::Matcher<std::vector<Text>>(Contains(HasSubstr(gap)))
                                         : Not(Contains(HasSubstr(gap))))
        << thickness;
  }
  EXPECT_THAT(series_with({{DCM_Modality, "MR"}, {DCM_LossyImageCompression, "00"}}).warnings, IsEmpty());
}

// What radiologists ask for first: thin slices, a soft kernel, most of them.
TEST(SeriesDetails, FirstChoiceIsThinAndSoft) {
  struct Kind {
    double step;
    const char* kernel;
    const char* type;
    int count;
    const char* modality = "CT";
  };
  const std::array kinds{
      Kind{5, "B30f", "ORIGINAL\\PRIMARY\\AXIAL", 30},  Kind{1, "B70f", "ORIGINAL\\PRIMARY\\AXIAL", 30},
      Kind{1, "B30f", "ORIGINAL\\PRIMARY\\AXIAL", 30},  Kind{1, "B30f", "DERIVED\\SECONDARY\\MIP", 40},
      Kind{1, "FC51", "ORIGINAL\\PRIMARY\\AXIAL", 31},  Kind{1, "B30f", "ORIGINAL\\PRIMARY\\AXIAL", 29},
      Kind{0.5, "B30f", "ORIGINAL\\PRIMARY\\AXIAL", 3}, Kind{0.5, "", "ORIGINAL\\PRIMARY", 50, "PT"}};
  const TestFolder folder;
  for (std::size_t n = 0; n < kinds.size(); ++n) {
    const fs::path part = folder / std::to_string(n);
    fs::create_directory(part);
    write_stack(part, kinds[n].count, [&, n](int k, TestImage& image) {
      image.z = kinds[n].step * k;
      image.series = numbered("1.2.3.4.", static_cast<int>(n));
      image.edit = [&, n](DcmDataset& d) {
        put(d, DCM_Modality, kinds[n].modality);
        put(d, DCM_ConvolutionKernel, kinds[n].kernel);
        put(d, DCM_ImageType, kinds[n].type);
        put(d, DCM_SliceThickness, std::to_string(kinds[n].step));
      };
    });
  }
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(kinds.size()));
  const auto first = choose_first(found.series);
  ASSERT_TRUE(first);
  EXPECT_EQ(found.series[first->index].uid, "1.2.3.4.2");
  EXPECT_EQ(first->why, "slices every 1.00 mm, soft kernel B30f, 30 slices");
  EXPECT_FALSE(choose_first({}));
}

TEST(SeriesDetails, SharpKernelsAreKnownByTheirMakersNames) {
  for (const char* sharp : {"B70f", "BONE", "Br64d", "FC51", "FC30", "FC81", "LUNG", "I70f 3", "Hr68", "BONEPLUS"}) {
    EXPECT_TRUE(is_sharp(sharp)) << sharp;
  }
  for (const char* soft : {"B30f", "STANDARD", "SOFT", "FC18", "FC44", "Br40d", "", "B", "7", "70"}) {
    EXPECT_FALSE(is_sharp(soft)) << soft;
  }
}

TEST(SeriesDetails, SeriesAreSortedByStudyAndNumber) {
  struct Place {
    const char* study;
    const char* date;
    const char* number;
  };
  // In the order that is expected; written in another one.
  const std::array places{Place{"1.2.8", "20250101", "3"},  Place{"1.2.8", "20250101", "21"},
                          Place{"1.2.7", "20260101", "2"},  Place{"1.2.7", "20260101", "10"},
                          Place{"1.2.7", "20260101", "11"}, Place{"1.2.7", "20260101", ""}};
  const TestFolder folder;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const fs::path part = folder / std::to_string((5 * n + 3) % places.size());
    fs::create_directory(part);
    write_stack(part, 3, [&, n](int, TestImage& image) {
      image.series = numbered("1.2.3.4.", static_cast<int>(n));
      image.edit = [&, n](DcmDataset& d) {
        put(d, DCM_StudyInstanceUID, places[n].study);
        put(d, DCM_StudyDate, places[n].date);
        put(d, DCM_SeriesNumber, places[n].number);
      };
    });
  }
  std::vector<std::string> order;
  for (const Series& series : find_in(folder).series) order.push_back(series.uid.substr(8));
  EXPECT_THAT(order, ::testing::ElementsAre("0", "1", "2", "3", "4", "5"));
}

TEST(SeriesDetails, WhatIsSetApartHasAKind) {
  const TestFolder folder;
  write_stack(folder.path(), 3);
  std::ofstream(folder / "notes.txt") << "not DICOM";
  std::ofstream(folder / "empty.dcm").flush();
  // By PS3.6, table A-1.
  const std::array<std::array<const char*, 2>, 18> kinds{
      {{UID_XRayRadiationDoseSRStorage, "dose report"},
       {UID_EnhancedSRStorage, "structured report"},
       {UID_KeyObjectSelectionDocumentStorage, "key object note"},
       {UID_RTStructureSetStorage, "structure set"},
       {UID_RTPlanStorage, "treatment plan"},
       {UID_RTDoseStorage, "dose distribution"},
       {UID_SegmentationStorage, "segmentation"},
       {UID_SurfaceSegmentationStorage, "segmentation"},
       {UID_RawDataStorage, "raw data file"},
       {UID_SpatialRegistrationStorage, "registration"},
       {UID_DeformableSpatialRegistrationStorage, "registration"},
       {UID_GrayscaleSoftcopyPresentationStateStorage, "presentation state"},
       {UID_TwelveLeadECGWaveformStorage, "waveform"},
       {UID_HemodynamicWaveformStorage, "waveform"},
       {UID_SecondaryCaptureImageStorage, "screen capture"},
       {UID_MultiframeTrueColorSecondaryCaptureImageStorage, "screen capture"},
       {UID_ParametricMapStorage, "parametric map"},
       {UID_EncapsulatedPDFStorage, "document"}}};
  std::map<std::string, std::string> expected{
      {"notes.txt", "other file"}, {"empty.dcm", "damaged file"}, {"z", "copy"}, {"scout", "scout"}};
  for (const auto& kind : kinds) {
    TestImage report;
    report.series = kind[0];
    report.edit = [&](DcmDataset& d) {
      d.findAndDeleteElement(DCM_PixelData);
      put(d, DCM_SOPClassUID, kind[0]);
    };
    write(report, folder / kind[0]);
    expected[kind[0]] = kind[1];
  }
  TestImage scout;  // in the volume's series
  scout.edit = [](DcmDataset& d) {
    put(d, DCM_ImageType, "ORIGINAL\\PRIMARY\\LOCALIZER");
    put(d, DCM_ImageOrientationPatient, "1\\0\\0\\0\\0\\-1");
  };
  write(scout, folder / "scout");
  fs::copy_file(folder / "s1.dcm", folder / "z");
  std::map<std::string, std::string> found;
  for (const SkippedFile& file : find_in(folder).skipped) found[file.path.filename().string()] = file.kind;
  EXPECT_EQ(found, expected);
}

// Stored values are 100 k + 10 i + j; 0 to 20 are padding.
TEST(SeriesDetails, StatisticsWithoutPaddingAreOfTheOthers) {
  for (const bool by_slice : {false, true}) {  // one rescale for all, or one a slice (kept as floats)
    const TestFolder folder;
    write_stack(folder.path(), 3, [&](int k, TestImage& image) {
      image.edit = [=](DcmDataset& d) {
        put(d, DCM_PixelPaddingValue, 0);
        put(d, DCM_PixelPaddingRangeLimit, 20);
        put(d, DCM_RescaleSlope, by_slice && k == 2 ? "-2" : "-1");
        put(d, DCM_RescaleIntercept, "5");
      };
    });
    double least = 1e9, most = -1e9, sum = 0, least_of_all = 1e9, most_of_all = -1e9, sum_of_all = 0;
    int count = 0;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 6; ++i) {
          const int stored = 100 * k + 10 * i + j;
          const double value = (by_slice && k == 2 ? -2 : -1) * stored + 5;
          least_of_all = std::min(least_of_all, value);
          most_of_all = std::max(most_of_all, value);
          sum_of_all += value;
          if (stored <= 20) continue;
          least = std::min(least, value);
          most = std::max(most, value);
          sum += value;
          ++count;
        }
      }
    }
    const Volume volume = load(find_in(folder).series.at(0));
    const Statistics without = statistics_without_padding(volume);
    EXPECT_EQ(without.minimum, least);
    EXPECT_EQ(without.maximum, most);
    EXPECT_NEAR(without.mean, sum / count, 1e-9);
    EXPECT_EQ(without.count, static_cast<std::uint64_t>(count));
    if (by_slice) continue;  // padding has no value there
    const Statistics all = statistics(volume);
    EXPECT_EQ(all.minimum, least_of_all);
    EXPECT_EQ(all.maximum, most_of_all);
    EXPECT_NEAR(all.mean, sum_of_all / 72, 1e-9);
    EXPECT_EQ(all.count, 72U);
  }
}

}  // namespace
}  // namespace palpate::io::internal
