// What a written outline refers to: its images, each in its series, and the outline that was corrected.

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>

#include "io/results/dicom_object.h"
#include "io/structures/structure.h"
#include "io/testing/outlined_scan.h"
#include "io/testing/written_outline.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using internal::TestFolder;
using testing::expect_same_voxels;
using testing::full_label;
using testing::only_structure_in;
using testing::scan_kind;
using testing::Shape;
using testing::tag_text;

/// A volume may be joined from several series: each image is referred to in its own.
TEST(WriteStructure, RefersToEachImageInItsSeries) {
  const TestFolder folder;
  const Series scan = testing::write_scan(scan_kind("axial"), folder / "scan");
  std::map<std::string, std::string> series_of;
  for (std::size_t n = 0; n < scan.files.size(); ++n) {
    DcmFileFormat file;
    ASSERT_TRUE(file.loadFile(scan.files[n].c_str()).good());
    ASSERT_TRUE(file.loadAllDataIntoMemory().good());
    file.getDataset()->putAndInsertString(DCM_SeriesInstanceUID, n % 3 == 0 ? "1.2.77" : "1.2.78");
    ASSERT_TRUE(file.saveFile(scan.files[n].c_str()).good());
    series_of[tag_text(*file.getDataset(), DCM_SOPInstanceUID)] = tag_text(*file.getDataset(), DCM_SeriesInstanceUID);
  }
  const Shape ball = testing::shapes_in(scan.geometry).front();
  StructureLabel label = full_label();
  label.origin.reset();
  write_segmentation(sample_labels(label, scan.geometry, ball.distance), scan, folder / "seg.dcm", testing::by_test);
  write_contours(trace_slices(label, scan.geometry, ball.distance), scan, folder / "rt.dcm", testing::by_test);
  const auto referred = [](DcmItem& in, const DcmTagKey& all, const DcmTagKey& images) {
    std::map<std::string, std::string> found;
    DcmItem *series = nullptr, *image = nullptr;
    for (long s = 0; in.findAndGetSequenceItem(all, series, s).good(); ++s) {
      for (long n = 0; series->findAndGetSequenceItem(images, image, n).good(); ++n) {
        found[tag_text(*image, DCM_ReferencedSOPInstanceUID)] = tag_text(*series, DCM_SeriesInstanceUID);
      }
    }
    return found;
  };
  DcmFileFormat seg, rt;
  ASSERT_TRUE(seg.loadFile((folder / "seg.dcm").c_str()).good());
  EXPECT_EQ(referred(*seg.getDataset(), DCM_ReferencedSeriesSequence, DCM_ReferencedInstanceSequence), series_of);
  ASSERT_TRUE(rt.loadFile((folder / "rt.dcm").c_str()).good());
  DcmItem *frame = nullptr, *study = nullptr;
  ASSERT_TRUE(rt.getDataset()->findAndGetSequenceItem(DCM_ReferencedFrameOfReferenceSequence, frame).good());
  ASSERT_TRUE(frame->findAndGetSequenceItem(DCM_RTReferencedStudySequence, study).good());
  EXPECT_EQ(referred(*study, DCM_RTReferencedSeriesSequence, DCM_ContourImageSequence), series_of);
}

/// A frame of a multi-frame file is referred to by its number.
TEST(WriteSegmentation, RefersToFramesOfOneFile) {
  const TestFolder folder;
  fs::create_directories(folder / "scan");
  internal::TestImage image;
  const std::vector<double> heights{0, 2, 4, 6};
  image.edit = [&](DcmDataset& data) {
    internal::put(data, DCM_FrameOfReferenceUID, "1.2.3.9");
    internal::make_multi_frame(data, heights);
    internal::repeat_pixels(data, heights.size());
  };
  internal::write(image, folder / "scan" / "all.dcm");
  const Series scan = find_series(std::array{folder / "scan"}).series.at(0);
  ASSERT_EQ(scan.geometry.dimensions.z, 4);
  const LabelImage label = sample_labels(full_label(), scan.geometry, [](const Vec3& at) { return at.z - 1; });
  write_segmentation(label, scan, folder / "seg.dcm", testing::by_test);
  expect_same_voxels(label, only_structure_in(folder / "seg.dcm"), true);
  DcmFileFormat format;
  ASSERT_TRUE(format.loadFile((folder / "seg.dcm").c_str()).good());
  DcmItem *item = nullptr, *derivation = nullptr, *source = nullptr;
  std::vector<std::string> numbers;
  for (signed long f = 0;
       format.getDataset()->findAndGetSequenceItem(DCM_PerFrameFunctionalGroupsSequence, item, f).good(); ++f) {
    ASSERT_TRUE(item->findAndGetSequenceItem(DCM_DerivationImageSequence, derivation).good());
    ASSERT_TRUE(derivation->findAndGetSequenceItem(DCM_SourceImageSequence, source).good());
    numbers.push_back(tag_text(*source, DCM_ReferencedFrameNumber));
  }
  EXPECT_EQ(numbers, (std::vector<std::string>{"2", "3", "4"}));
}

/// Contours are felt where the shape is, but for what a straight line between lattice nodes leaves out. What they fill
/// on each slice, holes too, is looked at by other programs: outline_peers_test.cpp.
TEST(WriteContours, RefersToWhatWasCorrected) {
  const TestFolder folder;
  const Series scan = testing::write_scan(scan_kind("oblique"), folder / "scan");
  const Shape ball = testing::shapes_in(scan.geometry).front();
  write_contours(trace_slices(full_label(), scan.geometry, ball.distance), scan, folder / "first.dcm",
                 testing::by_test);
  const StructureLabel read = label_of(only_structure_in(folder / "first.dcm"));
  write_contours(trace_slices(read, scan.geometry, ball.distance), scan, folder / "second.dcm", testing::by_test);
  DcmFileFormat format;
  ASSERT_TRUE(format.loadFile((folder / "second.dcm").c_str()).good());
  DcmItem *item = nullptr, *study = nullptr, *series = nullptr, *image = nullptr;
  for (const DcmTagKey& key : {DCM_PredecessorStructureSetSequence, DCM_SourceInstanceSequence}) {
    ASSERT_TRUE(format.getDataset()->findAndGetSequenceItem(key, item).good());
    EXPECT_EQ(tag_text(*item, DCM_ReferencedSOPInstanceUID), read.origin->instance);
  }
  ASSERT_TRUE(format.getDataset()->findAndGetSequenceItem(DCM_ReferencedFrameOfReferenceSequence, item).good());
  ASSERT_TRUE(item->findAndGetSequenceItem(DCM_RTReferencedStudySequence, study).good());
  ASSERT_TRUE(study->findAndGetSequenceItem(DCM_RTReferencedSeriesSequence, series).good());
  std::size_t images = 0;
  while (series->findAndGetSequenceItem(DCM_ContourImageSequence, image, static_cast<signed long>(images)).good()) {
    ++images;
  }
  EXPECT_EQ(images, scan.files.size());
}

}  // namespace
}  // namespace palpate::io
