// `palpate structures compare` as a script uses it: label maps and DICOM, on different grids, against mathematics and
// plastimatch.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "io/archive/testing/says.h"
#include "io/structures/label_image.h"
#include "io/testing/outlined_scan.h"
#include "plugin/testing/command_rig.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using io::Vec3;
using io::testing::says;
using testing::fresh_path;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;

const Vec3 ball_center(3, -7, 20);

io::SignedDistance ball(const Vec3& at, double radius) {
  return [=](const Vec3& p) { return radius - glm::length(p - at); };
}

/// Around the center: so many voxels, turned by an angle about z, so that grids differ.
io::Geometry grid(const glm::ivec3& size, const Vec3& spacing, double angle = 0) {
  io::Geometry geometry;
  geometry.dimensions = size;
  geometry.direction_i = {std::cos(angle), std::sin(angle), 0};
  geometry.direction_j = {-std::sin(angle), std::cos(angle), 0};
  geometry.spacing_i = spacing.x;
  geometry.spacing_j = spacing.y;
  geometry.step = {0, 0, spacing.z};
  const Vec3 half = Vec3(size - 1) / 2.0 * spacing;
  const Vec3 first = ball_center - half.x * geometry.direction_i - half.y * geometry.direction_j - Vec3(0, 0, half.z);
  for (int k = 0; k < size.z; ++k) geometry.slice_positions.push_back(first + static_cast<double>(k) * geometry.step);
  return geometry;
}

std::string write_labels(const fs::path& file, const io::Geometry& geometry, const io::SignedDistance& distance) {
  io::StructureLabel label;
  label.name = "ball";
  write_label_map(sample_labels(label, geometry, distance), file, {.overwrite = true, .software_version = "1"});
  return file.string();
}

fs::path fresh_folder(const std::string& name) {
  fs::path folder = fresh_path(name);
  fs::create_directories(folder);
  return folder;
}

Json compared(const std::string& arguments) {
  const Outcome outcome = palpate("structures compare --json " + arguments, false);
  EXPECT_EQ(outcome.exit, 0) << outcome.output;
  return Json::parse(outcome.output, nullptr, false);
}

/// Both balls on grids of their own: labels place an edge to a few tenths of a millimeter.
TEST(CommandCompareStructures, TellsOfBallsOnOtherGridsWhatTheirFormulasSay) {
  const fs::path folder = fresh_folder("balls");
  const Vec3 shifted = ball_center + 3.0 * glm::normalize(Vec3(2, 1, 1));
  const std::string a = write_labels(folder / "a.seg.nrrd", grid({48, 48, 48}, {1, 1, 1}), ball(ball_center, 12));
  const std::string b = write_labels(folder / "b.nii.gz", grid({70, 50, 30}, {0.7, 0.9, 1.6}, 0.4), ball(shifted, 12));
  const Json json = compared(a + " " + b);
  constexpr double volume = 4 * 3.14159265358979 / 3 * 12 * 12 * 12;
  EXPECT_NEAR(json["volume_mm3"][0].get<double>(), volume, 0.01 * volume);
  EXPECT_NEAR(json["volume_mm3"][1].get<double>(), volume, 0.01 * volume);
  EXPECT_NEAR(json["dice"].get<double>(), (4.0 * 12 + 3) * 21 * 21 / 12 / (4.0 / 3 * 12 * 12 * 12), 0.005);
  EXPECT_NEAR(json["mean_mm"].get<double>(), 1.5, 0.08);  // shift / 2, for small ones
  EXPECT_NEAR(json["largest_mm"].get<double>(), 3, 0.35);
  EXPECT_NEAR(json["p95_mm"].get<double>(), 2.85, 0.2);
  const Vec3 at(json["largest_at_mm"][0], json["largest_at_mm"][1], json["largest_at_mm"][2]);
  EXPECT_LT(glm::length(glm::cross(at - ball_center, glm::normalize(Vec3(2, 1, 1)))), 6);
  EXPECT_TRUE(json["margin_mm"].is_null());
  EXPECT_THAT(palpate("structures compare " + a + " " + b, false).output,
              ::testing::AllOf(HasSubstr("Dice"), HasSubstr("mean 1."), HasSubstr("largest")));
}

TEST(CommandCompareStructures, TellsTheMarginFromTheSecondOne) {
  const fs::path folder = fresh_folder("margins");
  const io::Geometry wide = grid({90, 40, 40}, {1, 1, 1});
  const std::string a = write_labels(folder / "a.mha", wide, ball(ball_center, 9));
  const std::string b = write_labels(folder / "b.mha", wide, ball(ball_center - Vec3(20, 0, 0), 9));
  const std::string c = write_labels(folder / "c.mha", wide, ball(ball_center + Vec3(22, 0, 0), 9));
  EXPECT_NEAR(compared(b + " " + a + " --to " + c)["margin_mm"].get<double>(), 4, 0.5);
  EXPECT_NEAR(compared(a + " " + b + " --to " + c)["margin_mm"].get<double>(), 24, 0.5);
  EXPECT_LT(compared(b + " " + a + " --to " + a)["margin_mm"].get<double>(), 0.01);
  // In words the margin has the names of the two between which it is.
  struct Case {
    std::string first, second, margin_from;
  };
  for (const Case& one : {Case{a, b, "b"}, Case{b, a, "a"}}) {
    const std::string arguments = one.first + " " + one.second + " --to " + c;
    EXPECT_THAT(palpate("structures compare " + arguments, false).output,
                HasSubstr(fmt::format("margin            {:.2f} mm from {} to c\n",
                                      compared(arguments)["margin_mm"].get<double>(), one.margin_from)));
  }
}

/// The same outline as SEG, RTSTRUCT and a label map, each by its segment's number or name.
TEST(CommandCompareStructures, ReadsEveryKindOfFile) {
  const fs::path folder = fresh_folder("kinds");
  const io::Series scan = io::testing::write_scan(io::testing::scan_kind("axial"), folder / "scan");
  const io::SignedDistance distance = io::testing::shapes_in(scan.geometry).front().distance;
  for (const std::string name : {"seg.dcm", "rt.dcm", "labels.nii.gz"}) {
    const auto form = io::form_of(name, name == "rt.dcm");
    write_structure(io::testing::full_label(), scan, scan.geometry, distance, {}, form, folder / name,
                    io::testing::by_test);
  }
  const std::string seg = (folder / "seg.dcm").string(), rt = (folder / "rt.dcm").string();
  const std::string labels = (folder / "labels.nii.gz").string();
  const Json same = compared(seg + ":1 '" + seg + ":" + io::testing::full_label().name + "'");
  EXPECT_EQ(same["dice"], 1);
  EXPECT_LT(same["largest_mm"].get<double>(), 1e-3);
  EXPECT_GT(compared(seg + " " + labels + ":1")["dice"].get<double>(), 0.999);
  const Json others = compared(seg + " " + rt);
  EXPECT_GT(others["dice"].get<double>(), 0.93);
  EXPECT_LT(others["mean_mm"].get<double>(), 0.4);
}

double told(const std::string& said, const std::string& what) {
  const std::size_t at = said.find(what);
  return at == std::string::npos ? NAN : std::strtod(said.c_str() + at + what.size(), nullptr);
}

/// plastimatch compares voxels: its edge is a staircase of half a voxel, and its distances are from center to center.
TEST(CommandCompareStructures, AgreesWithPlastimatchToAVoxel) {
  if (std::system("command -v plastimatch >/dev/null 2>&1") != 0) GTEST_SKIP() << "plastimatch is not installed";
  const fs::path folder = fresh_folder("plastimatch");
  const io::Geometry fine = grid({64, 60, 56}, {0.8, 0.8, 0.8}, 0);
  const io::SignedDistance cut = [](const Vec3& p) {
    return std::min(ball(ball_center, 14)(p), ball_center.x + 9 - p.x);  // a cap cut off
  };
  const std::string a = write_labels(folder / "a.mha", fine, ball(ball_center, 14));
  const std::string b = write_labels(folder / "b.mha", fine, cut);
  const Json json = compared(a + " " + b);
  const std::string said = testing::output_of("plastimatch dice --all '" + a + "' '" + b + "' 2>&1");
  EXPECT_NEAR(json["dice"].get<double>(), told(said, "DICE:"), 0.01) << said;
  EXPECT_NEAR(json["largest_mm"].get<double>(), told(said, "Hausdorff distance (boundary) ="), 0.8) << said;
  EXPECT_NEAR(json["mean_mm"].get<double>(), told(said, "Avg average Hausdorff distance (boundary) ="), 0.3) << said;
  EXPECT_NEAR(json["largest_mm"].get<double>(), 5, 0.4) << "the cap's height";
}

TEST(CommandCompareStructures, IsRefusedInWords) {
  const fs::path folder = fresh_folder("refused");
  testing::write_contours(folder / "a.dcm", "1.2", "7", "Doe^Jane");
  testing::write_contours(folder / "b.dcm", "1.3", "7", "Doe^Jane");
  const std::string a = (folder / "a.dcm").string(), b = (folder / "b.dcm").string();
  const auto refused = [](const std::string& arguments, int exit, const char* why) {
    const Outcome outcome = palpate("structures compare " + arguments);
    EXPECT_EQ(outcome.exit, exit) << outcome.output;
    EXPECT_TRUE(says(outcome.output, why));
  };
  const char* const apart =
      "a.dcm and b.dcm lie in different frames of reference: nothing says how one lies in the other";
  refused(a + " " + b, 1, apart);
  refused(a + " " + a + " --to " + b, 1, apart);
  refused(a + " " + a + ":7", 1, "{} has no \"{}\"; there are: 1 Cube");
  refused(a + " /no/such.dcm", 1, "/no/such.dcm");
  std::ofstream(folder / "text.dcm") << "none";
  refused(a + " " + (folder / "text.dcm").string(), 1, "{} holds no structures{}");
  std::ofstream(folder / "two.mha") << "NDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n"
                                    << std::string(32, '\1') << std::string(32, '\2');
  refused(a + " " + (folder / "two.mha").string(), 2,
          "{} holds several structures: name one by its number or name, as {}:NUMBER; there are: 1 label 1, 2 label 2");
  refused(a, 2, "B is required");
  // The command that it stands under goes on as it was.
  EXPECT_EQ(palpate("structures").exit, 2);
  EXPECT_EQ(palpate("structures --json " + a, false).exit, 0);
}

}  // namespace
}  // namespace palpate::plugin
