// A complete correction on real scans: an outline is falsified, `palpate suspects` finds the place, a trace corrects
// it, and the written file is read again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "io/archive/testing/says.h"
#include "io/structures/label_image.h"
#include "io/structures/outline_places.h"
#include "io/structures/structure.h"
#include "io/testing/outlined_scan.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using io::testing::says;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::palpate;

const fs::path outlines = fs::path(PALPATE_SHARED_DATA) / "structures";

constexpr const char* no_outlines =
    "needs the shared structures, outlined real scans, which are not beside this checkout at " PALPATE_SHARED_DATA;

std::string edits_in(const fs::path& folder, const std::vector<Json>& edits) {
  std::ofstream(folder / "edits.json") << Json{{"version", 1}, {"edits", Json(edits)}};
  return (folder / "edits.json").string();
}

/// A trace of the true edge by a hand that trembles by 0.2 mm.
Json trace_of(const std::vector<io::Vec3>& edge, double reach_mm) {
  std::mt19937 random(44);
  std::normal_distribution<double> tremor(0, 0.2);
  Json points = Json::array();
  for (const io::Vec3& at : edge) {
    points.push_back({at.x + tremor(random), at.y + tremor(random), at.z + tremor(random)});
  }
  return {{"type", "trace"}, {"points_mm", points}, {"reach_mm", reach_mm}};
}

TEST(SharedCorrect, ALiverWhoseCapWasCutOffIsFoundMendedWrittenAndReadAgain) {
  if (!fs::exists(outlines)) GTEST_SKIP() << no_outlines;
  const fs::path ct = outlines / "totalsegmentator" / "example_ct_dicom";
  const fs::path labels = outlines / "totalsegmentator" / "example_seg_dicom.nii.gz";
  const fs::path folder = testing::fresh_path("shared_correct");
  fs::create_directories(folder);
  const io::Series series = io::find_series(std::array{ct}).series.at(0);
  const auto all = io::find_structures(std::array{labels}).structures;
  const io::Structure liver = *std::ranges::find(all, "liver", &io::Structure::name);
  const io::Geometry& scan = series.geometry;
  io::DistanceOptions near;
  near.scan = &scan;
  near.reach_mm = 8;
  const auto truth = io::load_distance(liver, near);

  // The outermost 5 mm towards the patient's right, in the middle slices.
  const double middle = 0.5 * (scan.slice_positions.front().z + scan.slice_positions.back().z);
  const std::vector<io::OutlinePlace> edge = io::outline_places(*truth, 2);
  double right = 1e9;
  for (const io::OutlinePlace& place : edge) {
    if (std::abs(place.place_mm.z - middle) < 10) right = std::min(right, place.place_mm.x);
  }
  const double plane = right + 5;
  const auto cut = [&](const io::Vec3& at) { return std::min(truth->sample(at).mm, at.x - plane); };
  const std::string cut_file = (folder / "cut.nii.gz").string();
  write_label_map(sample_labels(io::label_of(liver), scan, cut), cut_file, io::testing::by_test);

  const Json found =
      Json::parse(palpate("suspects --json " + ct.string() + " --structure " + cut_file, false).output, nullptr, false);
  ASSERT_TRUE(found.is_object());
  std::size_t rank = 0;
  for (const Json& place : found["places"]) {
    ++rank;
    if (std::abs(place["position_mm"][0].get<double>() - plane) < 1.5 && place["normal"][0] < -0.8) break;
  }
  EXPECT_LE(rank, 2U) << found["places"].dump(1);

  std::vector<io::Vec3> traced;
  const double slices_mm = std::abs(scan.slice_positions.back().z - middle);  // beyond them nothing is written
  for (const io::OutlinePlace& place : edge) {
    const bool in_scan = std::abs(place.place_mm.z - middle) < slices_mm - 2;
    if (in_scan && place.place_mm.x < plane + 1) traced.push_back(place.place_mm);
  }
  ASSERT_GT(traced.size(), 50U);
  const std::string mend = edits_in(folder, {trace_of(traced, 12)});
  const auto correct = [&](const std::string& output) {
    return palpate("correct " + ct.string() + " --structure " + cut_file + " --edits " + mend + " -o " +
                   (folder / output).string());
  };
  // This CT is published without UIDs: no image of it can be referred to.
  const Outcome refused = correct("mended.dcm");
  EXPECT_EQ(refused.exit, 1);
  EXPECT_THAT(refused.output, HasSubstr("UID"));
  EXPECT_FALSE(fs::exists(folder / "mended.dcm"));
  const std::array mended_files{"mended.nii.gz", "mended.seg.nrrd"};
  for (const char* name : mended_files) {
    ASSERT_EQ(correct(name).exit, 0) << name;
    const io::Structure mended = io::find_structures(std::array{folder / name}).structures.at(0);
    const auto field = io::load_distance(mended, near);
    double before = 0, after = 0, largest = 0;
    for (const io::Vec3& at : traced) before += std::abs(cut(at)) / static_cast<double>(traced.size());
    for (const io::Vec3& at : traced) {
      const double off = std::abs(field->sample(at).mm);
      after += off / static_cast<double>(traced.size());
      largest = std::max(largest, off);
    }
    std::printf("%s: the edge was off by %.2f mm in the mean, and is by %.2f, %.2f at most\n", name, before, after,
                largest);
    EXPECT_GT(before, 1.5);
    EXPECT_LT(after, 0.5) << "a quarter of a slice";
    EXPECT_LT(largest, 2.2);
  }
}

TEST(SharedCorrect, ASegIsWrittenThatOthersAcceptAndThatIsReadAgainVoxelForVoxel) {
  if (!fs::exists(outlines)) GTEST_SKIP() << no_outlines;
  const fs::path folder = testing::fresh_path("shared_correct_seg");
  fs::create_directories(folder);
  const fs::path liver = outlines / "dcmqi" / "liver.dcm";
  const Json remove{{"type", "remove"}, {"path_mm", {{-105, -33, -127.7}}}, {"radius_mm", 8}};
  const Json add{{"type", "add"}, {"path_mm", {{-60, -33, -127.7}, {-60, 10, -127.7}}}, {"radius_mm", 5}};
  const std::string edits = edits_in(folder, {remove, add});
  for (const char* name : {"mended.dcm", "mended.nii.gz"}) {
    const Outcome outcome = palpate("correct " + (outlines / "dcmqi" / "ct-3slice").string() + " --structure " +
                                    liver.string() + " --edits " + edits + " -o " + (folder / name).string());
    ASSERT_EQ(outcome.exit, 0) << outcome.output;
  }
  const auto compared = [&](const fs::path& a, const fs::path& b) {
    return Json::parse(palpate("structures compare --json " + a.string() + " " + b.string(), false).output);
  };
  const Json both = compared(folder / "mended.dcm", folder / "mended.nii.gz");
  const double volume = both["volume_mm3"][0];  // the spacing of a NIfTI is rounded to 32 bits
  EXPECT_NEAR(volume, both["volume_mm3"][1].get<double>(), 1e-6 * volume);
  EXPECT_LT(both["largest_mm"].get<double>(), 0.05) << "a voxel more would be 0.4";
  EXPECT_GT(compared(liver, folder / "mended.dcm")["largest_mm"].get<double>(), 4);
  const io::Structure mended = io::find_structures(std::array{folder / "mended.dcm"}).structures.at(0);
  EXPECT_EQ(mended.name, "Liver");
  EXPECT_THAT(mended.code, HasSubstr("T-62000"));
  if (testing::output_of("which dciodvfy").find("/dciodvfy") == std::string::npos) {
    GTEST_SKIP() << "dciodvfy is not installed: apt-get install dicom3tools";
  }
  const std::string verdict = testing::output_of("dciodvfy " + (folder / "mended.dcm").string());
  EXPECT_THAT(verdict, HasSubstr("Segmentation"));
  EXPECT_THAT(verdict, Not(HasSubstr("Error")));
}

}  // namespace
}  // namespace palpate::plugin
