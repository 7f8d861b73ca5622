// NRRD: every voxel at the position of its directions, for each space with named axes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"
#include "solver/text/printable.h"

namespace palpate::io::internal {
namespace {

std::string nrrd(const std::string& fields) {
  return "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 3 5\nendian: little\n" + fields + "\n";
}

TEST(Nrrd, LiesWhereItsDirectionsSay) {
  struct Space {
    const char* name;
    Vec3 to_lps;
  };
  for (const Space& space : {Space{"left-posterior-superior", {1, 1, 1}}, Space{"RAS", {-1, -1, 1}},
                             Space{"left-anterior-superior", {1, -1, 1}}}) {
    const std::string fields = std::string("space: ") + space.name +
                               "\nspace directions: (0,0,-2) (0,3,0) (1.5,0.25,0)\nspace origin: (10,20,30)\n";
    const Rows rows{{{0, 0, 1.5, 10}, {0, 3, 0.25, 20}, {-2, 0, 0, 30}}};
    const auto lps = [&](int a, int b, int c) { return space.to_lps * place_of(rows, a, b, c); };
    const TestFolder folder;
    const std::string data = voxels<std::int16_t>();
    write_bytes(folder / "raw.nrrd", nrrd(fields + "encoding: raw\n") + data);
    write_bytes(folder / "gz.nrrd", nrrd(fields + "encoding: gzip\n") + packed(data, 31));
    write_bytes(folder / "apart.nhdr", nrrd(fields + "encoding: raw\nbyte skip: 6\ndata file: apart.raw\n"));
    write_bytes(folder / "apart.raw", "before" + data);
    write_bytes(folder / "end.nhdr", nrrd(fields + "encoding: raw\nbyte skip: -1\ndata file: apart.raw\n"));
    for (const char* const name : {"raw.nrrd", "gz.nrrd", "apart.nhdr", "end.nhdr"}) {
      SCOPED_TRACE(name);
      expect_all(only_volume(folder / name), lps, stored);
    }
  }
}

TEST(Nrrd, WhatIsToBeSkippedOtherwiseIsRefused) {
  const TestFolder folder;
  const std::string place = "space: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n";
  const std::string why =
      "its encoding \"raw with lines or packed bytes to be skipped\" is not read; there are: raw, gzip, bzip2, ascii, "
      "hex";
  const std::string data = voxels<std::int16_t>();
  for (const std::string fields :
       {"encoding: raw\nline skip: 1\n", "encoding: raw\nlineskip: 2\n", "encoding: raw\nbyte skip: -2\n"}) {
    EXPECT_EQ(refusal_of("a.nrrd", nrrd(place + fields) + data), why) << fields;
  }
  EXPECT_EQ(refusal_of("a.nrrd", nrrd(place + "encoding: gzip\nbyteskip: 3\n") + packed(data, 31)), why);
  EXPECT_EQ(refusal_of("a.nrrd", nrrd(place + "encoding: gzip\nbyteskip: -1\n") + packed(data, 31)), why);
}

/// Names in Latin-1 are letters; what is UTF-8 stays it.
TEST(Nrrd, SegmentsHaveNamesInUtf8) {
  const TestFolder folder;
  const std::string place =
      "space: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n";
  write_bytes(folder / "a.seg.nrrd",
              nrrd(place + "Segment0_Name:=L\xe4sion\nSegment0_LabelValue:=1\nSegment1_Name:=L\xc3\xa4ppchen\n"
                           "Segment1_LabelValue:=2\n") +
                  std::string(120, '\1'));
  std::vector<std::string> names;
  for (const Structure& structure : find_structures(std::vector{folder / "a.seg.nrrd"}).structures)
    names.push_back(structure.name);
  EXPECT_THAT(names, ::testing::Contains("L\u00e4sion"));
  for (const std::string& name : names) EXPECT_EQ(printable(name), name);
}

}  // namespace
}  // namespace palpate::io::internal
