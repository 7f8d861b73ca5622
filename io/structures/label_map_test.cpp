// Label maps that are not DICOM: their positions by the standards' formulas, their names, and refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "io/errors.h"
#include "io/structures/structure.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;

fs::path fresh_folder() {
  fs::path folder = fs::path(::testing::TempDir()) / ("label_maps-" + std::to_string(::getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

fs::path write(const std::string& name, const std::string& bytes) {
  fs::path file = fresh_folder() / name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

/// 3 x 2 x 2 voxels of one byte: label 7 in the first voxel of the first slice, label 9 in the last voxel of the last.
const std::string voxels{"\7\0\0\0\0\0\0\0\0\0\0\11", 12};

class Nifti {
 public:
  Nifti() {
    put<std::int32_t>(0, 348);
    const std::array<std::int16_t, 8> size{3, 3, 2, 2, 1, 1, 1, 1};
    for (std::size_t n = 0; n < 8; ++n) put(40 + 2 * n, size[n]);
    put<std::int16_t>(70, 2);
    put<std::int16_t>(72, 8);
    const std::array<float, 4> spacing{1, 2, 3, 4};  // the first is the hand of the qform
    for (std::size_t n = 0; n < 4; ++n) put(76 + 4 * n, spacing[n]);
    put<float>(108, 352);
    put<std::uint8_t>(123, 2);
    put<std::int16_t>(252, 1);
    bytes_.replace(344, 3, "n+1");
  }
  template <typename T>
  Nifti& put(std::size_t at, T value) {
    std::memcpy(bytes_.data() + at, &value, sizeof value);
    return *this;
  }
  fs::path written(const std::string& name = "labels.nii") const { return write(name, bytes_ + voxels); }
  std::string start() const { return bytes_; }

 private:
  std::string bytes_ = std::string(352, '\0');
};

StructureMeasures measured(const fs::path& file, int number) {
  for (const Structure& structure : find_structures(std::array{file}).structures) {
    if (structure.number == number) return measure(structure);
  }
  ADD_FAILURE() << "no label " << number << " in " << file;
  return {};
}

void expect_at(const fs::path& file, int number, const Vec3& place) {
  const StructureMeasures measures = measured(file, number);
  EXPECT_EQ(measures.voxels, 1U);
  EXPECT_NEAR(measures.volume_mm3, 2 * 3 * 4, 1e-4);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(measures.centroid_mm[axis], place[axis], 1e-4) << axis;
}

// Without a turn RAS is what the file says: to LPS, x and y change their signs.
TEST(LabelMap, LiesWhereTheQformSays) {
  Nifti file;
  file.put<float>(268, 10).put<float>(272, 20).put<float>(276, 30);
  expect_at(file.written(), 7, {-10, -20, 30});
  expect_at(file.written(), 9, {-10 - 2 * 2, -20 - 3, 30 + 4});
  // Half a turn about the x axis: y and z point the other way.
  file.put<float>(256, 1);
  expect_at(file.written(), 9, {-10 - 2 * 2, -20 + 3, 30 - 4});
}

TEST(LabelMap, BelievesTheSformFirst) {
  Nifti file;
  file.put<std::int16_t>(254, 1);
  const float rows[3][4] = {{0, 3, 0, 1}, {2, 0, 0, 2}, {0, 0, -4, 3}};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) file.put(280 + 16 * row + 4 * column, rows[row][column]);
  }
  expect_at(file.written(), 7, {-1, -2, 3});
  expect_at(file.written(), 9, {-1 - 3, -2 - 4, 3 - 4});
}

/// 4 x 5 x 6 voxels of 1 mm around a place.
Geometry scan_around(const Vec3& place) {
  Geometry scan;
  scan.dimensions = {4, 5, 6};
  for (int k = 0; k < 6; ++k) scan.slice_positions.push_back(place + Vec3(-1.5, -2, k - 2.5));
  return scan;
}

// Label 9 lies at -14, -23, 34 mm.
TEST(LabelMap, IsOffAScanThatHasNoneOfIt) {
  Nifti file;
  file.put<float>(268, 10).put<float>(272, 20).put<float>(276, 30);
  Structure nine = find_structures(std::array{file.written()}).structures.at(1);
  const Vec3 place(-14, -23, 34);
  const StructureBox box = box_of(nine);
  EXPECT_EQ(box.low_mm, place);
  EXPECT_EQ(box.high_mm, place);
  EXPECT_FALSE(is_off(box, scan_around(place)));
  const Vec3 half(2, 2.5, 3);  // of the scan: its outermost voxels end there
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      SCOPED_TRACE(axis * side);
      Vec3 away(0);
      away[axis] = side * (half[axis] + 0.4);
      EXPECT_FALSE(is_off(box, scan_around(place + away)));
      away[axis] = side * (half[axis] + 0.6);
      EXPECT_TRUE(is_off(box, scan_around(place + away)));
    }
  }
  nine.motion.shift = {100, 0, 0};
  EXPECT_TRUE(is_off(box_of(nine), scan_around(place)));
  EXPECT_FALSE(is_off(box_of(nine), scan_around(place + Vec3(100, 0, 0))));
}

// 4 x 3 x 2 voxels of 2 x 3 x 4 mm in RAS, of 16 bits: label 40000 in two of them, 65535 in all others.
TEST(LabelMap, OfSixteenBitsHasTheBoxOfItsVoxels) {
  std::string numbers;
  for (int n = 0; n < 24; ++n) {
    const bool inside = n == 1 + 4 * 1 || n == 2 + 4 * 2 + 12;
    numbers += inside ? "\x40\x9c" : "\xff\xff";
  }
  Nifti file;
  file.put<std::int16_t>(42, 4).put<std::int16_t>(44, 3).put<std::int16_t>(46, 2).put<std::int16_t>(70, 512);
  file.put<std::int16_t>(72, 16);
  const StructureCatalogue found = find_structures(std::array{write("labels.nii", file.start() + numbers)});
  ASSERT_EQ(found.structures.size(), 2U);
  EXPECT_EQ(found.structures[0].number, 40000);
  EXPECT_EQ(found.structures[1].number, 65535);
  const StructureBox box = box_of(found.structures[0]);
  EXPECT_EQ(box.low_mm, Vec3(-4, -6, 0));
  EXPECT_EQ(box.high_mm, Vec3(-2, -3, 4));
  EXPECT_EQ(measure(found.structures[0]).voxels, 2U);
  EXPECT_EQ(measure(found.structures[1]).voxels, 22U);
}

TEST(LabelMap, HasTheNamesThatSlicerWrites) {
  const fs::path file =
      write("labels.seg.nrrd",
            "NRRD0004\n# Slicer's\ntype: uint8\ndimension: 3\nspace: right-anterior-superior\nsizes: 3 2 "
            "2\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nendian: little\nencoding: raw\nspace origin: "
            "(1,2,3)\nSegment0_Name:=left kidney\nSegment0_LabelValue:=9\nSegment0_Color:=1 0.5 0\n\n" +
                voxels);
  const StructureCatalogue found = find_structures(std::array{file});
  ASSERT_EQ(found.structures.size(), 2U);
  EXPECT_EQ(found.structures[0].name, "label 7");
  EXPECT_EQ(found.structures[1].name, "left kidney");
  EXPECT_EQ(found.structures[1].color, "#ff8000");
  EXPECT_EQ(found.structures[1].kind, StructureKind::label_map);
  expect_at(file, 9, {-1 - 4, -2 - 3, 3 + 4});
}

/// Two layers of 3 x 2 x 2 voxels, one number of each side by side: label 1 in the first two voxels of the first layer
/// and label 1 in the second and third of the second one, label 2 in the last.
const std::string layered_voxels{
    "\1\0\1\1\0\1"
    "\0\0\0\0\0\0"
    "\0\0\0\0\0\0"
    "\0\0\0\0\0\2",
    24};

std::string layered(const std::string& more) {
  return "NRRD0004\ntype: uint8\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 3 2 2\nspace directions: none "
         "(2,0,0) (0,3,0) (0,0,4)\nkinds: list domain domain domain\nencoding: raw\nspace origin: (1,2,3)\n" +
         more + "\n" + layered_voxels;
}

// As Slicer writes segments that overlap.
TEST(LabelMap, OfSeveralLayersOverlaps) {
  const fs::path file =
      write("layers.seg.nrrd", layered("Segment0_Name:=liver\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
                                       "Segment1_Name:=tumor\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n"
                                       "Segment2_Name:=vein\nSegment2_LabelValue:=2\nSegment2_Layer:=1\n"));
  const StructureCatalogue found = find_structures(std::array{file});
  ASSERT_EQ(found.structures.size(), 3U) << (found.skipped.empty() ? Text() : found.skipped.front().reason);
  const std::array<const char*, 3> names{"liver", "tumor", "vein"};
  const std::array<std::uint64_t, 3> voxels_of{2, 2, 1};
  const std::array centroids{Vec3(2, 2, 3), Vec3(4, 2, 3), Vec3(5, 5, 7)};
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(found.structures[n].name, names[n]);
    const StructureMeasures measures = measure(found.structures[n]);
    EXPECT_EQ(measures.voxels, voxels_of[n]);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(measures.centroid_mm[axis], centroids[n][axis], 1e-9) << names[n];
  }
  EXPECT_EQ(found.structures[0].number, 1);
  // The second voxel belongs to both.
  const auto liver = load_distance(found.structures[0]), tumor = load_distance(found.structures[1]);
  EXPECT_GT(liver->sample({3, 2, 3}).mm, 0);
  EXPECT_GT(tumor->sample({3, 2, 3}).mm, 0);
  EXPECT_LT(liver->sample({5, 2, 3}).mm, 0);
  EXPECT_LT(tumor->sample({1, 2, 3}).mm, 0);
}

// Where the voxels are what a file ends with, the numbers of all layers count; and a segment that names no label is
// numbered by its place.
TEST(LabelMap, OfSeveralLayersMayEndAFileOfTheirOwn) {
  const fs::path folder = fresh_folder();
  std::string header = layered(
      "Segment0_Name:=liver\nSegment0_Layer:=0\nSegment1_Name:=vein\nSegment1_Layer:=1\n"
      "byte skip: -1\ndata file: layers.raw\n");
  header.resize(header.size() - layered_voxels.size());
  std::ofstream(folder / "layers.nhdr", std::ios::binary) << header;
  std::ofstream(folder / "layers.raw", std::ios::binary)
      << "what comes before them, and is longer than they are" << layered_voxels;
  const StructureCatalogue found = find_structures(std::array{folder / "layers.nhdr"});
  ASSERT_EQ(found.structures.size(), 3U);
  EXPECT_EQ(found.structures[0].name, "liver") << "1 in the first layer";
  EXPECT_EQ(measure(found.structures[0]).voxels, 2U);
  EXPECT_NE(found.structures[1].name, "vein") << "1 in the second layer";
  EXPECT_EQ(measure(found.structures[1]).voxels, 2U);
  EXPECT_EQ(found.structures[2].name, "vein") << "2 in the second layer";
  EXPECT_EQ(measure(found.structures[2]).voxels, 1U);
}

TEST(LabelMap, OfSeveralLayersIsNoScan) {
  const fs::path file = write("layers.seg.nrrd", layered("Segment0_Name:=liver\nSegment0_Layer:=0\n"));
  const Catalogue found = find_series(std::array{file});
  EXPECT_TRUE(found.series.empty());
  ASSERT_EQ(found.skipped.size(), 1U);
  EXPECT_EQ(found.skipped.front().reason, "it holds 2 values for each voxel: save one of them in a file of its own");
}

TEST(LabelMap, ASegmentThatIsNamedAndNotOutlinedIsListedAndRefused) {
  const fs::path file =
      write("layers.seg.nrrd", layered("Segment0_Name:=liver\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
                                       "Segment1_Name:=spleen\nSegment1_LabelValue:=5\nSegment1_Layer:=0\n"));
  const StructureCatalogue found = find_structures(std::array{file});
  const auto spleen = std::ranges::find(found.structures, "spleen", &Structure::name);
  ASSERT_NE(spleen, found.structures.end());
  EXPECT_EQ(spleen->number, 5);
  try {
    measure(*spleen);
    FAIL() << "was measured";
  } catch (const DicomError& error) {
    EXPECT_THAT(error.what(),
                ::testing::EndsWith("layers.seg.nrrd: label map \"spleen\" (5) cannot be felt: it is empty: "
                                    "no voxel is inside"));
  }
}

std::string refusal_of(const fs::path& file) {
  const StructureCatalogue found = find_structures(std::array{file});
  EXPECT_TRUE(found.structures.empty());
  return found.skipped.empty() ? std::string("not refused") : std::string(found.skipped.front().reason);
}

std::string nrrd(const std::string& fields) {
  return "NRRD0004\n" + fields + "\n" + voxels;
}

const std::string placed =
    "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n";

TEST(LabelMap, IsRefusedInWords) {
  EXPECT_EQ(refusal_of(Nifti().put<std::int16_t>(252, 0).written()),
            "it does not say where it lies in the patient (neither sform nor qform): save it with its place");
  EXPECT_EQ(refusal_of(Nifti().put<std::int32_t>(0, 540).written()),
            "it is no NIfTI-1 or NIfTI-2 file with header and voxels in one: save it as such");
  EXPECT_EQ(refusal_of(Nifti().put<std::int16_t>(40, 4).put<std::int16_t>(48, 5).written()),
            "it holds several volumes: save each in a file of its own");
  EXPECT_EQ(refusal_of(Nifti().put<std::int16_t>(70, 32).written()),
            "its voxels are of a type that is not read: save it as numbers of 8 to 64 bits");
  EXPECT_EQ(refusal_of(Nifti().put<std::int16_t>(46, 3).written()),
            "it ends before its last voxel: copy or export it again");
  EXPECT_EQ(
      refusal_of(Nifti().put<std::int16_t>(42, -1).written()),
      "its voxels are on no lattice that can be felt (no size, or axes that are sheared): resample it with axes at "
      "right angles");
  EXPECT_EQ(refusal_of(write("a.nrrd", nrrd("type: uint8\nsizes: 3 2 2\nencoding: lzma\n" + placed))),
            "its encoding \"lzma\" is not read; there are: raw, gzip, bzip2, ascii, hex");
  EXPECT_EQ(refusal_of(write("a.nrrd", nrrd("type: uint8\nsizes: 3 2 2\nencoding: raw\ndata file: b.raw\n" + placed))),
            "its voxels are in several files, or in one that is not beside it: save header and voxels in one file");
  EXPECT_EQ(refusal_of(write("a.nrrd", nrrd("type: uint8\nsizes: 3 2 2\nencoding: raw\n"))),
            "it does not say where it lies in the patient (its space is not LPS, RAS or LAS): save it with its place");
}

// Damaged in every byte of its header, it is read or refused, and nothing else.
TEST(LabelMap, SurvivesEveryDamagedByte) {
  const std::string good = Nifti().start() + voxels;
  for (std::size_t n = 0; n < 352; ++n) {
    for (const char value : {'\x00', '\x7f', '\xff'}) {
      std::string bad = good;
      bad[n] = value;
      const StructureCatalogue found = find_structures(std::array{write("labels.nii", bad)});
      for (const Structure& structure : found.structures) {
        try {
          measure(structure);
        } catch (const std::exception&) {  // refused in words
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
