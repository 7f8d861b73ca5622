// `palpate correct` as a script uses it: an outline with a missing cap is corrected by a trace, written in every form,
// read again and measured against the truth.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/archive/testing/says.h"
#include "io/structures/label_image.h"
#include "io/structures/structure.h"
#include "io/testing/outlined_scan.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using io::testing::says;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;
using testing::phantom;

constexpr double core_mm = 15;   // of the phantom's bone
constexpr double kept_mm = 9.5;  // along x: the cap beyond it is 5.5 mm high

/// The phantom's core, whole and with its cap cut off, as label maps and as a SEG of the phantom's study.
struct CutCore {
  fs::path folder = testing::fresh_path("cut_core");
  std::string whole = (folder / "whole.nii.gz").string(), cut = (folder / "cut.nii.gz").string();
  std::string cut_seg = (folder / "cut.dcm").string();

  CutCore() {
    fs::create_directories(folder);
    const io::Series scan = io::find_series(std::array{phantom()}).series.at(0);
    const auto core = [](const io::Vec3& at) { return core_mm - glm::length(at); };
    const auto without_cap = [=](const io::Vec3& at) { return std::min(core(at), kept_mm - at.x); };
    const io::StructureLabel label = io::testing::full_label();
    write_label_map(sample_labels(label, scan.geometry, core), whole, io::testing::by_test);
    write_label_map(sample_labels(label, scan.geometry, without_cap), cut, io::testing::by_test);
    write_segmentation(sample_labels(label, scan.geometry, without_cap), scan, cut_seg, io::testing::by_test);
  }

  std::string edits(const std::vector<Json>& list, const std::string& name = "edits.json") const {
    std::ofstream(folder / name) << Json{{"version", 1}, {"edits", Json(list)}};
    return (folder / name).string();
  }
  Outcome correct(const std::string& edits, const std::string& output, const std::string& more = "") const {
    return palpate("correct " + phantom().string() + " --edits " + edits + " -o " + (folder / output).string() + " " +
                   more);
  }
  double largest_mm(const std::string& outline) const {
    const Outcome outcome = palpate("structures compare --json " + whole + " " + outline, false);
    return Json::parse(outcome.output, nullptr, false).value("largest_mm", NAN);
  }
};

/// Rings on the core's cap, from its top down.
Json trace_over_the_cap() {
  Json points = Json::array();
  for (const double down : {0.0, 0.25, 0.5, 0.75}) {
    const int count = down == 0 ? 1 : static_cast<int>(std::ceil(2 * 3.1415927 * core_mm * std::sin(down) / 3));
    for (int n = 0; n < count; ++n) {
      const double around = 2 * 3.1415927 * n / count;
      points.push_back({core_mm * std::cos(down), core_mm * std::sin(down) * std::cos(around),
                        core_mm * std::sin(down) * std::sin(around)});
    }
  }
  return {{"type", "trace"}, {"points_mm", points}, {"reach_mm", 12}};
}

TEST(CommandCorrect, ATraceMendsACapThatWasCutOffInEveryForm) {
  const CutCore core;
  const std::string edits = core.edits({trace_over_the_cap()});
  EXPECT_NEAR(core.largest_mm(core.cut), core_mm - kept_mm, 1) << "half a voxel at both edges";
  for (const std::string name : {"seg.dcm", "rt.dcm", "labels.nii.gz", "labels.seg.nrrd", "labels.mha"}) {
    const Outcome outcome =
        core.correct(edits, name, "--structure " + core.cut + (name == "rt.dcm" ? " --rtstruct" : ""));
    ASSERT_EQ(outcome.exit, 0) << name << outcome.output;
    EXPECT_THAT(outcome.output,
                ::testing::ContainsRegex("edit 1: trace: the edge moved by [56][.]"));  // the cap, and half a voxel
    EXPECT_LT(core.largest_mm((core.folder / name).string()), 1.1) << name;
  }
  EXPECT_EQ(io::find_structures(std::array{core.folder / "seg.dcm"}).structures.at(0).kind,
            io::StructureKind::segmentation);
  EXPECT_EQ(io::find_structures(std::array{core.folder / "rt.dcm"}).structures.at(0).kind, io::StructureKind::contours);
}

TEST(CommandCorrect, ASegKeepsItsNameAndCodesAndTheFileThatWasCorrectedStays) {
  const CutCore core;
  const auto bytes = [&] {
    std::ifstream file(core.cut_seg, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string before = bytes();
  // The trace leaves a few tenths; the scan's own edge is known better.
  const Json scan_edge{{"type", "scan_edge"}, {"center_mm", {15, 0, 0}}, {"radius_mm", 14}, {"most_mm", 2}};
  const std::string edits = core.edits({trace_over_the_cap(), scan_edge});
  const Outcome outcome = core.correct(edits, "mended.dcm", "--structure " + core.cut_seg + ":1");
  ASSERT_EQ(outcome.exit, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("edit 2: scan_edge: the edge moved by "));
  const io::Structure mended = io::find_structures(std::array{core.folder / "mended.dcm"}).structures.at(0);
  EXPECT_EQ(mended.name, io::testing::full_label().name);
  EXPECT_THAT(mended.code, HasSubstr("10200004"));
  EXPECT_LT(core.largest_mm((core.folder / "mended.dcm").string()), 1.1);
  EXPECT_EQ(bytes(), before);
  EXPECT_EQ(core.correct(edits, "cut.dcm", "--force --structure " + core.cut_seg).exit, 1) << "even with --force";
  EXPECT_EQ(bytes(), before);
}

TEST(CommandCorrect, PathsAreAddedAndRemoved) {
  const CutCore core;
  const Json add{{"type", "add"}, {"path_mm", {{0, 0, 0}, {0, 20, 0}}}, {"radius_mm", 4}};
  const Json remove{{"type", "remove"}, {"path_mm", {{0, 0, 0}, {0, -20, 0}}}, {"radius_mm", 4}};
  ASSERT_EQ(core.correct(core.edits({add}), "added.mha", "--structure " + core.whole).exit, 0);
  EXPECT_NEAR(core.largest_mm((core.folder / "added.mha").string()), 20 + 4 - core_mm, 0.7);
  ASSERT_EQ(core.correct(core.edits({remove}), "removed.mha", "--structure " + core.whole).exit, 0);
  EXPECT_GT(core.largest_mm((core.folder / "removed.mha").string()), 8);
}

// A ball on the core's surface bulges by its radius, and one that lies farther out by as much more.
TEST(CommandCorrect, SaysHowFarABallMovesTheEdge) {
  const CutCore core;
  for (const double outside : {0.0, 2.0}) {
    for (const std::string type : {"add", "remove"}) {
      const double at = type == "add" ? core_mm + outside : core_mm - outside;
      const Json ball{{"type", type}, {"path_mm", {{0, at, 0}}}, {"radius_mm", 4}};
      const Outcome outcome = core.correct(core.edits({ball}), "ball.mha", "--force --structure " + core.whole);
      ASSERT_EQ(outcome.exit, 0) << outcome.output;
      const std::string before = "edit 1: " + type + ": the edge moved by ";
      const std::size_t found = outcome.output.find(before);
      ASSERT_NE(found, std::string::npos) << outcome.output;
      EXPECT_NEAR(std::stod(outcome.output.substr(found + before.size())), 4 + outside, 0.3) << type;
    }
  }
}

// A ball within the bone is 10 mm from any edge of the scan: at none of its places there is one.
TEST(CommandCorrect, SaysAtHowManyPlacesTheScanHasNoEdge) {
  const CutCore core;
  const io::Series scan = io::find_series(std::array{phantom()}).series.at(0);
  const std::string small = (core.folder / "small.nii.gz").string();
  const auto ball = [](const io::Vec3& at) { return 5 - glm::length(at); };
  write_label_map(sample_labels(io::testing::full_label(), scan.geometry, ball), small, io::testing::by_test);
  for (const double radius_mm : {4.0, 12.0}) {
    const Json edge{{"type", "scan_edge"}, {"center_mm", {5, 0, 0}}, {"radius_mm", radius_mm}, {"most_mm", 2}};
    const Outcome outcome = core.correct(core.edits({edge}), "small.mha", "--force --structure " + small);
    ASSERT_EQ(outcome.exit, 0) << outcome.output;
    const std::string before = "edit 1: scan_edge: the edge moved by 0.00 mm at most; ";
    const std::size_t found = outcome.output.find(before);
    ASSERT_NE(found, std::string::npos) << outcome.output;
    const int places = std::stoi(outcome.output.substr(found + before.size()));
    EXPECT_GT(places, 5);
    EXPECT_THAT(outcome.output, HasSubstr(before + std::to_string(places) + " places of it were looked at; at " +
                                          std::to_string(places) + " the scan has no edge, and it stays\n"));
  }
}

TEST(CommandCorrect, ContoursMakeANewOneInEveryForm) {
  const CutCore core;
  Json loops = Json::array();
  for (double z = -14.5; z < 15; z += 1) {
    Json loop = Json::array();
    const double radius = std::sqrt(core_mm * core_mm - z * z);
    for (int n = 0; n < 90; ++n) {
      loop.push_back({radius * std::cos(0.0698132 * n), radius * std::sin(0.0698132 * n), z});
    }
    loops.push_back(loop);
  }
  const Json contours{{"type", "contours"}, {"loops_mm", loops}};
  const std::string edits = core.edits({contours});
  for (const std::string name : {"anew.dcm", "anew-rt.dcm", "anew.nii.gz", "anew.seg.nrrd", "anew.nrrd", "anew.mha"}) {
    const Outcome outcome = core.correct(edits, name, name == "anew-rt.dcm" ? "--rtstruct" : "");
    ASSERT_EQ(outcome.exit, 0) << name << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(name == "anew-rt.dcm" ? "\"anew-rt\"" : "\"anew\"")) << name;
    EXPECT_THAT(outcome.output, HasSubstr("edit 1: contours: a new outline, through "));
    const std::string written = (core.folder / name).string();
    EXPECT_LT(core.largest_mm(written), 1.1) << name;
    const auto found = io::find_structures(std::array{fs::path(written)}).structures;
    ASSERT_EQ(found.size(), 1U) << name;
    if (name.ends_with(".dcm") || name.ends_with(".seg.nrrd")) {
      EXPECT_EQ(found[0].name, name == "anew-rt.dcm" ? "anew-rt" : "anew");
      EXPECT_EQ(found[0].color, "#e69f00") << name;
    }
  }
  ASSERT_EQ(core.correct(edits, "named.dcm", "--name \"Left lobe\"").exit, 0);
  EXPECT_EQ(io::find_structures(std::array{core.folder / "named.dcm"}).structures.at(0).name, "Left lobe");
  // Names and files with colons, as planning systems write them.
  for (const std::string name : {"PTV:60", "Heart: left", "a:b:c", ":"}) {
    const std::string file = (name.size() > 5 ? "colons:" : "plain") + std::to_string(name.size()) + ".dcm";
    ASSERT_EQ(core.correct(edits, "\"" + file + "\"", "--name \"" + name + "\"").exit, 0) << name;
    const std::string whole = "\"" + (core.folder / file).string();
    EXPECT_LT(core.largest_mm(whole + ":" + name + "\""), 1.1) << name;
    EXPECT_LT(core.largest_mm(whole + "\""), 1.1) << name;
    EXPECT_LT(core.largest_mm(whole + ":1\""), 1.1) << name;
  }
  const Outcome both = core.correct(edits, "both.dcm", "--name Lobe --structure " + core.whole);
  EXPECT_EQ(both.exit, 2) << both.output;
  const Outcome of_a_file = core.correct(edits, "both.dcm", "--structure " + core.whole);
  EXPECT_EQ(of_a_file.exit, 1);
  EXPECT_TRUE(says(
      of_a_file.output,
      "edit 1: contours: contours make a new structure: they have to be the first edit of a structure without a file"));
  EXPECT_FALSE(fs::exists(core.folder / "both.dcm"));
}

TEST(CommandCorrect, IsRefusedInWordsAndWritesNothing) {
  const CutCore core;
  const std::string structure = "--structure " + core.cut;
  const auto refused = [&](const std::string& edits, const std::string& more, int exit, const char* why,
                           const std::string& output = "none.dcm") {
    const Outcome outcome = core.correct(edits, output, more);
    EXPECT_EQ(outcome.exit, exit) << outcome.output;
    EXPECT_TRUE(says(outcome.output, why));
    EXPECT_FALSE(fs::exists(core.folder / "none.dcm"));
  };
  const std::string good = core.edits({trace_over_the_cap()});
  refused("/no/such.json", structure, 1, "/no/such.json: no such file of edits can be read");
  refused(core.edits({{{"type", "cut"}}}, "type.json"), structure, 1,
          "type.json: edits[0].type: there is no \"cut\"; there are: trace, add, remove, scan_edge, contours");
  const Json far{{"type", "trace"}, {"points_mm", {{28, 0, 0}}}, {"reach_mm", 4}};
  refused(
      core.edits({far}, "far.json"), structure, 1,
      "far.json: edit 1: trace: its point 1 lies {} mm from the edge and its reach is 4 mm: give it a larger reach, "
      "or add what is missing (\"add\")");
  refused(good, "", 2,
          "the edits do not begin with contours of a new structure: name the one that they correct (--structure)");
  refused(good, "--structure " + core.cut + ":9", 1, "{} has no \"9\"; there are: ");
  refused(good, structure, 1, "has no known file name extension", "outline.stl");
  refused(good, structure + " --rtstruct", 1, "contours (RTSTRUCT) are written only as DICOM", "outline.mha");
  // Never over an existing file unasked.
  const fs::path there = core.folder / "there.mha";
  std::ofstream(there) << "mine";
  refused(good, structure, 1, "{} exists: name another file, or ask for it to be overwritten", "there.mha");
  EXPECT_EQ(fs::file_size(there), 4U);
  EXPECT_EQ(core.correct(good, "there.mha", structure + " --force").exit, 0);
  EXPECT_GT(fs::file_size(there), 1000U);
}

}  // namespace
}  // namespace palpate::plugin
