// What the header of NRRD may say, field by field, and what of it is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/load.h"
#include "io/series.h"
#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Lines of a header, of which each can be replaced or left out.
std::string nrrd_but(const std::string& name, const std::string& line) {
  std::string text = "NRRD0005\n";
  for (const auto& [field, value] :
       std::vector<std::pair<std::string, std::string>>{{"type", "short"},
                                                        {"dimension", "3"},
                                                        {"sizes", "4 3 5"},
                                                        {"endian", "little"},
                                                        {"encoding", "raw"},
                                                        {"space", "left-posterior-superior"},
                                                        {"space directions", "(1,0,0) (0,2,0) (0,0,3)"},
                                                        {"space origin", "(-4,5,6)"}}) {
    if (field != name) text.append(field).append(": ").append(value).append("\n");
  }
  return text + line + "\n";
}

Vec3 place_in_nrrd(int a, int b, int c) {
  return {a - 4, 2 * b + 5, 3 * c + 6};
}

void expect_nrrd(const std::string& header, const Vec3& by = Vec3(1), bool big = false) {
  const TestFolder folder;
  write_bytes(folder / "a.nrrd", header + voxels<std::int16_t>(big));
  expect_all(
      only_volume(folder / "a.nrrd"), [&](int a, int b, int c) { return by * place_in_nrrd(a, b, c); }, stored);
}

const std::string no_place =
    "it does not say where it lies in the patient (its space is not LPS, RAS or LAS): save it with its place";

/// Of each axis of the space its own unit.
TEST(NrrdHeader, EveryUnitHasItsLength) {
  const std::vector<std::pair<std::string, double>> units{{"mm", 1},
                                                          {"millimeter", 1},
                                                          {"millimeters", 1},
                                                          {"um", 1e-3},
                                                          {"micron", 1e-3},
                                                          {"microns", 1e-3},
                                                          {"micrometer", 1e-3},
                                                          {"micrometers", 1e-3},
                                                          {"\u00b5m", 1e-3},
                                                          {"\u03bcm", 1e-3},
                                                          {"nm", 1e-6},
                                                          {"cm", 10},
                                                          {"m", 1000},
                                                          {"meter", 1000},
                                                          {"meters", 1000},
                                                          {"MILLIMETER", 1},
                                                          {" mm ", 1},
                                                          {"", 1}};
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& [unit, mm] : units) {
      std::array<std::string, 3> words{"\"mm\"", "\"mm\"", "\"mm\""};
      words[static_cast<std::size_t>(axis)] = "\"" + unit + "\"";
      const auto in_unit = [&, mm = mm](int n, double value) { return std::to_string(n == axis ? value / mm : value); };
      std::string header =
          nrrd_but("space directions", "space directions: (" + in_unit(0, 1) + ",0,0) (0," + in_unit(1, 2) +
                                           ",0) (0,0," + in_unit(2, 3) + ")\n" + "space units: " + words[0] + " " +
                                           words[1] + " " + words[2] + "\n");
      const std::string origin = "(" + in_unit(0, -4) + "," + in_unit(1, 5) + "," + in_unit(2, 6) + ")";
      header.replace(header.find("(-4,5,6)"), 8, origin);
      SCOPED_TRACE(unit);
      expect_nrrd(header);
    }
  }
  expect_nrrd(nrrd_but("", "space units: \"mm\n"));  // not closed: not said
  expect_nrrd(nrrd_but("", "space units: \"mm\" \"mm\"\n"));
  EXPECT_THAT(verdict_on("a.nrrd", nrrd_but("", "space units: \"mm\" \"\" \"pixel\"\n") + voxels<std::int16_t>()),
              HasSubstr("\"pixel\""));
}

TEST(NrrdHeader, EverySpaceThatIsNamedByThePatientIsRead) {
  const std::vector<std::pair<std::vector<std::string>, Vec3>> spaces{
      {{"left-posterior-superior", "LPS", "lps", "Left-Posterior-Superior"}, {1, 1, 1}},
      {{"right-anterior-superior", "RAS", "ras", "RIGHT-anterior-superior"}, {-1, -1, 1}},
      {{"left-anterior-superior", "LAS", "las", "left-anterior-SUPERIOR"}, {1, -1, 1}}};
  for (const auto& [names, by] : spaces) {
    for (const std::string& name : names) {
      SCOPED_TRACE(name);
      expect_nrrd(nrrd_but("space", "space: " + name + "\n"), by);
      const std::string with_time = name.size() == 3 ? name + "T" : name + "-time";
      std::string four = nrrd_but("space", "space: " + with_time + "\n");
      four.replace(four.find("(1,0,0) (0,2,0) (0,0,3)"), 23, "(1,0,0,0) (0,2,0,0) (0,0,3,0)");
      four.replace(four.find("(-4,5,6)"), 8, "(-4,5,6,1.5)");
      expect_nrrd(four, by);
    }
  }
  for (const char* const other : {"scanner-xyz", "3D-right-handed", "left-posterior", "RPS", "LPI", ""}) {
    EXPECT_EQ(verdict_on("a.nrrd", nrrd_but("space", "space: " + std::string(other) + "\n") + voxels<std::int16_t>()),
              no_place)
        << other;
  }
  EXPECT_EQ(verdict_on("a.nrrd", nrrd_but("space", "") + voxels<std::int16_t>()), no_place);
}

/// In letters of any case.
TEST(NrrdHeader, EveryWordForTheOrderOfBytesIsRead) {
  for (const auto& [word, big] : std::vector<std::pair<std::string, bool>>{
           {"little", false}, {"Little", false}, {"LITTLE", false}, {"big", true}, {"Big", true}, {"BIG", true}}) {
    SCOPED_TRACE(word);
    expect_nrrd(nrrd_but("endian", "endian: " + word + "\n"), Vec3(1), big);
  }
}

TEST(NrrdHeader, EveryNameOfATypeIsRead) {
  const std::vector<std::pair<std::size_t, std::vector<std::string>>> types{
      {1, {"signed char", "int8", "int8_t", "uchar", "unsigned char", "uint8", "uint8_t", "UCHAR"}},
      {2,
       {"short", "short int", "signed short", "signed short int", "int16", "int16_t", "ushort", "unsigned short",
        "unsigned short int", "uint16", "uint16_t"}},
      {4, {"int", "signed int", "int32", "int32_t", "uint", "unsigned int", "uint32", "uint32_t", "float", "Float"}},
      {8,
       {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t",
        "ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t", "double"}}};
  for (const auto& [bytes, names] : types) {
    for (const std::string& name : names) {
      const std::string header = nrrd_but("type", "type: " + name + "\n");
      EXPECT_EQ(verdict_on("a.nrrd", header + std::string(nx * ny * nz * bytes, '\1')), "read") << name;
      const std::string early = verdict_on("a.nrrd", header + std::string(nx * ny * nz * bytes - 1, '\1'));
      EXPECT_EQ(early, "it ends before its last voxel: copy or export it again") << name;
    }
  }
  for (const char* const other : {"block", "char", "long", "float16", ""}) {
    EXPECT_EQ(verdict_on("a.nrrd", nrrd_but("type", "type: " + std::string(other) + "\n") + voxels<std::int16_t>()),
              "its voxels are of a type that is not read: save it as numbers of 8 to 64 bits")
        << other;
  }
}

/// Names of fields are the same in letters of either case; pairs, comments and lines that say nothing are no fields;
/// lines may end as on Windows.
TEST(NrrdHeader, OnlyFieldsCount) {
  expect_nrrd(nrrd_but("sizes", "SIZES: 4 3 5\n"));
  expect_nrrd(nrrd_but("space origin", "Space Origin:(-4,5,6)\n"));
  expect_nrrd(nrrd_but("", "# sizes: 9 9 9\nnothing\nsizes_of:=9 9 9\nNote:=sizes: 9 9 9\n"));
  expect_nrrd(nrrd_but("", "Sizes:=9 9 9\n"));  // a pair keeps its letters
  std::string windows = nrrd_but("", "");
  for (std::size_t at = windows.find('\n'); at != std::string::npos; at = windows.find('\n', at + 2)) {
    windows.insert(at, "\r");
  }
  expect_nrrd(windows);
  EXPECT_NE(verdict_on("a.nrrd", "nrrd" + nrrd_but("", "").substr(4) + voxels<std::int16_t>()), "read");
}

TEST(NrrdHeader, AnEncodingIsNamedInLettersOfEitherCase) {
  expect_nrrd(nrrd_but("encoding", "encoding: RAW\n"));
  for (const char* const other : {"", "zrl", "raw2"}) {
    EXPECT_THAT(
        verdict_on("a.nrrd", nrrd_but("encoding", "encoding: " + std::string(other) + "\n") + voxels<std::int16_t>()),
        HasSubstr("its encoding \"" + std::string(other) + "\" is not read"));
  }
}

/// Three axes in space and their place; what is none, or another number of them, has no place.
TEST(NrrdHeader, EachAxisHasItsDirection) {
  const auto with = [](const std::string& name, const std::string& value) {
    return verdict_on("a.nrrd", nrrd_but(name, name + ": " + value + "\n") + voxels<std::int16_t>(false, 6));
  };
  EXPECT_EQ(with("space directions", "(1,0,0) (0,2,0) (0,0,3)"), "read");
  EXPECT_EQ(with("space directions", " ( 1 , 0 , 0 )  (0, 2, 0) (0,0,3) "), "read");
  for (const char* const lacking :
       {"", "(1,0,0) (0,2,0)", "(1,0,0) (0,2,0) none", "(1,0,0) (0,2,0) (0,0,3) none", "none none (1,0,0)",
        "(1,0) (0,2) (0,3)", "(1,0,0,0,0) (0,2,0,0,0) (0,0,3,0,0)", "(1,0,0) (0,nan,0) (0,0,3)",
        "(inf,0,0) (0,1,0) (0,0,3)", "(1,0,0) (0,1,0) (0,0,-inf)"}) {
    EXPECT_EQ(with("space directions", lacking), no_place) << lacking;
  }
  EXPECT_EQ(with("space directions", "(1,0,0,0) (0,2,0,0) (0,0,3,0.5)"), no_lattice) << "a slice later than the other";
  EXPECT_EQ(with("space directions", "(1,0,0) (0,2,0) (0,0,0)"), no_lattice);
  for (const char* const lacking : {"", "(1,2)", "(1,2,3,4,5)"}) {
    EXPECT_EQ(with("space origin", lacking), no_place) << lacking;
  }
  EXPECT_EQ(with("space origin", "(1,2,nan)"), no_lattice);
  for (const char* const other : {"", "4 3", "4 3 5 2 2"}) {
    EXPECT_EQ(with("sizes", other), "it holds several volumes: save each in a file of its own") << other;
  }
  for (const char* const none : {"0 3 5", "4 -3 5", "4 3 nan", "4 inf 5"}) EXPECT_EQ(with("sizes", none), no_lattice);
}

/// A fourth axis that is not in space: "none", or a vector of what is no number.
TEST(NrrdHeader, AFourthAxisMayBeWrittenInSeveralWays) {
  for (const std::string none : {"none", "(nan,nan,nan)", "None"}) {
    std::string header = nrrd_but("sizes", "sizes: 4 3 5 2\nkinds: domain domain domain list\n");
    header.replace(header.find("(0,0,3)"), 7, "(0,0,3) " + none);
    const TestFolder folder;
    write_bytes(folder / "a.nrrd", header + voxels<std::int16_t>(false, 2));
    const Catalogue found = find_series(std::array{folder / "a.nrrd"});
    ASSERT_THAT(found.series, SizeIs(1)) << none;
    EXPECT_EQ(found.series[0].frames_per_position, 2);
    expect_all(load(found.series[0], {.frame = 1}), place_in_nrrd,
               [](int a, int b, int c) { return stored(a, b, c) + 1000; });
  }
}

/// As the fastest axis: a list or times are volumes, colors are colors, and anything else is refused. Its own kind
/// counts, and not that of an axis beside it.
TEST(NrrdHeader, AFastestAxisIsWhatItsOwnKindSays) {
  const auto with = [](int count, const std::string& kinds, const std::string& type = "uint8") {
    std::string header = nrrd_but("type", "type: " + type + "\n");
    header.replace(header.find("sizes: "), 7, "sizes: " + std::to_string(count) + " ");
    header.replace(header.find("(1,0,0)"), 7, "none (1,0,0)");
    const TestFolder folder;
    write_bytes(folder / "a.nrrd",
                header.substr(0, header.size() - 1) + "kinds: " + kinds + "\n\n" +
                    std::string(static_cast<std::size_t>(8 * nx * ny * nz * std::max(count, 1)), 'a'));
    const Catalogue found = find_series(std::array{folder / "a.nrrd"});
    if (found.series.empty()) return std::string(found.skipped.at(0).reason);
    return std::to_string(found.series[0].frames_per_position);
  };
  const auto several = [](int count) {
    return "it holds " + std::to_string(count) + " values for each voxel: save one of them in a file of its own";
  };
  for (const char* const kind : {"list", "time", "LIST"}) {
    EXPECT_EQ(with(3, std::string(kind) + " domain domain domain"), "3");
    EXPECT_EQ(with(255, std::string(kind) + " domain domain domain"), "255");
    EXPECT_EQ(with(256, std::string(kind) + " domain domain domain"), several(256));
    EXPECT_EQ(with(0, std::string(kind) + " domain domain domain"), no_lattice);
  }
  EXPECT_EQ(with(3, "domain list list list"), several(3));
  EXPECT_EQ(with(3, "RGB-color domain domain domain"), "1");
  EXPECT_EQ(with(4, "RGBA-color domain domain domain"), "1");
  EXPECT_EQ(with(4, "RGBA-color domain domain domain", "uint16"), "1");
  EXPECT_EQ(with(3, "RGB-color domain domain domain", "int16"), several(3));
  EXPECT_EQ(with(3, "RGB-color domain domain domain", "float"), several(3));
  EXPECT_EQ(with(2, "RGB-color domain domain domain"), several(2));
  EXPECT_EQ(with(5, "RGB-color domain domain domain"), several(5));
  EXPECT_EQ(with(3, ""), several(3));
}

/// ITU-R BT.601 of 16 bits, too.
TEST(NrrdHeader, ColorsOf16BitsAreGray) {
  std::string header = nrrd_but("type", "type: uint16\n");
  header.replace(header.find("sizes: "), 7, "sizes: 3 ");
  header.replace(header.find("(1,0,0)"), 7, "none (1,0,0)");
  header.insert(header.size() - 1, "kinds: RGB-color domain domain domain\n");
  std::string data;
  for (int n = 0; n < nx * ny * nz; ++n) {
    for (const int part : {1000 * n, 60000 - 500 * n, 7 * n}) data += as_bytes(static_cast<std::uint16_t>(part));
  }
  const TestFolder folder;
  write_bytes(folder / "a.nrrd", header + data);
  expect_all(only_volume(folder / "a.nrrd"), place_in_nrrd, [](int a, int b, int c) {
    const int n = (c * ny + b) * nx + a;
    return std::round(0.299 * 1000 * n + 0.587 * (60000 - 500 * n) + 0.114 * 7 * n);
  });
}

/// "byte skip" counts from the data's beginning; -1 says that the voxels are what the file ends with, of all volumes.
TEST(NrrdHeader, BytesAreSkippedByEitherName) {
  const std::string data = voxels<std::int16_t>(false, 3);
  for (const std::string name : {"byte skip", "byteskip"}) {
    for (const int count : {0, 1, 2, 6, 1000, -1}) {
      for (const bool apart : {false, true}) {
        SCOPED_TRACE(name + " " + std::to_string(count) + (apart ? " apart" : ""));
        std::string header = nrrd_but("sizes", "sizes: 4 3 5 3\n" + name + ": " + std::to_string(count) + "\n" +
                                                   (apart ? "datafile: a.raw\n" : ""));
        header.replace(header.find("(0,0,3)"), 7, "(0,0,3) none");
        const std::string body = std::string(static_cast<std::size_t>(count < 0 ? 77 : count), 'x') + data;
        const TestFolder folder;
        write_bytes(folder / "a.nhdr", header + (apart ? "" : body));
        if (apart) write_bytes(folder / "a.raw", body);
        for (const int frame : {0, 2}) {
          expect_all(only_volume(folder / "a.nhdr", frame), place_in_nrrd,
                     [&](int a, int b, int c) { return stored(a, b, c) + 1000 * frame; });
        }
      }
    }
  }
}

/// 3D Slicer's: a label without a value has its number, from 1 on; without a layer it is in the first one.
TEST(NrrdHeader, SegmentsHaveTheirOwnValuesLayersAndColors) {
  std::string header = nrrd_but("type", "type: uint8\n");
  header.insert(header.size() - 1,
                "Segment0_Name:=one\nSegment1_Name:=seven\nSegment1_LabelValue:=7\nSegment1_Color:=0.2 0.4 1\n"
                "Segment2_Name:=three\nSegment2_LabelValue:=nan\nSegment2_Layer:=nan\nSegment4_Name:=never\n");
  const TestFolder folder;
  write_bytes(folder / "a.seg.nrrd", header + std::string(20, '\1') + std::string(20, '\3') + std::string(20, '\7'));
  std::vector<std::string> found;
  for (const Structure& structure : find_structures(std::array{folder / "a.seg.nrrd"}).structures) {
    found.push_back(std::to_string(structure.number) + " " + structure.name + " " + structure.color + " " +
                    std::to_string(measure(structure).voxels.value_or(0)));
  }
  EXPECT_EQ(found, (std::vector<std::string>{"1 one  20", "3 three  20", "7 seven #3366ff 20"}));
}

/// Labels in layers are no scan, however few there are.
TEST(NrrdHeader, LayersOfLabelsAreNoScan) {
  for (const int layers : {2, 3}) {
    std::string header = nrrd_but("type", "type: uint8\nSegment0_Name:=one\nSegment0_Layer:=0\n");
    header.replace(header.find("sizes: "), 7, "sizes: " + std::to_string(layers) + " ");
    header.replace(header.find("(1,0,0)"), 7, "none (1,0,0)");
    const std::string data(static_cast<std::size_t>(layers * nx * ny * nz), '\1');
    EXPECT_EQ(verdict_on("a.nrrd", header + data),
              "it holds " + std::to_string(layers) + " values for each voxel: save one of them in a file of its own");
  }
}

}  // namespace
}  // namespace palpate::io::internal
