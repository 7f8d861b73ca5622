// Common to NIfTI, NRRD and MetaImage: their series, their place beside DICOM, labels, and damaged files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <set>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/load.h"
#include "io/series.h"
#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

// plastimatch reads and writes all three by ITK, which the reader here is independent of.
TEST(Interchange, PlastimatchPutsEveryVoxelToTheSamePlace) {
  if (std::system("command -v plastimatch >/dev/null 2>&1") != 0) GTEST_SKIP() << "plastimatch is not installed";
  const TestFolder folder;
  write_bytes(folder / "a.mha", meta_image(meta_place + "ElementDataFile = LOCAL\n") + voxels<std::int16_t>());
  for (const char* const name : {"b.nii", "b.nii.gz", "b.nrrd", "b.mhd"}) {
    SCOPED_TRACE(name);
    const std::string call = "plastimatch convert --input " + (folder / "a.mha").string() + " --output-img " +
                             (folder / name).string() + " >/dev/null 2>&1";
    ASSERT_EQ(std::system(call.c_str()), 0);
    expect_all(
        only_volume(folder / name), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
  }
}

TEST(Interchange, ASeriesSaysWhatItIsAndIsTheSameAnywhere) {
  const TestFolder folder, elsewhere;
  const std::string bytes = meta_image(meta_place + "ElementDataFile = LOCAL\n") + voxels<std::int16_t>();
  write_bytes(folder / "knee.mha", bytes);
  write_bytes(elsewhere / "other.mha", bytes);
  const Series series = find_series(std::array{folder.path()}).series.at(0);
  EXPECT_EQ(series.description, "knee.mha");
  EXPECT_EQ(series.modality, "OT") << "DICOM's word for what is not said";
  EXPECT_EQ(series.unit, "");
  EXPECT_EQ(series.details.orientation, "axial");
  EXPECT_THAT(series.warnings, Contains("the file does not say what its values are: compare them with a CT's before "
                                        "you trust a scene for CT"));
  EXPECT_TRUE(series.uid.starts_with("2.25."));
  EXPECT_EQ(series.uid, find_series(std::array{elsewhere.path()}).series.at(0).uid);
}

/// After each slice the part that is read; of some slices alone it begins and ends just so.
TEST(Interchange, TellsHowMuchIsReadAndStopsWhenItIsToldTo) {
  const TestFolder folder;
  write_bytes(folder / "a.mha", meta_image(meta_place + "ElementDataFile = LOCAL\n") + voxels<std::int16_t>());
  const Series series = find_series(std::array{folder.path()}).series.at(0);
  const int slices = load(series).geometry.dimensions.z;
  ASSERT_GT(slices, 3);
  std::vector<double> told;
  LoadOptions options;
  options.progress = [&](double part) {
    told.push_back(part);
    return true;
  };
  for (const LoadOptions::Range range : {LoadOptions::Range{0, slices}, LoadOptions::Range{1, slices - 2}}) {
    told.clear();
    options.slices = range;
    load(series, options);
    ASSERT_EQ(told.size(), static_cast<std::size_t>(range.count));
    for (std::size_t n = 0; n < told.size(); ++n) {
      EXPECT_DOUBLE_EQ(told[n], static_cast<double>(n + 1) / range.count);
    }
  }
  options.progress = [](double part) { return part < 0.5; };
  EXPECT_THROW(load(series, options), Cancelled);
}

/// Whichever way the file's slices go, packed or not, and of any of its volumes.
TEST(Interchange, SomeSlicesAreThoseOfTheWhole) {
  const TestFolder folder;
  const std::string data = voxels<std::int16_t>(false, 3);
  const auto three_volumes = [](const Rows& rows) {
    return Nifti().sform(rows).put<std::int16_t>(40, 4).put<std::int16_t>(48, 3).bytes();
  };
  const Rows in_the_plane{{{1, 0.4, 0, 5}, {0, 1, 0, 6}, {0, 0, -3, 7}}};  // i and k become the slices' axes
  write_bytes(folder / "upward.nii", three_volumes(oblique()) + data);
  write_bytes(folder / "downward.nii.gz", packed(three_volumes(flipped()) + data, 31));
  write_bytes(folder / "across.nii", three_volumes(in_the_plane) + data);
  write_bytes(folder / "downward.mha", meta_image(meta_place + "ElementDataFile = LOCAL\n") + data);
  for (const char* const name : {"upward.nii", "downward.nii.gz", "across.nii", "downward.mha"}) {
    const Series series = find_series(std::array{folder / name}).series.at(0);
    for (int frame = 0; frame < series.frames_per_position; ++frame) {
      const Volume whole = load(series, {.frame = frame});
      const int slices = whole.geometry.dimensions.z;
      for (int first = 0; first < slices; ++first) {
        for (int count = 1; count <= slices - first; ++count) {
          SCOPED_TRACE(::testing::Message() << name << ", frame " << frame << ": " << first << " + " << count);
          const Volume part = load(series, {.frame = frame, .slices = LoadOptions::Range{first, count}});
          ASSERT_EQ(part.geometry.dimensions,
                    glm::ivec3(whole.geometry.dimensions.x, whole.geometry.dimensions.y, count));
          for (int k = 0; k < count; ++k) {
            EXPECT_EQ(part.geometry.slice_positions[static_cast<std::size_t>(k)],
                      whole.geometry.slice_positions[static_cast<std::size_t>(first + k)]);
            for (int n = 0; n < part.geometry.dimensions.x * part.geometry.dimensions.y; ++n) {
              const int i = n % part.geometry.dimensions.x, j = n / part.geometry.dimensions.x;
              ASSERT_EQ(part.value_at(i, j, k), whole.value_at(i, j, first + k)) << i << ' ' << j << ' ' << k;
            }
          }
        }
      }
    }
  }
}

TEST(Interchange, WhatIsNotThereIsNamedByItsNumber) {
  const TestFolder folder;
  write_bytes(folder / "a.nii", Nifti().sform(oblique()).put<std::int16_t>(40, 4).put<std::int16_t>(48, 3).bytes() +
                                    voxels<std::int16_t>(false, 3));
  const Series series = find_series(std::array{folder / "a.nii"}).series.at(0);
  const auto refused = [&](const LoadOptions& options) -> std::string {
    try {
      load(series, options);
    } catch (const DicomError& error) {
      return error.what();
    }
    return "not refused";
  };
  for (const int frame : {-1, 3}) {
    EXPECT_EQ(refused({.frame = frame}),
              "series " + series.uid + " (a.nii) has frames 0 to 2, not " + std::to_string(frame));
  }
  for (const auto& [first, count] : {std::pair{-1, 2}, {0, 0}, {0, 6}, {3, 3}}) {
    EXPECT_EQ(refused({.slices = LoadOptions::Range{first, count}}),
              "series " + series.uid + " (a.nii) has slices 0 to 4, not " + std::to_string(count) + " from " +
                  std::to_string(first));
  }
}

TEST(Interchange, OneSliceAloneIsNoVolume) {
  for (const int slices : {1, 2}) {
    const TestFolder folder;
    write_bytes(folder / "a.nii",
                Nifti().sform(oblique()).put(46, static_cast<std::int16_t>(slices)).bytes() + voxels<std::int16_t>());
    const Series series = find_series(std::array{folder / "a.nii"}).series.at(0);
    EXPECT_EQ(series.geometry.dimensions.z, slices);
    EXPECT_EQ(series.usable, slices > 1);
  }
}

/// Of a file that is in two, both count.
TEST(Interchange, FilesThatDifferHaveOtherNames) {
  const TestFolder folder;
  const auto uid_of = [&](const std::string& header, const std::string& data) {
    write_bytes(folder / "a.mhd", meta_image(header + "ElementDataFile = a.raw\n"));
    write_bytes(folder / "a.raw", data);
    return find_series(std::array{folder / "a.mhd"}).series.at(0).uid;
  };
  std::string data = voxels<std::int16_t>();
  const std::string uid = uid_of(meta_place, data);
  EXPECT_NE(uid_of(meta_place + "Comment = another\n", data), uid);
  data.back() = static_cast<char>(data.back() + 1);
  EXPECT_NE(uid_of(meta_place, data), uid);
}

// Air may lie above the patient. A voxel in the first 60 KiB tells two scans apart.
TEST(Interchange, FilesThatDifferBehindMuchAirHaveOtherNames) {
  const TestFolder folder;
  std::string header = meta_image(meta_place + "ElementDataFile = a.raw\n");
  header.replace(header.find("4 3 5"), 5, "40 40 40");
  write_bytes(folder / "a.mhd", header);
  const std::string air(std::size_t{2} * 40 * 40 * 40, '\0');
  std::set<std::string> uids;
  const std::vector<std::size_t> places{0, 1000, 5000, 9000, 17'000, 33'000, 61'439};
  for (const std::size_t at : places) {
    std::string data = air;
    data[at] = '\1';
    write_bytes(folder / "a.raw", data);
    uids.insert(find_series(std::array{folder / "a.mhd"}).series.at(0).uid);
  }
  EXPECT_THAT(uids, SizeIs(places.size()));
}

// Beside a scan it is a map of it; alone and named it is what was meant.
TEST(Interchange, ALabelMapIsNoScanUnlessItIsNamed) {
  const TestFolder folder;
  write_stack(folder.path(), 4);
  write_bytes(folder / "liver.mha", meta_image(meta_place + "ElementDataFile = LOCAL\n") + labels());
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.series, SizeIs(1));
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_EQ(found.skipped[0].reason, "a label map: `palpate structures` lists what it outlines");
  EXPECT_EQ(found.skipped[0].kind, "label map");
  const Series named = find_series(std::array{folder / "liver.mha"}).series.at(0);
  EXPECT_THAT(named.warnings,
              Contains("its values look like labels and not like a scan: `palpate structures` lists them"));
  const StructureCatalogue structures = find_structures(std::array{folder / "liver.mha"});
  ASSERT_THAT(structures.structures, SizeIs(1));
  const StructureMeasures measures = measure(structures.structures[0]);
  EXPECT_EQ(measures.voxels, static_cast<std::uint64_t>(3 * nx * ny));
  EXPECT_NEAR(measures.volume_mm3, 3 * nx * ny * 0.5 * 2 * 3, 1e-6);
  EXPECT_NEAR(
      glm::length(measures.centroid_mm - 0.5 * (place_of(meta_rows, 0, 0, 2) + place_of(meta_rows, nx - 1, ny - 1, 4))),
      0, 1e-6);
}

TEST(Interchange, DicomComesFirstInAFolder) {
  const TestFolder folder;
  write_stack(folder.path(), 4);
  write_bytes(folder / "a.mha", meta_image(meta_place + "ElementDataFile = LOCAL\n") + voxels<std::int16_t>());
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(2));
  EXPECT_EQ(found.series[0].modality, "CT");
  EXPECT_EQ(found.series[1].description, "a.mha");
}

TEST(Interchange, LabelsInAnotherOrderOfAxesAreRefused) {
  const TestFolder folder;
  const Rows in_the_plane{{{1, 0.4, 0, 5}, {0, 1, 0, 6}, {0, 0, 3, 7}}};
  write_bytes(folder / "a.nii", Nifti().sform(in_the_plane).bytes() + labels());
  const StructureCatalogue found = find_structures(std::array{folder / "a.nii"});
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_EQ(found.skipped[0].reason,
            "its labels lie in an order of axes that is read only for scans: resample it on the scan");
}

/// As examples of NRRD have it.
TEST(Interchange, VoxelsBesideTheirHeaderMayBeNamedFromIt) {
  for (const char* const name : {"a.raw", "./a.raw", "././a.raw"}) {
    const TestFolder folder;
    write_bytes(folder / "a.mhd", meta_image(meta_place + "ElementDataFile = " + name + "\n"));
    write_bytes(folder / "a.raw", voxels<std::int16_t>());
    SCOPED_TRACE(name);
    expect_all(
        only_volume(folder / "a.mhd"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
  }
}

TEST(Interchange, IsRefusedInWords) {
  const std::string data = voxels<std::int16_t>();
  EXPECT_EQ(refusal_of("a.mha", meta_image(meta_place + "ElementDataFile = LOCAL\n") + data.substr(1)),
            "it ends before its last voxel: copy or export it again");
  EXPECT_EQ(refusal_of("a.mha", meta_image(meta_place + "BinaryData = False\nElementDataFile = LOCAL\n") + data),
            "it is no MetaImage of three or four dimensions in binary: save it as such");
  EXPECT_EQ(
      refusal_of("a.mha", meta_image(meta_place + "ElementNumberOfChannels = 3\nElementDataFile = LOCAL\n") + data),
      "it holds 3 values for each voxel: save one of them in a file of its own");
  for (const char* const other : {"../a.raw", "./../a.raw", "/etc/passwd", "LIST", "a%03d.raw", "absent.raw"}) {
    EXPECT_EQ(refusal_of("a.mhd", meta_image(meta_place + "ElementDataFile = " + other + "\n")),
              "its voxels are in several files, or in one that is not beside it: save header and voxels in one file");
  }
  EXPECT_EQ(
      refusal_of("a.nii",
                 Nifti().sform(oblique()).put<std::int16_t>(42, 30000).put<std::int16_t>(44, 30000).bytes() + data),
      "it has 30000 x 30000 x 5 voxels, which are too many: resample it");
}

// 1 MB that would come to 1 GB: limited as what comes out.
TEST(Interchange, ABombIsRefused) {
  Nifti header;
  header.sform(oblique()).put<std::int16_t>(42, 1024).put<std::int16_t>(44, 1024).put<std::int16_t>(46, 512);
  EXPECT_THAT(refusal_of("a.nii.gz", packed(header.bytes() + std::string(1U << 20, '\0'), 31)),
              HasSubstr("bytes are said to inflate to 1024 MiB"));
}

// Damaged in every byte of its header, it is read or refused, and nothing else.
TEST(Interchange, SurvivesEveryDamagedByte) {
  const TestFolder folder;
  const std::string mha = meta_image(meta_place + "ElementDataFile = LOCAL\n");
  const std::array<std::pair<std::string, std::string>, 2> files{
      std::pair{std::string("a.nii"), Nifti().sform(oblique()).bytes()}, std::pair{std::string("a.mha"), mha}};
  for (const auto& [name, head] : files) {
    for (std::size_t n = 0; n < head.size(); ++n) {
      for (const char value : {'9', '\xff'}) {
        std::string bad = head + voxels<std::int16_t>();
        bad[n] = value;
        write_bytes(folder / name, bad);
        for (const Series& series : find_series(std::array{folder / name}).series) {
          try {
            load(series);
          } catch (const DicomError&) {  // refused in words
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io::internal
