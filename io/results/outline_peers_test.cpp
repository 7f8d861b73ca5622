// Written outlines as read by other programs: dciodvfy (validity as DICOM), pydicom, nibabel and plastimatch (with
// ITK). They share no code with our writers and reader, except DCMTK, with which plastimatch reads contours.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "io/testing/outlined_scan.h"
#include "solver/text/testing/shown.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using internal::TestFolder;
using Json = nlohmann::json;
using palpate::testing::output_of;
using testing::full_label;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::scan_kind;
using testing::ScanKind;
using testing::Shape;

// Debian's Python, whose packages these are.
const std::string reads = "/usr/bin/python3 " PALPATE_SOURCES "/io/peers/read_outline.py ";

bool is_there(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}
bool has_program(const std::string& name) {
  return is_there("command -v " + name);
}
bool has_module(const std::string& name) {
  return is_there("/usr/bin/python3 -c 'import numpy, " + name + "'");
}

/// Of one file each: Python takes its time to start.
Json read_by_peer(const std::vector<fs::path>& files) {
  std::string command = reads;
  for (const fs::path& file : files) command += " '" + file.string() + "'";
  const std::string said = output_of(command + " 2>&1");
  const Json json = Json::parse(said, nullptr, false);
  if (json.is_discarded()) throw std::runtime_error(said);
  return json;
}

std::string digits_of(const LabelImage& image) {
  std::string digits;
  for (const std::uint8_t voxel : image.inside) digits += voxel != 0 ? '1' : '0';
  return digits;
}

/// A shape on a grid, and the file that it was written to.
struct Written {
  std::string name;
  Series scan;
  Shape shape;
  LabelImage image;
  fs::path file;

  /// Whether slices lie one above the other, as ITK wants them and a quaternion can say.
  bool is_straight() const {
    const Geometry& g = scan.geometry;
    return glm::length(glm::cross(g.step, glm::cross(g.direction_i, g.direction_j))) < 1e-3;
  }
};

/// Every shape on every kind of grid, in files of this ending.
std::vector<Written> write_all(const std::string& ending, const TestFolder& folder) {
  std::vector<Written> all;
  for (const ScanKind& kind : testing::scan_kinds()) {
    const bool is_even = kind.name != "uneven" && kind.name != "slices missing";
    if (!is_even && !ending.ends_with(".dcm")) continue;  // refused: write_structures_test.cpp
    const Series scan = testing::write_scan(kind, folder / kind.name);
    for (const Shape& shape : testing::shapes_in(scan.geometry)) {
      const fs::path file = folder / (std::to_string(all.size()) + ending);
      const StructureForm form = form_of(file, ending == ".rt.dcm");
      write_structure(full_label(), scan, scan.geometry, shape.distance, {}, form, file, testing::by_test);
      all.push_back({kind.name + ", " + shape.name, scan, shape,
                     sample_labels(full_label(), scan.geometry, shape.distance), file});
    }
  }
  return all;
}

/// Each with what a peer reads of its file, or of the files in their place.
void look_at_all(const std::vector<Written>& all, const std::function<void(const Written&, const Json&)>& look,
                 std::vector<fs::path> files = {}) {
  if (files.empty()) {
    for (const Written& one : all) files.push_back(one.file);
  }
  const Json read = read_by_peer(files);
  ASSERT_EQ(read.size(), all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    SCOPED_TRACE(all[n].name);
    look(all[n], read[n]);
  }
}

TEST(OutlinePeers, DciodvfyFindsNoErrorInDicom) {
  if (!has_program("dciodvfy")) GTEST_SKIP() << "dciodvfy is not installed: apt-get install dicom3tools";
  for (const std::string ending : {".dcm", ".rt.dcm"}) {
    const TestFolder folder;
    for (const Written& one : write_all(ending, folder)) {
      const std::string verdict = output_of("dciodvfy '" + one.file.string() + "' 2>&1");
      EXPECT_THAT(verdict, HasSubstr(ending == ".rt.dcm" ? "RTStructureSet" : "Segmentation")) << one.name;
      EXPECT_THAT(verdict, Not(HasSubstr("Error"))) << one.name;
    }
  }
}

TEST(OutlinePeers, PydicomReadsEveryVoxelOfASegmentation) {
  if (!has_module("pydicom")) GTEST_SKIP() << "pydicom is not installed: apt-get install python3-pydicom";
  const TestFolder folder;
  look_at_all(write_all(".dcm", folder), [](const Written& one, const Json& read) {
    const Geometry& grid = one.scan.geometry;
    EXPECT_EQ(read.at("patient"), "Müller^Zoë");
    EXPECT_EQ(read.at("name"), full_label().name);
    EXPECT_EQ(read.at("sources").size(), read.at("positions").size());
    EXPECT_NEAR(read.at("spacing")[0].get<double>(), grid.spacing_j, 1e-9);
    EXPECT_NEAR(read.at("spacing")[1].get<double>(), grid.spacing_i, 1e-9);
    const Vec3 row(read.at("orientation")[0], read.at("orientation")[1], read.at("orientation")[2]);
    const Vec3 column(read.at("orientation")[3], read.at("orientation")[4], read.at("orientation")[5]);
    EXPECT_LT(glm::length(row - grid.direction_i), 1e-9);
    EXPECT_LT(glm::length(column - grid.direction_j), 1e-9);
    // A frame lies on a slice; slices without one are empty.
    const std::string wanted = digits_of(one.image), pixels = read.at("pixels");
    const std::size_t slice = one.image.offset(0, 0, 1);
    std::string all(wanted.size(), '0');
    for (std::size_t f = 0; f < read.at("positions").size(); ++f) {
      const Json& at = read.at("positions")[f];
      const auto& places = grid.slice_positions;
      const auto same = std::ranges::find_if(
          places, [&](const Vec3& place) { return glm::length(place - Vec3(at[0], at[1], at[2])) < 1e-6; });
      ASSERT_NE(same, places.end());
      all.replace(slice * static_cast<std::size_t>(same - places.begin()), slice, pixels, f * slice, slice);
    }
    EXPECT_EQ(all, wanted);
  });
}

/// By hand: the area of each slice's contours by the formula of a polygon, beside that of the shape by counting a fine
/// lattice. A keyhole counts for nothing, for it is gone both ways.
TEST(OutlinePeers, PydicomReadsContoursOfTheShapesArea) {
  if (!has_module("pydicom")) GTEST_SKIP() << "pydicom is not installed: apt-get install python3-pydicom";
  const TestFolder folder;
  look_at_all(write_all(".rt.dcm", folder), [](const Written& one, const Json& read) {
    EXPECT_EQ(read.at("patient"), "Müller^Zoë");
    EXPECT_EQ(read.at("name"), full_label().name);
    EXPECT_EQ(read.at("color"), (std::vector<int>{0xd9, 0x82, 0x65}));
    const Geometry& geometry = one.scan.geometry;
    std::vector<double> area(static_cast<std::size_t>(geometry.dimensions.z));
    for (std::size_t c = 0; c < read.at("contours").size(); ++c) {
      const std::vector<double> data = read.at("contours")[c];
      ASSERT_EQ(data.size(), 3 * read.at("points")[c].get<std::size_t>());
      double doubled = 0;
      const auto index = [&](std::size_t n) {
        return geometry.to_index({data[3 * n], data[3 * n + 1], data[3 * n + 2]});
      };
      const long k = std::lround(index(0).z);
      for (std::size_t n = 0; n < data.size() / 3; ++n) {
        const Vec3 a = index(n), b = index((n + 1) % (data.size() / 3));
        EXPECT_NEAR(a.z, static_cast<double>(k), 1e-3) << "in its slice's plane";
        doubled += a.x * b.y - a.y * b.x;
      }
      area[static_cast<std::size_t>(k)] += doubled / 2 * geometry.spacing_i * geometry.spacing_j;
    }
    constexpr int fine = 20;
    for (int k = 0; k < geometry.dimensions.z; ++k) {
      int inside = 0;
      for (int j = 0; j < fine * geometry.dimensions.y; ++j) {
        for (int i = 0; i < fine * geometry.dimensions.x; ++i) {
          const Vec3 at((i + 0.5) / fine - 0.5, (j + 0.5) / fine - 0.5, k);
          inside += one.shape.distance(geometry.to_patient(at)) > 0 ? 1 : 0;
        }
      }
      const double truth = inside * geometry.spacing_i * geometry.spacing_j / (fine * fine);
      // Chords of circles: a sixth of their sagitta's length along the edge, which is at most 65 mm long here.
      EXPECT_NEAR(area[static_cast<std::size_t>(k)], truth, 0.3 + 0.03 * truth) << k;
    }
  });
}

/// The lattice in RAS that a NIfTI file holds, by the definition of its sform.
void expect_same_nifti(const Json& read, const LabelImage& image, bool is_straight) {
  const Geometry& geometry = image.geometry;
  EXPECT_EQ(read.at("shape"), (std::vector<int>{geometry.dimensions.x, geometry.dimensions.y, geometry.dimensions.z}));
  EXPECT_EQ(read.at("pixels"), digits_of(image));
  std::vector<const char*> forms{"affine"};
  if (is_straight) forms.push_back("qform");
  for (const char* const form : forms) {
    const Json& m = read.at(form);
    ASSERT_TRUE(m.is_array()) << form;
    const glm::ivec3 last = geometry.dimensions - 1;
    for (const Vec3& voxel : {Vec3(0), Vec3(last.x, 0, 0), Vec3(0, last.y, 0), Vec3(last)}) {
      Vec3 ras(0);
      for (int row = 0; row < 3; ++row) {
        const std::vector<double> numbers = m[static_cast<std::size_t>(row)];
        ras[row] = numbers[0] * voxel.x + numbers[1] * voxel.y + numbers[2] * voxel.z + numbers[3];
      }
      EXPECT_LT(glm::length(Vec3(-ras.x, -ras.y, ras.z) - geometry.to_patient(voxel)), 2e-4) << form;
    }
  }
}

TEST(OutlinePeers, NibabelReadsEveryVoxelOfNifti) {
  if (!has_module("nibabel")) GTEST_SKIP() << "nibabel is not installed: apt-get install python3-nibabel";
  for (const std::string ending : {".nii", ".nii.gz"}) {
    const TestFolder folder;
    look_at_all(write_all(ending, folder), [](const Written& one, const Json& read) {
      expect_same_nifti(read, one.image, one.is_straight());
      ASSERT_EQ(read.at("extensions").size(), 1U);
      EXPECT_THAT(read.at("extensions")[0].get<std::string>(), HasSubstr(full_label().name));
    });
  }
}

/// ITK reads them for plastimatch, which writes them as NIfTI for nibabel. It knows no sheared lattice.
TEST(OutlinePeers, PlastimatchReadsEveryVoxelOfNrrdAndMetaImage) {
  if (!has_program("plastimatch")) GTEST_SKIP() << "plastimatch is not installed";
  if (!has_module("nibabel")) GTEST_SKIP() << "nibabel is not installed: apt-get install python3-nibabel";
  for (const std::string ending : {".nrrd", ".seg.nrrd", ".mha"}) {
    const TestFolder folder;
    std::vector<Written> all = write_all(ending, folder);
    std::erase_if(all, [](const Written& one) { return !one.is_straight(); });
    std::vector<fs::path> by_itk;
    for (const Written& one : all) {
      by_itk.push_back(one.file.string() + ".nii");
      const std::string said = output_of("plastimatch convert --input '" + one.file.string() + "' --output-img '" +
                                         by_itk.back().string() + "' 2>&1");
      ASSERT_TRUE(fs::exists(by_itk.back())) << said;
    }
    look_at_all(
        all, [](const Written& one, const Json& read) { expect_same_nifti(read, one.image, true); }, by_itk);
  }
}

/// Where plastimatch fills the contours, by its own rule for several contours on a slice and for keyholes.
TEST(OutlinePeers, PlastimatchFillsContoursWhereTheShapeIs) {
  if (!has_program("plastimatch")) GTEST_SKIP() << "plastimatch is not installed";
  if (!has_module("nibabel")) GTEST_SKIP() << "nibabel is not installed: apt-get install python3-nibabel";
  const TestFolder folder;
  const Series scan = testing::write_scan(scan_kind("axial"), folder / "scan");
  StructureLabel label = full_label();
  label.name = "outline";  // it names files by it
  for (const Shape& shape : testing::shapes_in(scan.geometry)) {
    SCOPED_TRACE(shape.name);
    const fs::path contours = folder / (shape.name + ".dcm"), grid = folder / (shape.name + ".mha");
    const fs::path out = folder / shape.name, filled = folder / (shape.name + ".nii");
    const LabelImage image = sample_labels(label, scan.geometry, shape.distance);
    write_contours(trace_slices(label, scan.geometry, shape.distance), scan, contours, testing::by_test);
    write_label_map(image, grid, testing::by_test);
    const std::string said = output_of(
        "plastimatch convert --input '" + contours.string() + "' --fixed '" + grid.string() + "' --output-prefix '" +
        out.string() + "' --prefix-format nrrd 2>&1 && plastimatch convert --input '" +
        (out / "outline.nrrd").string() + "' --output-img '" + filled.string() + "' 2>&1");
    ASSERT_TRUE(fs::exists(filled)) << said;
    const Json read = read_by_peer({filled})[0];
    const std::string pixels = read.at("pixels"), wanted = digits_of(image);
    ASSERT_EQ(pixels.size(), wanted.size());
    const glm::ivec3& n = scan.geometry.dimensions;
    int differ = 0, inside = 0;
    for (int k = 0; k < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        for (int i = 0; i < n.x; ++i) {
          const std::size_t at = image.offset(i, j, k);
          inside += wanted[at] == '1' ? 1 : 0;
          constexpr double near_mm = 0.2;
          if (std::abs(shape.distance(scan.geometry.to_patient(Vec3(i, j, k)))) < near_mm) continue;
          differ += pixels[at] != wanted[at] ? 1 : 0;
        }
      }
    }
    EXPECT_GT(inside, 20);
    EXPECT_EQ(differ, 0);
  }
}

}  // namespace
}  // namespace palpate::io
