// Label maps that are written, byte by byte and line by line, against the standards' own words.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "io/errors.h"
#include "io/interchange/label_bytes.h"
#include "io/structures/label_image.h"
#include "io/structures/structure.h"
#include "io/testing/test_image.h"
#include "io/testing/written_labels.h"

namespace palpate::io::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

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
