// Outlines as DICOM, read back by our reader and by DCMTK alone. outline_peers_test.cpp checks them with other
// programs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "io/archive/testing/says.h"
#include "io/errors.h"
#include "io/results/dicom_object.h"
#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/outlined_scan.h"
#include "io/testing/written_outline.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using internal::TestFolder;
using testing::expect_same_voxels;
using testing::full_label;
using testing::only_structure_in;
using testing::says;
using testing::scan_kind;
using testing::ScanKind;
using testing::Shape;
using testing::tag_text;

WriteOptions options() {
  return testing::by_test;
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const DicomError& error) {
    return error.what();
  }
  return "no refusal";
}

TEST(ReadBack, VoxelForVoxelOnEveryGrid) {
  testing::for_written(testing::scan_kinds(), [](const testing::WrittenShape& written, const Structure& read) {
    EXPECT_EQ(read.name, full_label().name);
    EXPECT_EQ(read.color, full_label().color);
    EXPECT_EQ(read.code, "SCT 10200004 Liver");
    EXPECT_EQ(read.frame_of_reference_uid, "1.2.3.9");
    EXPECT_EQ(read.study_uid, "1.2.3");
    EXPECT_EQ(read.patient_name, "Müller^Zoë");
    expect_same_voxels(written.image, read, written.kind.name != "tilted");
  });
}

/// The codes go through a file and back, and so do lists of references.
TEST(WriteSegmentation, KeepsWhatItsLabelSays) {
  const TestFolder folder;
  const Series scan = testing::write_scan(scan_kind("axial"), folder / "scan");
  const Shape ball = testing::shapes_in(scan.geometry).front();
  write_segmentation(sample_labels(full_label(), scan.geometry, ball.distance), scan, folder / "first.dcm", options());
  const StructureLabel read = label_of(only_structure_in(folder / "first.dcm"));
  EXPECT_EQ(read.name, full_label().name);
  EXPECT_EQ(read.color, full_label().color);
  EXPECT_EQ(read.category, full_label().category);
  EXPECT_EQ(read.type, full_label().type);
  EXPECT_EQ(read.modifiers, full_label().modifiers);
  EXPECT_EQ(read.tracking_id, full_label().tracking_id);
  EXPECT_EQ(read.tracking_uid, full_label().tracking_uid);
  ASSERT_TRUE(read.origin.has_value());

  // Corrected and written again: it refers to the first one.
  write_segmentation(sample_labels(read, scan.geometry, ball.distance), scan, folder / "second.dcm", options());
  DcmFileFormat first, second;
  ASSERT_TRUE(first.loadFile((folder / "first.dcm").c_str()).good());
  ASSERT_TRUE(second.loadFile((folder / "second.dcm").c_str()).good());
  DcmDataset& data = *second.getDataset();
  for (const DcmTagKey& own : {DCM_SOPInstanceUID, DCM_SeriesInstanceUID}) {
    EXPECT_NE(tag_text(*first.getDataset(), own), tag_text(data, own));
    EXPECT_FALSE(tag_text(data, own).empty());
  }
  EXPECT_EQ(tag_text(data, DCM_SegmentationType), "BINARY");
  EXPECT_EQ(tag_text(data, DCM_SpecificCharacterSet), "ISO_IR 192");
  EXPECT_EQ(tag_text(data, DCM_PatientID), "4711");
  EXPECT_EQ(tag_text(data, DCM_StudyDate), "20240229");
  DcmItem* item = nullptr;
  ASSERT_TRUE(data.findAndGetSequenceItem(DCM_SegmentSequence, item).good());
  EXPECT_EQ(tag_text(*item, DCM_SegmentAlgorithmType), "SEMIAUTOMATIC");
  ASSERT_TRUE(data.findAndGetSequenceItem(DCM_SourceImageSequence, item).good());
  EXPECT_EQ(tag_text(*item, DCM_ReferencedSOPInstanceUID), read.origin->instance);
  EXPECT_EQ(read.origin->instance, tag_text(*first.getDataset(), DCM_SOPInstanceUID));

  // All images and the corrected object, each once.
  std::set<std::string> referenced;
  for (signed long s = 0; data.findAndGetSequenceItem(DCM_ReferencedSeriesSequence, item, s).good(); ++s) {
    DcmItem* one = nullptr;
    for (signed long n = 0; item->findAndGetSequenceItem(DCM_ReferencedInstanceSequence, one, n).good(); ++n) {
      EXPECT_TRUE(referenced.insert(tag_text(*one, DCM_ReferencedSOPInstanceUID)).second);
    }
  }
  EXPECT_EQ(referenced.size(), scan.files.size() + 1);
  EXPECT_TRUE(referenced.contains(read.origin->instance));
  // A frame names the image on its slice.
  for (signed long f = 0; data.findAndGetSequenceItem(DCM_PerFrameFunctionalGroupsSequence, item, f).good(); ++f) {
    DcmItem *position = nullptr, *derivation = nullptr, *source = nullptr;
    ASSERT_TRUE(item->findAndGetSequenceItem(DCM_PlanePositionSequence, position).good());
    ASSERT_TRUE(item->findAndGetSequenceItem(DCM_DerivationImageSequence, derivation).good());
    ASSERT_TRUE(derivation->findAndGetSequenceItem(DCM_SourceImageSequence, source).good());
    const std::string instance = tag_text(*source, DCM_ReferencedSOPInstanceUID);
    bool found = false;
    for (const fs::path& file : scan.files) {
      DcmFileFormat image;
      ASSERT_TRUE(image.loadFile(file.c_str()).good());
      if (tag_text(*image.getDataset(), DCM_SOPInstanceUID) != instance) continue;
      found = true;
      Float64 there = 0, here = 1;
      image.getDataset()->findAndGetFloat64(DCM_ImagePositionPatient, there, 2);
      position->findAndGetFloat64(DCM_ImagePositionPatient, here, 2);
      EXPECT_NEAR(here, there, 1e-6);
    }
    EXPECT_TRUE(found) << f;
  }
}

/// Meanings in any letters, values that are too long for a short string, and URNs (PS3.3 8.1).
TEST(WriteSegmentation, KeepsEveryCode) {
  const TestFolder folder;
  const Series scan = testing::write_scan(scan_kind("axial"), folder / "scan");
  const Shape ball = testing::shapes_in(scan.geometry).front();
  const Code codes[] = {{"10200004", "SCT", "Liver"},
                        {"69748006", "SCT", "Glándula tiroides (Schilddrüse)"},
                        {"69748006", "SCT", "甲状腺"},
                        {"9999999999999999", "SCT", "of 16 figures"},
                        {"99999999999999999", "SCT", "of 17"},
                        {"900000000000000000000207008", "SCT", "甲状腺"},
                        {"urn:oid:1.2.3", "99TEST", "by a name"},
                        {"http://example.org/thyroid", "99TEST", "by an address"}};
  for (const Code& code : codes) {
    SCOPED_TRACE(code.value + " " + code.meaning);
    StructureLabel label = full_label();
    label.category = label.type = code;
    label.modifiers = {{"7771000", "SCT", "Left"}, code};
    write_segmentation(sample_labels(label, scan.geometry, ball.distance), scan, folder / "coded.dcm", options());
    const Structure written = only_structure_in(folder / "coded.dcm");
    EXPECT_EQ(written.code, code.scheme + " " + code.value + " " + code.meaning);
    const StructureLabel read = label_of(written);
    EXPECT_EQ(read.category, code);
    EXPECT_EQ(read.type, code);
    EXPECT_EQ(read.modifiers, label.modifiers);
    fs::remove(folder / "coded.dcm");
  }
}

TEST(ReadBack, ContoursWhereTheShapeIsOnEveryGrid) {
  for (const ScanKind& kind : testing::scan_kinds()) {
    const TestFolder folder;
    const Series scan = testing::write_scan(kind, folder / "scan");
    for (const Shape& shape : testing::shapes_in(scan.geometry)) {
      SCOPED_TRACE(kind.name + ", " + shape.name);
      const fs::path file = folder / (shape.name + ".dcm");
      write_contours(trace_slices(full_label(), scan.geometry, shape.distance), scan, file, options());
      const Structure read = only_structure_in(file);
      EXPECT_EQ(read.name, full_label().name);
      EXPECT_EQ(read.color, full_label().color);
      EXPECT_EQ(read.frame_of_reference_uid, "1.2.3.9");
      const StructureLabel label = label_of(read);
      EXPECT_EQ(label.type, full_label().type);
      EXPECT_EQ(label.category, full_label().category);
      EXPECT_EQ(label.interpreted_type, "ORGAN");
      EXPECT_TRUE(read.warnings.empty() || kind.name == "uneven" || kind.name == "slices missing")
          << read.warnings.front();
      EXPECT_TRUE(measure(read).warnings.empty()) << "one slice says how thick it is";
      if (shape.name == "shell and ball") continue;  // finer than the millimeter of the field's lattice
      DistanceOptions distance;
      distance.scan = &scan.geometry;
      const auto field = load_distance(read, distance);
      const glm::ivec3& n = scan.geometry.dimensions;
      for (int k = 0; k < n.z; ++k) {
        for (int j = 0; j < n.y; ++j) {
          for (int i = 0; i < n.x; ++i) {
            const Vec3 at = scan.geometry.to_patient(Vec3(i, j, k));
            const double truth = shape.distance(at);
            constexpr double chord_mm = 0.15;  // of a circle of 1.6 mm between nodes 0.625 mm apart
            if (std::abs(truth) < chord_mm) continue;
            EXPECT_EQ(field->sample(at).mm > 0, truth > 0) << i << ' ' << j << ' ' << k << ": " << truth;
          }
        }
      }
    }
  }
}

TEST(WriteStructure, RefusesInWordsAndLeavesNothing) {
  const TestFolder folder;
  const Series scan = testing::write_scan(scan_kind("uneven"), folder / "scan");
  const SignedDistance none = [](const Vec3&) { return -1.0; };
  const Shape ball = testing::shapes_in(scan.geometry).front();
  StructureLabel label = full_label();
  const auto write = [&](const SignedDistance& distance, const std::string& name, bool rtstruct) {
    return refusal([&] {
      const StructureForm form = form_of(name, rtstruct);
      write_structure(label, scan, scan.geometry, distance, {}, form, folder / name, options());
    });
  };
  const char* const empty = "\"{}\" is empty on this scan, no voxel is inside: nothing is written";
  EXPECT_TRUE(says(write(none, "a.dcm", false), empty));
  EXPECT_TRUE(says(write(none, "a.dcm", true), empty));
  EXPECT_TRUE(says(write(none, "a.nii", false), empty));
  for (const char* const name : {"a.nii", "a.nii.gz", "a.nrrd", "a.seg.nrrd", "a.mha"}) {
    EXPECT_TRUE(says(write(ball.distance, name, false),
                     "{} can hold only slices at equal distances, and the scan's slices are uneven: write .dcm"));
  }
  EXPECT_TRUE(says(write(ball.distance, "a.stl", false), "{} has no known file name extension: use .dcm or one of {}"));
  EXPECT_TRUE(
      says(write(ball.distance, "a.mha", true),
           "contours (RTSTRUCT) are written only as DICOM, and {} is not a DICOM name: use the extension .dcm"));
  Series elsewhere = scan;
  elsewhere.source = nullptr;
  EXPECT_TRUE(says(refusal([&] {
                     write_segmentation(sample_labels(label, scan.geometry, ball.distance), elsewhere, folder / "a.dcm",
                                        options());
                   }),
                   "the scan is no DICOM, so there is no study that the outline could go into: write one of {}"));
  WriteOptions nameless = options();
  nameless.software_version.clear();
  EXPECT_TRUE(says(refusal([&] {
                     write_segmentation(sample_labels(label, scan.geometry, ball.distance), scan, folder / "a.dcm",
                                        nameless);
                   }),
                   "the outline cannot be made: {}"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1) << "the scan alone";

  ASSERT_EQ(write(ball.distance, "a.dcm", false), "no refusal");
  EXPECT_TRUE(
      says(write(ball.distance, "a.dcm", false), "{} exists: name another file, or ask for it to be overwritten"));
  label = label_of(only_structure_in(folder / "a.dcm"));
  WriteOptions over = options();
  over.overwrite = true;
  EXPECT_TRUE(says(refusal([&] {
                     write_structure(label, scan, scan.geometry, ball.distance, {}, StructureForm::contours,
                                     folder / "a.dcm", over);
                   }),
                   "{} is the outline that was corrected, and is kept: name another file"));
  const fs::path image = scan.files.at(scan.files.size() / 2);
  const auto bytes = internal::bytes_of(image);
  EXPECT_TRUE(says(refusal([&] {
                     write_structure(label, scan, scan.geometry, ball.distance, {}, StructureForm::segmentation, image,
                                     over);
                   }),
                   "{} is an image of the scan, and is kept: name another file"));
  EXPECT_EQ(internal::bytes_of(image), bytes);
  label.origin.reset();
  write_structure(label, scan, scan.geometry, ball.distance, {}, StructureForm::contours, folder / "a.dcm", over);
  EXPECT_EQ(only_structure_in(folder / "a.dcm").kind, StructureKind::contours);
}

}  // namespace
}  // namespace palpate::io
