// Label maps that are written, byte by byte and line by line, against the standards' own words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/geometric.hpp>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "io/errors.h"
#include "io/interchange/label_bytes.h"
#include "io/structures/label_image.h"
#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// On a lattice of steps along i, j and k; a voxel in three is inside.
LabelImage image_on(const Vec3& i, const Vec3& j, const Vec3& k, const Vec3& first, const glm::ivec3& size) {
  LabelImage image;
  image.label.name = "left kidney";
  image.label.color = "#3366ff";
  Geometry& g = image.geometry;
  g.dimensions = size;
  g.spacing_i = glm::length(i);
  g.spacing_j = glm::length(j);
  g.direction_i = i / g.spacing_i;
  g.direction_j = j / g.spacing_j;
  g.step = k;
  for (int n = 0; n < size.z; ++n) g.slice_positions.push_back(first + static_cast<double>(n) * k);
  for (int n = 0; n < size.x * size.y * size.z; ++n) image.inside.push_back(n % 3 == 0 ? 1 : 0);
  return image;
}

/// Along the patient's axes, feet first, turned about an axis of its own, and of a tilted gantry.
std::vector<LabelImage> images() {
  const Vec3 i(6.0 / 7, 2.0 / 7, -3.0 / 7), j(3.0 / 7, -6.0 / 7, 2.0 / 7), k = glm::cross(i, j);
  return {image_on({0.5, 0, 0}, {0, 2, 0}, {0, 0, 3}, {-4, 5, 6}, {4, 3, 5}),
          image_on({-0.5, 0, 0}, {0, 2, 0}, {0, 0, -3}, {40, -5, 6}, {3, 4, 2}),
          image_on(0.75 * i, 1.5 * j, 2.5 * k, {10, -20, 30}, {5, 4, 3}),
          image_on({0.5, 0, 0}, {0, 2, 0}, {0, 1, 3}, {-4, 5, 6}, {4, 3, 5}),
          image_on({0.5, 0, 0}, {0, 2, 0}, {-0.5, 0, 3}, {-4, 5, 6}, {4, 3, 5})};
}

bool is_straight(const LabelImage& image) {
  const Geometry& g = image.geometry;
  return glm::length(glm::cross(g.step, glm::cross(g.direction_i, g.direction_j))) < 1e-9;
}

std::string voxels_in(const LabelImage& image) {
  return {image.inside.begin(), image.inside.end()};
}

/// One stream of gzip or of zlib, as `window_bits` asks for; throws if it is not one, or if anything follows it.
std::string inflated(std::string bytes, int window_bits) {
  z_stream stream{};
  if (inflateInit2(&stream, window_bits) != Z_OK) throw std::runtime_error("zlib");
  std::string out(1U << 16, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = inflate(&stream, Z_FINISH);
  out.resize(out.size() - stream.avail_out);
  const bool is_whole = status == Z_STREAM_END && stream.avail_in == 0;
  inflateEnd(&stream);
  if (!is_whole) throw std::runtime_error("not one stream");
  return out;
}
constexpr int gzip_bits = MAX_WBITS + 16, zlib_bits = MAX_WBITS;

template <typename T>
T number_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// --- NIfTI-1: nifti1.h -----------------------------------------------------------------------------------------------

/// Rows of four to a place in LPS, mm.
Vec3 place_by(const std::array<std::array<double, 4>, 3>& rows, const Vec3& voxel) {
  Vec3 ras(0);
  for (int r = 0; r < 3; ++r) {
    const auto& row = rows[static_cast<std::size_t>(r)];
    ras[r] = row[0] * voxel.x + row[1] * voxel.y + row[2] * voxel.z + row[3];
  }
  return {-ras.x, -ras.y, ras.z};
}

/// nifti1.h, method 2: the rotation of a quaternion, the spacings, and qfac.
std::array<std::array<double, 4>, 3> rows_of_quaternion(const std::string& bytes) {
  const auto real = [&](std::size_t at) { return static_cast<double>(number_at<float>(bytes, at)); };
  const double b = real(256), c = real(260), d = real(264), a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
  const std::array<std::array<double, 3>, 3> turn{
      {{a * a + b * b - c * c - d * d, 2 * b * c - 2 * a * d, 2 * b * d + 2 * a * c},
       {2 * b * c + 2 * a * d, a * a + c * c - b * b - d * d, 2 * c * d - 2 * a * b},
       {2 * b * d - 2 * a * c, 2 * c * d + 2 * a * b, a * a + d * d - c * c - b * b}}};
  const double qfac = real(76) < 0 ? -1 : 1;
  std::array<std::array<double, 4>, 3> rows{};
  for (std::size_t r = 0; r < 3; ++r) {
    rows[r] = {turn[r][0] * real(80), turn[r][1] * real(84), turn[r][2] * real(88) * qfac, real(268 + 4 * r)};
  }
  return rows;
}

void expect_places(const std::array<std::array<double, 4>, 3>& rows, const LabelImage& image) {
  const glm::ivec3 last = image.geometry.dimensions - 1;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 voxel((corner & 1) * last.x, (corner >> 1 & 1) * last.y, (corner >> 2) * last.z);
    EXPECT_LT(glm::length(place_by(rows, voxel) - image.geometry.to_patient(voxel)), 1e-4) << corner;
  }
}

TEST(WriteLabelMap, NiftiHasEachFieldOfTheStandard) {
  for (const LabelImage& image : images()) {
    const std::string bytes = nifti_bytes(image, ".nii");
    ASSERT_GT(bytes.size(), 352U);
    const auto code = [&](std::size_t at) { return number_at<std::int16_t>(bytes, at); };
    EXPECT_EQ(number_at<std::int32_t>(bytes, 0), 348);
    const glm::ivec3& size = image.geometry.dimensions;
    const std::array<int, 8> dim{3, size.x, size.y, size.z, 1, 1, 1, 1};
    for (std::size_t n = 0; n < 8; ++n) EXPECT_EQ(code(40 + 2 * n), dim[n]) << n;
    EXPECT_EQ(code(68), 1002) << "NIFTI_INTENT_LABEL";
    EXPECT_EQ(code(70), 2) << "DT_UINT8";
    EXPECT_EQ(code(72), 8) << "bitpix";
    const Geometry& g = image.geometry;
    const std::array<double, 4> pixdim{1, g.spacing_i, g.spacing_j, glm::length(g.step)};
    for (std::size_t n = 0; n < 4; ++n)
      EXPECT_EQ(number_at<float>(bytes, 76 + 4 * n), static_cast<float>(pixdim[n])) << n;
    EXPECT_EQ(number_at<float>(bytes, 112), 1) << "scl_slope";
    EXPECT_EQ(number_at<float>(bytes, 116), 0) << "scl_inter";
    EXPECT_EQ(bytes[123], 2) << "NIFTI_UNITS_MM";
    EXPECT_EQ(bytes.substr(344, 4), std::string("n+1\0", 4));
    std::array<std::array<double, 4>, 3> sform{};
    for (std::size_t n = 0; n < 12; ++n)
      sform[n / 4][n % 4] = static_cast<double>(number_at<float>(bytes, 280 + 4 * n));
    EXPECT_EQ(code(254), 1) << "NIFTI_XFORM_SCANNER_ANAT";
    expect_places(sform, image);
    EXPECT_EQ(code(252), is_straight(image) ? 1 : 0) << "a quaternion says nothing of a sheared lattice";
    if (is_straight(image)) expect_places(rows_of_quaternion(bytes), image);
    const auto at = static_cast<std::size_t>(number_at<float>(bytes, 108));
    ASSERT_EQ(bytes.size(), at + image.inside.size());
    EXPECT_EQ(bytes.substr(at), voxels_in(image));
    EXPECT_EQ(inflated(nifti_bytes(image, ".nii.gz"), gzip_bits), bytes);
  }
}

/// Two slices lean by so much, the tangent of an angle, over i or over j; either way.
TEST(WriteLabelMap, NiftiHasAQuaternionWhereNothingIsShearedButByRounding) {
  for (const double leaning : {0.0, 5e-5, -5e-5, 2e-4, -2e-4, 0.5, -0.5}) {
    for (const bool over_i : {false, true}) {
      const Vec3 k = 3.0 * (over_i ? Vec3(leaning, 0, 1) : Vec3(0, leaning, 1));
      const std::string bytes = nifti_bytes(image_on({1, 0, 0}, {0, 1, 0}, k, {0, 0, 0}, {2, 2, 2}), ".nii");
      EXPECT_EQ(number_at<std::int16_t>(bytes, 252), std::abs(leaning) < 1e-4 ? 1 : 0) << leaning;
    }
  }
}

/// Behind the header a flag, and an extension: its length, of which 16 is a part; NIFTI_ECODE_CARET, whose table names
/// labels; and text.
TEST(WriteLabelMap, NiftiNamesTheLabelInAnExtension) {
  for (std::size_t letters = 1; letters < 40; ++letters) {
    LabelImage image = images().front();
    image.label.name = std::string(letters, 'k');
    const std::string bytes = nifti_bytes(image, ".nii");
    EXPECT_EQ(bytes.substr(348, 4), std::string("\1\0\0\0", 4));
    const auto length = static_cast<std::size_t>(number_at<std::int32_t>(bytes, 352));
    EXPECT_EQ(length % 16, 0U);
    EXPECT_EQ(number_at<std::int32_t>(bytes, 356), 30);
    EXPECT_EQ(static_cast<std::size_t>(number_at<float>(bytes, 108)), 352 + length);
    const std::string text = bytes.substr(360, length - 8);
    EXPECT_THAT(text, StartsWith("<?xml version=\"1.0\" encoding=\"UTF-8\"?><CaretExtension><VolumeInformation "
                                 "Index=\"0\"><LabelTable>"));
    EXPECT_THAT(text, HasSubstr("<Label Key=\"1\" Red=\"0.200000\" Green=\"0.400000\" Blue=\"1.000000\" Alpha=\"1\">"
                                "<![CDATA[" +
                                image.label.name + "]]></Label>"));
    EXPECT_THAT(std::string(text.c_str()), EndsWith("</LabelTable></VolumeInformation></CaretExtension>"));
    EXPECT_LT(length - 8 - std::string(text.c_str()).size(), 16U) << "no more is filled up than needed";
  }
}

// --- NRRD: teem.sourceforge.net/nrrd/format.html ---------------------------------------------------------------------

/// Fields and pairs of the header; what follows the empty line is put in `data`.
std::map<std::string, std::string> lines_of(const std::string& bytes, std::string& data) {
  const std::size_t end = bytes.find("\n\n");
  data = bytes.substr(end + 2);
  std::istringstream header(bytes.substr(0, end));
  std::map<std::string, std::string> fields;
  std::string line;
  std::getline(header, line);
  EXPECT_EQ(line, "NRRD0004");
  while (std::getline(header, line)) {
    const std::size_t colon = line.find(':');
    EXPECT_NE(colon, std::string::npos) << line;
    EXPECT_TRUE(fields.emplace(line.substr(0, colon), line.substr(colon + 2)).second) << line;
  }
  return fields;
}

std::vector<double> numbers_in(std::string text) {
  for (char& c : text) c = c == '(' || c == ')' || c == ',' ? ' ' : c;
  std::istringstream words(text);
  std::vector<double> all;
  for (double number = 0; words >> number;) all.push_back(number);
  return all;
}

void expect_near(const std::vector<double>& read, const std::vector<Vec3>& wanted) {
  ASSERT_EQ(read.size(), 3 * wanted.size());
  for (std::size_t n = 0; n < read.size(); ++n) EXPECT_NEAR(read[n], wanted[n / 3][static_cast<int>(n % 3)], 1e-12);
}

std::vector<Vec3> steps_of(const LabelImage& image) {
  const Geometry& g = image.geometry;
  return {g.spacing_i * g.direction_i, g.spacing_j * g.direction_j, g.step};
}

std::string sizes_of(const LabelImage& image) {
  const glm::ivec3& n = image.geometry.dimensions;
  return std::to_string(n.x) + " " + std::to_string(n.y) + " " + std::to_string(n.z);
}

TEST(WriteLabelMap, NrrdHasEachFieldOfTheStandard) {
  for (const LabelImage& image : images()) {
    for (const char* const ending : {".nrrd", ".seg.nrrd"}) {
      std::string data;
      auto fields = lines_of(nrrd_bytes(image, ending), data);
      EXPECT_EQ(fields["type"], "uint8");
      EXPECT_EQ(fields["dimension"], "3");
      EXPECT_EQ(fields["space"], "left-posterior-superior");
      EXPECT_EQ(fields["sizes"], sizes_of(image));
      EXPECT_EQ(fields["kinds"], "domain domain domain");
      EXPECT_EQ(fields["encoding"], "gzip");
      expect_near(numbers_in(fields["space directions"]), steps_of(image));
      expect_near(numbers_in(fields["space origin"]), {image.geometry.slice_positions.front()});
      EXPECT_EQ(inflated(data, gzip_bits), voxels_in(image));
      EXPECT_EQ(fields.contains("Segment0_Name"), ending == std::string(".seg.nrrd"));
    }
  }
}

/// 3D Slicer's fields: colors as parts of 1, the extent from first to last voxel, and codes as scheme^value^meaning.
TEST(WriteLabelMap, SlicersFieldsSayNameColorExtentAndCodes) {
  LabelImage image = images().front();
  const auto value = [&](const std::string& name) {
    const std::string bytes = nrrd_bytes(image, ".seg.nrrd"), before = "\n" + name + ":=";
    const std::size_t at = bytes.find(before);
    if (at == std::string::npos) return std::string("absent");
    return bytes.substr(at + before.size(), bytes.find('\n', at + 1) - at - before.size());
  };
  EXPECT_EQ(value("Segment0_ID"), "Segment_1");
  EXPECT_EQ(value("Segment0_Name"), "left kidney");
  EXPECT_EQ(value("Segment0_Color"), "0.200000 0.400000 1.000000");
  EXPECT_EQ(value("Segment0_LabelValue"), "1");
  EXPECT_EQ(value("Segment0_Layer"), "0");
  EXPECT_EQ(value("Segment0_Extent"), "0 3 0 2 0 4");
  EXPECT_EQ(value("Segmentation_ReferenceImageExtentOffset"), "0 0 0");
  const std::string head =
                        "Segmentation.Status:inprogress|TerminologyEntry:Segmentation category and type - 3D Slicer "
                        "General Anatomy list~",
                    tail = "~Anatomic codes - DICOM master list~^^~^^|";
  const std::string tissue = "SCT^85756007^Tissue";
  EXPECT_EQ(value("Segment0_Tags"), head + tissue + "~" + tissue + "~^^" + tail) << "nothing is known of it";
  image.label.category = {"123037004", "SCT", "Anatomical Structure"};
  EXPECT_EQ(value("Segment0_Tags"), head + "SCT^123037004^Anatomical Structure~" + tissue + "~^^" + tail);
  image.label.type = {"64033007", "SCT", "Kidney"};
  EXPECT_EQ(value("Segment0_Tags"), head + "SCT^123037004^Anatomical Structure~SCT^64033007^Kidney~^^" + tail);
  image.label.modifiers = {{"7771000", "SCT", "Left"}, {"1", "2", "3"}};
  EXPECT_EQ(value("Segment0_Tags"),
            head + "SCT^123037004^Anatomical Structure~SCT^64033007^Kidney~SCT^7771000^Left" + tail);
  image.label.color = "";
  EXPECT_EQ(value("Segment0_Color"), "0.501961 0.682353 0.501961") << "Slicer's color of tissue";
}

// --- MetaImage: itk::MetaImageIO -------------------------------------------------------------------------------------

TEST(WriteLabelMap, MetaImageHasEachFieldOfItsFormat) {
  for (const LabelImage& image : images()) {
    const std::string bytes = meta_image_bytes(image, ".mha");
    std::map<std::string, std::string> fields;
    std::size_t at = 0;
    std::string last;
    while (last != "ElementDataFile") {
      const std::size_t end = bytes.find('\n', at), equals = bytes.find(" = ", at);
      ASSERT_LT(equals, end);
      last = bytes.substr(at, equals - at);
      EXPECT_TRUE(fields.emplace(last, bytes.substr(equals + 3, end - equals - 3)).second) << last;
      at = end + 1;
    }
    const std::string data = bytes.substr(at);
    EXPECT_EQ(fields["ObjectType"], "Image");
    EXPECT_EQ(fields["NDims"], "3");
    EXPECT_EQ(fields["BinaryData"], "True");
    EXPECT_EQ(fields["CompressedData"], "True");
    EXPECT_EQ(fields["CompressedDataSize"], std::to_string(data.size()));
    EXPECT_EQ(fields["DimSize"], sizes_of(image));
    EXPECT_EQ(fields["ElementType"], "MET_UCHAR");
    EXPECT_EQ(fields["ElementDataFile"], "LOCAL");
    std::vector<Vec3> turned = steps_of(image);
    const std::vector<double> spacing = numbers_in(fields["ElementSpacing"]);
    ASSERT_EQ(spacing.size(), 3U);
    for (std::size_t n = 0; n < 3; ++n) {
      EXPECT_NEAR(spacing[n], glm::length(turned[n]), 1e-12);
      turned[n] = glm::normalize(turned[n]);
    }
    expect_near(numbers_in(fields["TransformMatrix"]), turned);
    expect_near(numbers_in(fields["Offset"]), {image.geometry.slice_positions.front()});
    EXPECT_EQ(inflated(data, zlib_bits), voxels_in(image));
  }
}

// --- All of them -----------------------------------------------------------------------------------------------------

std::string refusal_of_written(const LabelImage& image, const std::filesystem::path& file) {
  try {
    write_label_map(image, file, {});
  } catch (const DicomError& error) {
    return error.what();
  }
  return "written";
}

/// What is read of them is what was written, whatever the name has in it that would end a line or a table.
TEST(WriteLabelMap, IsReadAsItWasWritten) {
  const std::vector<LabelImage> all = images();
  for (const char* const ending : {".nii", ".nii.gz", ".nrrd", ".seg.nrrd", ".mha", ".SEG.NRRD", ".MHA"}) {
    const bool is_named = std::string(ending).find("nii") != std::string::npos || std::string(ending).size() > 6;
    for (std::size_t n = 0; n < all.size(); ++n) {
      SCOPED_TRACE(std::string(ending) + " " + std::to_string(n));
      LabelImage image = all[n];
      const std::vector<std::pair<std::string, std::string>> names{
          {"left kidney", "left kidney"}, {"a\nb\tc", "a b c"}, {"N\xC3\xA4vus ]] > ", "N\xC3\xA4vus ]] > "}};
      const auto& [given, read] = names[n % names.size()];
      image.label.name = given;
      const TestFolder folder;
      const std::filesystem::path file = folder / ("a" + std::string(ending));
      ASSERT_EQ(refusal_of_written(image, file), "written");
      const StructureCatalogue found = find_structures(std::array{file});
      ASSERT_EQ(found.structures.size(), 1U) << (found.skipped.empty() ? "" : std::string(found.skipped[0].reason));
      const Structure& structure = found.structures[0];
      if (is_named) {
        EXPECT_THAT(structure.name, StartsWith(read.substr(0, 5)));
        EXPECT_EQ(structure.color, "#3366ff");
      }
      std::size_t inside = 0;
      Vec3 center(0);
      const glm::ivec3& size = image.geometry.dimensions;
      for (int v = 0; v < size.x * size.y * size.z; ++v) {
        if (image.inside[static_cast<std::size_t>(v)] == 0) continue;
        ++inside;
        center += image.geometry.to_patient(Vec3(v % size.x, v / size.x % size.y, v / (size.x * size.y)));
      }
      const StructureMeasures measures = measure(structure);
      EXPECT_EQ(measures.voxels, inside);
      EXPECT_LT(glm::length(measures.centroid_mm - center / static_cast<double>(inside)), 1e-4);
    }
  }
}

/// A name with the end of a table's text in it ends no table.
TEST(WriteLabelMap, ANameCannotEndItsTable) {
  LabelImage image = images().front();
  image.label.name = "a]]>]]></Label><b";
  const std::string bytes = nifti_bytes(image, ".nii");
  const std::size_t begin = bytes.find("<![CDATA[") + 9, end = bytes.find("]]></Label></LabelTable>");
  ASSERT_NE(end, std::string::npos);
  EXPECT_THAT(bytes.substr(begin, end - begin), Not(HasSubstr("]]>")));
}

TEST(WriteLabelMap, WhatCannotBeWrittenIsRefusedInWords) {
  const TestFolder folder;
  LabelImage image = images().front();
  EXPECT_EQ(refusal_of_written(image, folder / "a.png"),
            "a.png has no known file name extension: use .dcm or one of .nii.gz, .nii, .seg.nrrd, .nrrd, .mha");
  const std::string uneven =
      "a.nii can hold only slices at equal distances, and the scan's slices are uneven: write .dcm";
  image.geometry.uniform = false;
  EXPECT_EQ(refusal_of_written(image, folder / "a.nii"), uneven);
  image.geometry.uniform = true;
  image.geometry.gaps = {1};
  EXPECT_EQ(refusal_of_written(image, folder / "a.nii"), uneven);
  image.geometry.gaps = {};
  EXPECT_EQ(refusal_of_written(image, folder / "a.nii"), "written");
  EXPECT_NE(refusal_of_written(image, folder / "a.nii"), "written") << "it is there";
  image.inside.assign(image.inside.size(), 0);
  EXPECT_THAT(refusal_of_written(image, folder / "b.nii"), HasSubstr("empty"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b.nii"));
}

}  // namespace
}  // namespace palpate::io::internal
