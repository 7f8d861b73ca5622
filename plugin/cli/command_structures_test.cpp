// `palpate structures` as a script uses it, against the results of pydicom and numpy for the shared segmentations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plugin/recording/recording.h"
#include "plugin/structures/structure_files.h"
#include "plugin/testing/command_rig.h"
#include "plugin/testing/kept_out.h"
#include "plugin/testing/opened_files.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::forehead;
using testing::fresh_path;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;
using testing::phantom;

const fs::path shared = fs::path(PALPATE_SHARED_DATA) / "structures";

TEST(SharedCommandStructures, SaysWhatTheTruthSays) {
  std::ifstream file(shared / "truth.json");
  if (!file) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const Json truth = Json::parse(file);
  for (const std::string name : {"dcmqi/liver.dcm", "dcmqi/24x38x3/seg/label.seg"}) {
    SCOPED_TRACE(name);
    const Outcome outcome = palpate("structures --json " + (shared / name).string(), false);
    ASSERT_EQ(outcome.exit, 0);
    const Json found = Json::parse(outcome.output).at("structures").at(0);
    const Json& wanted = truth.at(name).at("segments").at("1");
    EXPECT_EQ(found.at("kind"), "SEG");
    EXPECT_EQ(found.at("number"), 1);
    EXPECT_EQ(found.at("name"), wanted.at("name"));
    EXPECT_EQ(found.at("voxels"), wanted.at("voxels"));
    EXPECT_NEAR(found.at("volume_mm3").get<double>(), wanted.at("mm3").get<double>(), 0.01);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(found.at("centroid_mm").at(axis).get<double>(), wanted.at("centroid").at(axis).get<double>(), 1e-3);
      EXPECT_NEAR(found.at("box_mm").at(0).at(axis).get<double>(), wanted.at("low").at(axis).get<double>(), 1e-3);
      EXPECT_NEAR(found.at("box_mm").at(1).at(axis).get<double>(), wanted.at("high").at(axis).get<double>(), 1e-3);
    }
  }
}

/// The shared liver beside a scene of these modes, which names it by the file alone.
fs::path scene_beside_liver(const std::string& segment, const std::string& modes) {
  const fs::path folder = fresh_path("liver");
  fs::create_directories(folder);
  fs::copy_file(shared / "dcmqi/liver.dcm", folder / "liver.dcm");
  std::ofstream(folder / "scene.json") << R"({"version": 1, "structures": [
    {"name": "liver", "file": "liver.dcm", "segment": )"
                                       << segment << R"(}, {"name": "unread", "file": "liver.dcm", "segment": 1}],
    "modes": [)" << modes << "]}";
  return folder / "scene.json";
}

// In the label map that the segmentation was made of (liver_seg.nrrd), row 290 of the middle slice is liver from column
// 81 to 203: the row is crossed there along x.
const std::string into_liver = " --from -180,8.2586,-127.69 --to -165,8.2586,-127.69 --scene ";
constexpr double last_outside_mm = -235.2 + 80 * 0.810547, first_inside_mm = -235.2 + 81 * 0.810547;
const std::string liver_edge = R"({"type": "surface", "structure": "liver", "strength_n": 1})";

TEST(SharedCommandStructures, AreFeltAtTheirEdge) {
  if (!fs::exists(shared)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const fs::path scene = scene_beside_liver("\"Liver\"", liver_edge);
  const Outcome outcome =
      palpate("profile --json " + (shared / "dcmqi/ct-3slice").string() + into_liver + scene.string(), false);
  ASSERT_EQ(outcome.exit, 0);
  const Json stroke = Json::parse(outcome.output);
  const Json& distances = stroke.at("distance_mm").at("liver");
  ASSERT_EQ(distances.size(), stroke.at("position_mm").size());
  EXPECT_FALSE(stroke.at("distance_mm").contains("unread"));
  EXPECT_LT(distances.front().get<double>(), -5);
  EXPECT_GT(distances.back().get<double>(), 2);
  double most = 0;
  for (std::size_t n = 0; n < distances.size(); ++n) {
    const double x = stroke.at("proxy_mm").at(n).at(0);
    const double force =
        std::hypot(stroke.at("force_n").at(n).at(0).get<double>(), stroke.at("force_n").at(n).at(1).get<double>(),
                   stroke.at("force_n").at(n).at(2).get<double>());
    if (x < last_outside_mm - 0.2) {
      EXPECT_LT(force, 1e-6) << x;
    }
    if (x < last_outside_mm) {
      EXPECT_LT(distances[n].get<double>(), 0) << x;
    }
    if (x > first_inside_mm && x < first_inside_mm + 1) {
      EXPECT_GT(distances[n].get<double>(), 0) << x;
    }
    most = std::max(most, force);
  }
  EXPECT_GT(most, 0.8);
  EXPECT_LT(most, 1 + 1e-6);
}

// From the liver by stomach and bowel, which are as bright, into the spleen: the stroke and the scene of README.md.
TEST(SharedCommandStructures, LiverIsFeltAgainstSpleenAndBesideTheScansOwnEdges) {
  if (!fs::exists(shared)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const std::string labels = (shared / "totalsegmentator/example_seg_dicom.nii.gz").string();
  const fs::path scene = fresh_path("liver_spleen.json");
  std::ofstream(scene) << R"({"version": 1, "structures": [{"name": "liver", "segment": "liver", "file": ")" << labels
                       << R"("}, {"name": "spleen", "segment": "spleen", "file": ")" << labels << R"("}],
    "modes": [{"type": "surface", "structure": "liver", "side": "both", "strength_n": 1.2},
              {"type": "surface", "structure": "spleen", "side": "both", "strength_n": 0.6}]})";
  const Outcome outcome = palpate("profile --json " + (shared / "totalsegmentator/example_ct_dicom").string() +
                                      " --scene " + scene.string() + " --from=-20,-200,-785 --to 125,-115,-785",
                                  false);
  ASSERT_EQ(outcome.exit, 0) << outcome.output;
  const Json stroke = Json::parse(outcome.output);
  const Json& met = stroke.at("met");
  ASSERT_EQ(met.size(), 2U);
  EXPECT_EQ(met[0].at("boundary"), "liver");
  EXPECT_EQ(met[1].at("boundary"), "spleen");
  EXPECT_GT(met[0].at("peak_n"), 1.0);
  EXPECT_NEAR(met[1].at("peak_n").get<double>(), 0.6, 0.01);
  const Json& crossings = stroke.at("crossings");
  ASSERT_EQ(crossings.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(crossings[n].at("structure"), met[n].at("boundary"));
    EXPECT_EQ(crossings[n].at("entering"), n == 1);
    EXPECT_NEAR(crossings[n].at("depth_mm").get<double>(), met[n].at("depth_mm").get<double>(), 0.3);
    EXPECT_EQ(crossings[n].at("scan_edge_within_mm"), 5);
  }
  // The liver ends in fat, darker by more than 100 HU. The stomach's wall lies on the spleen: nothing tells them apart.
  EXPECT_NEAR(crossings[0].at("scan_edge_mm").get<double>(), 0, 1.0);
  EXPECT_LT(crossings[0].at("scan_edge_rise"), -100);
  EXPECT_GT(crossings[0].at("scan_edge_known_to_mm"), 0);
  for (const char* const key : {"scan_edge_mm", "scan_edge_rise", "scan_edge_known_to_mm"}) {
    EXPECT_TRUE(crossings[1].at(key).is_null()) << key;
  }
}

// Through the margin and into what is to be kept out of.
TEST(SharedCommandStructures, AKeepOutIsRecordedAndRepeatedToTheLastBit) {
  if (!fs::exists(shared)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const std::string ct = (shared / "totalsegmentator/example_ct_dicom").string();
  const fs::path folder = fresh_path("aorta");
  fs::create_directories(folder);
  fs::copy_file(shared / "totalsegmentator/example_seg_dicom.nii.gz", folder / "labels.nii.gz");
  const fs::path scene = folder / "scene.json";
  std::ofstream(scene)
      << R"({"version": 1, "structures": [{"name": "aorta", "file": "labels.nii.gz", "segment": "aorta"}],
    "modes": [{"type": "keep_out", "structure": "aorta", "margin_mm": 3, "strength_n": 2}]})";
  const fs::path out = fresh_path("kept_out"), csv = fresh_path("kept_out.csv");
  // truth.json has the aorta's voxels from 165 to 130 mm before the origin.
  ASSERT_EQ(
      palpate("probe " + ct + " --from 8,-185,-785 --to 8,-147,-785 --scene " + scene.string() + " -o " + out.string())
          .exit,
      0);
  const Recording recording = read_recording(out / "recording.h5");
  ASSERT_EQ(recording.scenes.size(), 1U);
  const auto [deepest_mm, most_n] = testing::kept_out_of("aorta", recording);
  for (const TickRecord& tick : recording.ticks) EXPECT_TRUE(std::isnan(tick.distance_mm[1]));
  EXPECT_GT(deepest_mm, 0);
  EXPECT_GT(most_n, 1);
  EXPECT_LE(most_n, 2 + 1e-9);
  EXPECT_THAT(testing::text_in(out / "summary.txt"), HasSubstr("mm inside aorta, at "));
  testing::expect_repeated_with_moved(folder / "labels.nii.gz", "aorta", out / "recording.h5", ct,
                                      " --csv " + csv.string());
  const std::string table = testing::text_in(csv);
  EXPECT_THAT(table.substr(0, table.find('\n')), ::testing::EndsWith(",\"distance_mm aorta\""));
}

TEST(SharedCommandStructures, AreLeftOutWhereNoModeReadsThem) {
  if (!fs::exists(shared)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const Outcome outcome = palpate("plan --json " + (shared / "dcmqi/ct-3slice").string() + " --scene " +
                                  scene_beside_liver("1", liver_edge).string());
  EXPECT_THAT(outcome.output, HasSubstr(R"(structure \"unread\")"));
  EXPECT_THAT(outcome.output, ::testing::Not(HasSubstr(R"(structure \"liver\")")));
}

TEST(SharedCommandStructures, OfASceneAreRefusedInWords) {
  if (!fs::exists(shared)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const std::string ct = (shared / "dcmqi/ct-3slice").string();
  const fs::path unknown = scene_beside_liver("\"Spleen\"", liver_edge);
  const Outcome outcome = palpate("profile " + ct + into_liver + unknown.string());
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.output, HasSubstr("structure \"liver\": liver.dcm has no \"Spleen\"; there are: 1 Liver"));
  const fs::path scene = scene_beside_liver("1", liver_edge);
  const Outcome elsewhere = palpate("profile " + phantom().string() + forehead + "--scene " + scene.string());
  EXPECT_EQ(elsewhere.exit, 1);
  EXPECT_THAT(elsewhere.output,
              HasSubstr("structure \"liver\": liver.dcm was outlined on another patient than the scan's: choose one "
                        "that was outlined on this study"));
  fs::copy_file(fs::path(ct) / "01.dcm", scene.parent_path() / "liver.dcm", fs::copy_options::overwrite_existing);
  const Outcome none = palpate("profile " + ct + into_liver + scene.string());
  EXPECT_EQ(none.exit, 1);
  EXPECT_THAT(none.output, HasSubstr("liver.dcm holds no structures"));
}

// The scene names what can be felt, and the text what cannot, too.
TEST(SharedCommandStructures, AreOfferedWithWhatIsSuggested) {
  if (!fs::exists(shared)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const std::string suggest = "suggest " + (shared / "totalsegmentator/example_ct_dicom").string() + " --structures " +
                              (shared / "totalsegmentator/example_seg_dicom.nii.gz").string() + " " +
                              (shared / "dcmqi/liver.dcm").string();
  const Outcome json = palpate(suggest, false);
  ASSERT_EQ(json.exit, 0);
  const Json scene = Json::parse(json.output);
  std::ifstream file(shared / "truth.json");
  const Json wanted = Json::parse(file).at("totalsegmentator/example_seg_dicom.nii.gz").at("segments");
  ASSERT_EQ(scene.at("structures").size(), wanted.size());
  for (const Json& offered : scene.at("structures")) {
    EXPECT_TRUE(wanted.contains(std::to_string(offered.at("segment").get<int>()))) << offered;
    EXPECT_EQ(offered.at("file"), (shared / "totalsegmentator/example_seg_dicom.nii.gz").string());
  }
  const fs::path out = fresh_path("suggested");
  fs::create_directories(out);
  const Outcome text = palpate(suggest + " -o " + (out / "scene.json").string(), false);
  ASSERT_EQ(text.exit, 0);
  EXPECT_THAT(text.output, HasSubstr("structures of the study\n"));
  EXPECT_THAT(text.output, HasSubstr("label map, example_seg_dicom.nii.gz"));
  EXPECT_THAT(text.output, HasSubstr("cannot be felt: liver.dcm lies in another frame of reference than the scan"));
  EXPECT_THAT(text.output, HasSubstr(R"(one is felt where a mode names it: {"type":"surface","structure":")"));
  // The scene is felt as any other: no mode reads a structure of it.
  const Outcome plan = palpate("plan " + (shared / "totalsegmentator/example_ct_dicom").string() + " --scene " +
                               (out / "scene.json").string());
  EXPECT_EQ(plan.exit, 0) << plan.output;
}

TEST(CommandStructures, TellsWhatARegistrationMoves) {
  const fs::path study = fresh_path("registered") / "study";  // registrations are looked for beside it, too
  testing::write_contours(study / "rt.dcm", "1.2", "7", "Doe^Jane");
  testing::write_registration(study / "reg.dcm");
  const std::string hash = hash_of_file(study / "reg.dcm");
  const Outcome text = palpate("structures " + study.string(), false);
  EXPECT_EQ(text.exit, 0);
  EXPECT_THAT(text.output, HasSubstr("reg.dcm: registration " + hash + " to frame of reference 1.1\n"));
  EXPECT_THAT(text.output, HasSubstr("moves what lies in 1.2 by 100.0, 0.0, 0.0 mm\n"));
  const Json json = Json::parse(palpate("structures --json " + study.string(), false).output).at("registrations");
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0].at("hash"), hash);
  EXPECT_EQ(json[0].at("to_frame_of_reference_uid"), "1.1");
  EXPECT_EQ(json[0].at("parts")[0].at("frame_of_reference_uid"), "1.2");
}

/// Contours have a color and no code.
TEST(CommandStructures, TellsAColorAsTheColor) {
  const fs::path file = fresh_path("colored") / "rt.dcm";
  testing::write_contours(file, "1.2", "7", "Doe^Jane");
  DcmFileFormat contours;
  io::internal::succeed(contours.loadFile(file.c_str()));
  DcmItem* drawn = nullptr;
  io::internal::succeed(contours.getDataset()->findOrCreateSequenceItem(DCM_ROIContourSequence, drawn, 0));
  io::internal::succeed(drawn->putAndInsertString(DCM_ROIDisplayColor, "255\\0\\128"));
  io::internal::succeed(contours.saveFile(file.c_str()));
  const Json json = Json::parse(palpate("structures --json " + file.string(), false).output).at("structures").at(0);
  EXPECT_EQ(json.at("color"), "#ff0080");
  EXPECT_EQ(json.at("code"), "");
}

// Two label maps of 4 mm each: one in the middle of the scan, and one 500 mm beside it.
TEST(CommandStructures, SaysWhichLieOffTheScan) {
  const fs::path folder = fresh_path("off");
  fs::create_directories(folder);
  for (const auto& [name, x] : {std::pair{"here", "0"}, std::pair{"off", "500"}}) {
    std::ofstream(folder / (std::string(name) + ".mha"))
        << "NDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nOffset = " << x << " 0 0\nElementDataFile = LOCAL\n"
        << std::string(64, '\1');
  }
  const std::string off =
      "note: off.mha: \"off\" lies wholly outside the scan: choose one that was outlined on this scan\n";
  const auto times_in = [](const std::string& part, const std::string& output) {
    int count = 0;
    for (std::size_t at = output.find(part); at != std::string::npos; at = output.find(part, at + 1)) ++count;
    return count;
  };
  const std::string listed = palpate("structures " + folder.string() + " --scan " + phantom().string(), false).output;
  EXPECT_THAT(listed, HasSubstr(off));
  EXPECT_EQ(times_in("wholly outside", listed), 1) << listed;
  EXPECT_THAT(palpate("structures " + folder.string(), false).output, ::testing::Not(HasSubstr("wholly outside")));
  const Outcome suggested = palpate(
      "suggest " + phantom().string() + " --structures " + folder.string() + " -o " + (folder / "scene.json").string(),
      false);
  EXPECT_EQ(suggested.exit, 0);
  EXPECT_THAT(suggested.output, HasSubstr(off));
  EXPECT_EQ(times_in("wholly outside", suggested.output), 1) << suggested.output;
}

// However many structures ask: what lies beside them is read once for all.
TEST(CommandStructures, FilesBesideStructuresAreReadOnceForAllOfThem) {
  for (const int structures : {1, 4}) {
    const fs::path study = fresh_path("beside") / "study";
    for (int n = 0; n < structures; ++n) {
      testing::write_contours(study / "outlines" / ("rt" + std::to_string(n) + ".dcm"), "1.2", "7", "Doe^Jane");
    }
    testing::write_registration(study / "images" / "reg.dcm");
    for (int n = 0; n < 5; ++n) io::internal::write({}, study / "images" / ("slice" + std::to_string(n)));
    const std::string outlines = (study / "outlines").string();
    testing::OpenedFiles opened({study / "images"});
    for (const std::string& command :
         {"structures " + outlines + " --scan " + phantom().string(),
          "suggest " + phantom().string() + " --structures " + outlines + " -o " + (study / "scene.json").string()}) {
      EXPECT_EQ(palpate(command).exit, 0) << command;
      const auto count = opened.count();
      EXPECT_EQ(count.size(), 6U) << command;
      for (const auto& [file, times] : count) EXPECT_EQ(times, 1) << file << ": " << command;
    }
  }
}

TEST(CommandStructures, SaysWhereThereAreNone) {
  const fs::path folder = fresh_path("no_structures");
  fs::create_directories(folder);
  const Outcome outcome = palpate("structures " + folder.string(), true);
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.output,
              HasSubstr("no structures in what was given: no DICOM SEG, RTSTRUCT or label map that can be read"));
}

}  // namespace
}  // namespace palpate::plugin
