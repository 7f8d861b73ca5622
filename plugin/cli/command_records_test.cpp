/// The numbers and words that commands print about paths, recordings, marks, structures, series, archives and devices,
/// against an independent calculation.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "device/device_type.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/run_session.h"
#include "plugin/options/series_option.h"
#include "plugin/recording/recorded_session.h"
#include "plugin/recording/recording.h"
#include "plugin/report/summary.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/stroke.h"
#include "plugin/testing/command_rig.h"
#include "plugin/testing/expect_near.h"
#include "plugin/testing/registered_study.h"
#include "solver/solution.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::expect_near;
using testing::fresh_path;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;
using testing::phantom;

/// From the patient's front, which is low y, at three quarters of the height: on to the ball of 25 mm and as far as its
/// middle.
TEST(CommandNumbers, WithoutAPlaceAHandPressesFromTheFrontAtThreeQuartersOfTheHeight) {
  const fs::path out = fresh_path("default_path");
  ASSERT_EQ(palpate("probe " + phantom().string() + " --scene ct-skin-and-bone -o " + out.string()).exit, 0);
  EXPECT_THAT(palpate("probe --help").output, HasSubstr("(default: the front, at 3/4 of the scan's height)"));
  const RecordedSession session(read_recording(out / "recording.h5"),
                                load_series({.path = phantom().string(), .series = {}}));
  EXPECT_NEAR(session.duration_s(), 12, 0.01) << "the whole script";
  const double high_mm = -29.5 + 0.75 * 59, deep_mm = -std::sqrt(25 * 25 - high_mm * high_mm);
  for (const std::size_t n : {std::size_t{500}, session.size() - 1}) {
    EXPECT_LT(glm::distance(session.probe_mm(n), glm::dvec3(0, deep_mm - 8, high_mm)), 1.5) << n;
  }
  double deepest_mm = -100;
  for (std::size_t n = 0; n < session.size(); ++n) deepest_mm = std::max(deepest_mm, session.probe_mm(n).y);
  EXPECT_GT(deepest_mm, deep_mm + 2) << "through the skin";
}

/// A point of the path that the stylus cannot reach is named with its time and place.
TEST(CommandNumbers, APathOutOfReachIsRefusedWithItsTimeAndPlace) {
  const fs::path path = fresh_path("far.csv");
  std::ofstream(path) << "0,0,-90,0\n0.75,0,90,12.5\n";
  const fs::path scene = fresh_path("fixed.json");
  std::ofstream(scene) << R"({"version": 1, "workspace": {"center_mm": [0, 0, 0], "scale": 1, "fit": false},
                             "modes": [{"type": "surface", "strength_n": 1}]})";
  const Outcome outcome = palpate("probe " + phantom().string() + " --path " + path.string() + " --scene " +
                                  scene.string() + " -o " + fresh_path("far").string());
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.output,
              ::testing::AllOf(HasSubstr("0 s"), HasSubstr("L 0.0 A 90.0 H 0.0 mm"), HasSubstr("90 mm")));
}

/// What replay says of how well the boundaries were known, of frames and of registrations is the recording's.
TEST(CommandNumbers, ReplayTellsWhatTheRecordingTells) {
  const fs::path out = fresh_path("replayed"), file = fresh_path("retold.h5");
  ASSERT_EQ(palpate("probe " + phantom().string() + testing::forehead + "--seconds 0.3 -o " + out.string()).exit, 0);
  Recording recording = read_recording(out / "recording.h5");
  ASSERT_EQ(recording.ticks.size(), 300U);
  // 101 numbers from 0.1 to 0.6 mm in steps of 0.005, the largest first; of the other ticks nothing is known.
  for (std::size_t n = 0; n < 300; ++n) {
    recording.known_to_mm[n] = n < 101 ? 0.6 - 0.005 * static_cast<double>(n) : std::nan("");
  }
  io::RigidMotion motion;
  motion.shift = {1.25, -2.5, 30};
  recording.scenes[0].registered = {{"aorta", "00000000000000ab", motion}};
  write_recording(recording, file);
  const std::string command = "replay " + file.string() + " " + phantom().string();
  const Json told = Json::parse(palpate(command + " --json", false).output);
  EXPECT_EQ(told.at("frames"), 300);
  EXPECT_TRUE(told.at("first_different").is_null());
  EXPECT_NEAR(told.at("known_to_mm").at("median").get<double>(), 0.35, 1e-9);
  EXPECT_NEAR(told.at("known_to_mm").at("largest").get<double>(), 0.6, 1e-9);
  EXPECT_EQ(told.at("scan_frames"), Json::array({0}));
  EXPECT_EQ(
      told.at("registered"),
      Json::parse(R"([{"structure": "aorta", "registration": "00000000000000ab", "moved_by": "1.2, -2.5, 30.0 mm"}])"));
  EXPECT_EQ(palpate(command, false).output,
            "300 ticks replayed: the same to the last bit\n"
            "aorta is moved by 1.2, -2.5, 30.0 mm, as it was then: the registration 00000000000000ab\n"
            "boundaries that were felt: known to +-0.35 mm (median), at most +-0.6 mm\n");
}

/// The words of `marks` have the numbers of its JSON, whose meanings the hand's path gives: two presses, and one that
/// moves.
TEST(CommandNumbers, TheMarksWordsHaveTheNumbersOfTheirJson) {
  const fs::path path = fresh_path("pressed.csv"), out = fresh_path("pressed");
  std::ofstream(path) << "time_s,x_mm,y_mm,z_mm,buttons\n0,0,-29,0,0\n0.3,0,-23,0,0\n0.5,0,-23,0,2\n0.6,0,-23,0,0\n"
                         "0.9,8,-22,0,2\n1,8,-22,0,0\n1.1,-4,-29,3,2\n1.4,-4,-29,3,0\n1.5,8,-22,0,2\n1.9,-8,-22,0,0\n"
                         "2,-8,-22,0,0\n";
  ASSERT_EQ(palpate("probe " + phantom().string() + " --path " + path.string() + " -o " + out.string()).exit, 0);
  const std::string command = "marks " + (out / "recording.h5").string() + " " + phantom().string();
  const Json told = Json::parse(palpate(command + " --json", false).output);
  EXPECT_EQ(told.at("unit"), "HU");
  std::string words;
  for (const Json& mark : told.at("marks")) {
    const std::vector<double> at = mark.at("position_mm");
    const std::string boundary = mark.at("boundary");
    words += fmt::format("{}  at {:.2f} s: {:.2f}, {:.2f}, {:.2f} mm  {}  {:.4g} HU  {:.2f} N\n",
                         mark.at("name").get<std::string>(), mark.at("time_s").get<double>(), at[0], at[1], at[2],
                         boundary.empty() ? "nothing felt" : boundary, mark.at("value").get<double>(),
                         mark.at("force_n").get<double>());
  }
  ASSERT_FALSE(told.at("paths").empty());
  for (const Json& drawn : told.at("paths")) {
    EXPECT_LT(drawn.at("begin_s").get<double>(), drawn.at("end_s").get<double>());
    words += fmt::format("{}  {:.2f} to {:.2f} s: {:.2f} mm long\n", drawn.at("name").get<std::string>(),
                         drawn.at("begin_s").get<double>(), drawn.at("end_s").get<double>(),
                         drawn.at("length_mm").get<double>());
  }
  for (const Json& between : told.at("distances")) {
    words += fmt::format("{} to {}: {:.2f} mm\n", between.at("from").get<std::string>(),
                         between.at("to").get<std::string>(), between.at("length_mm").get<double>());
  }
  for (const Json& angle : told.at("angles")) {
    words += fmt::format("angle at {}: {:.1f} degrees\n", angle.at("at").get<std::string>(),
                         angle.at("degrees").get<double>());
  }
  EXPECT_EQ(palpate(command, false).output, words);
  const std::string table = palpate(command + " --csv", false).output;
  EXPECT_THAT(table, ::testing::StartsWith("kind,name,time_s,x_mm,"));
  EXPECT_EQ(
      static_cast<std::size_t>(std::ranges::count(table, '\n')),
      1 + told.at("marks").size() + told.at("paths").size() + told.at("distances").size() + told.at("angles").size());
  const Outcome exported = palpate("export " + (out / "recording.h5").string() + " " + phantom().string() + " -o " +
                                   fresh_path("pressed_results").string());
  EXPECT_THAT(exported.output,
              HasSubstr(fmt::format(": a report of {} marks, {} distances, {} angles and {} paths, and {} pictures;",
                                    told.at("marks").size(), told.at("distances").size(), told.at("angles").size(),
                                    told.at("paths").size(), told.at("marks").size())));
}

/// Contours of 20 x 20 x 18 mm, moved on to a scan by a registration.
TEST(CommandNumbers, StructuresAreMeasuredWhereTheyLie) {
  const fs::path study = fresh_path("measured") / "study";
  testing::write_contours(study / "rt.dcm", "1.2", "7", "Doe^Jane");
  const Json found = Json::parse(palpate("structures --json " + study.string(), false).output).at("structures").at(0);
  EXPECT_EQ(found.at("kind"), "RTSTRUCT");
  EXPECT_EQ(found.at("number"), 1);
  EXPECT_EQ(found.at("name"), "Cube");
  EXPECT_EQ(found.at("contours"), 7);
  EXPECT_FALSE(found.contains("voxels"));
  EXPECT_EQ(found.at("frame_of_reference_uid"), "1.2");
  EXPECT_EQ(found.at("file"), (study / "rt.dcm").string());
  EXPECT_NEAR(found.at("volume_mm3").get<double>(), 20 * 20 * 21, 1) << "each contour is of 3 mm";
  expect_near(found.at("centroid_mm"), Json({0, 0, 9}), 1e-6, "centroid_mm");
  expect_near(found.at("box_mm").at(0), Json({-10, -10, 0}), 1e-6, "low");
  expect_near(found.at("box_mm").at(1), Json({10, 10, 18}), 1e-6, "high");
  const std::string text = palpate("structures " + study.string(), false).output;
  EXPECT_THAT(text, HasSubstr("rt.dcm: RTSTRUCT, frame of reference 1.2\n      1  Cube"));
  EXPECT_THAT(text, HasSubstr(": 8.40 ml, 7 contours, around "));
  EXPECT_THAT(text, HasSubstr("0.0, 9.0 mm\n"));
}

/// Hard constraints without a common point are refused by one that lacks most, with how much it lacks; one that is met
/// is none of them, however far its place is.
TEST(CommandNumbers, HardConstraintsThatDisagreeAreNamedWithTheirDistance) {
  const fs::path input = fresh_path("disagree.jsonl");
  const std::string met = R"({"type":"plane","strength":"inf","position":[0,0,-50],"direction":[0,0,2]},)"
                          R"({"type":"line","strength":"inf","position":[0,0,70],"direction":[0,0,3]},)";
  std::ofstream(input) << R"({"stiffness":400,"probe":[0,0,0],"primitives":[)" << met
                       << R"({"type":"point","strength":"inf","position":[0,0,0]},)"
                          R"({"type":"point","strength":"inf","position":[0,0,1]}]})"
                       << "\n"
                       << R"({"stiffness":400,"probe":[0,0,0],"primitives":[)" << met
                       << R"({"type":"plane","strength":"inf","position":[0,0,3],"direction":[0,0,1]},)"
                          R"({"type":"plane","strength":"inf","position":[0,0,-1],"direction":[0,0,-1]}]})"
                       << "\n";
  const Outcome outcome = palpate("solve < " + input.string(), false);
  EXPECT_EQ(outcome.exit, 1);
  std::istringstream lines(outcome.output);
  for (const char* const apart : {"1 m", "4 m"}) {
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_THAT(Json::parse(line).at("error").get<std::string>(),
                ::testing::AllOf(::testing::MatchesRegex("primitive [23]: .*"),
                                 HasSubstr(fmt::format(" stays {} away", apart))));
  }
}

/// How a series was acquired, each word and number under its own name.
TEST(CommandNumbers, ASeriesDetailsAreToldUnderTheirNames) {
  const fs::path folder = fresh_path("details");
  fs::create_directories(folder);
  io::internal::write_stack(folder, 4, [](int k, io::internal::TestImage& image) {
    image.z = 2.5 * k;
    image.edit = [](DcmDataset& d) {
      using io::internal::put;
      put(d, DCM_SeriesNumber, "7");
      put(d, DCM_SeriesDate, "20250203");
      put(d, DCM_SeriesTime, "040506.7");
      put(d, DCM_BodyPartExamined, "KNEE");
      put(d, DCM_ConvolutionKernel, "H31s");
      put(d, DCM_SequenceName, "fl3d");
      put(d, DCM_ContrastBolusAgent, "GD");
      put(d, DCM_SliceThickness, "2.25");
    };
  });
  const Json s = Json::parse(palpate("info --json " + folder.string(), false).output).at("series").at(0);
  for (const auto& [key, value] : {std::pair<const char*, Json>{"number", 7},
                                   {"date", "20250203"},
                                   {"body_part", "KNEE"},
                                   {"kernel", "H31s"},
                                   {"sequence", "fl3d"},
                                   {"contrast", "GD"},
                                   {"thickness_mm", 2.25},
                                   {"files", 4},
                                   {"frames_per_position", 1}}) {
    EXPECT_EQ(s.at(key), value) << key;
  }
  EXPECT_THAT(
      palpate("info " + folder.string(), false).output,
      HasSubstr("   series 7, 20250203 at 040506, KNEE, axial, kernel H31s, sequence fl3d, contrast GD, 2.25 mm "
                "thick, 4 files\n"));
}

/// The letters are those of the patient's sides at the image's right and lower edge (PS3.3 C.7.6.1.1.1).
TEST(CommandNumbers, ASeriesTellsItsWindowAndTheLettersOfItsEdges) {
  using io::internal::put;
  struct Case {
    const char* orientation;
    Json letters;
  };
  for (const Case& one : {Case{"1\\0\\0\\0\\1\\0", {"L", "P"}}, Case{"-1\\0\\0\\0\\-1\\0", {"R", "A"}},
                          Case{"1\\0\\0\\0\\0\\-1", {"L", "F"}}, Case{"0\\1\\0\\0\\0\\-1", {"P", "F"}},
                          Case{"0.8\\0.6\\0\\0\\0\\-1", {"LP", "F"}}}) {
    for (const bool has_window : {false, true}) {
      const fs::path folder = fresh_path("window");
      fs::create_directories(folder);
      io::internal::write_stack(folder, 4, [&](int k, io::internal::TestImage& image) {
        image.edit = [=](DcmDataset& d) {
          put(d, DCM_ImageOrientationPatient, std::string(one.orientation));
          // Along the normal, whichever that is.
          put(d, DCM_ImagePositionPatient,
              std::to_string(2 * k) + "\\" + std::to_string(-2 * k) + "\\" + std::to_string(2 * k));
          if (!has_window) return;
          put(d, DCM_WindowCenter, std::string("40\\300"));
          put(d, DCM_WindowWidth, std::string("400\\1500"));
        };
      });
      const Json s = Json::parse(palpate("info --json " + folder.string(), false).output).at("series").at(0);
      EXPECT_EQ(s.at("letters"), one.letters);
      EXPECT_EQ(s.at("window"), has_window ? Json({{"center", 40.0}, {"width", 400.0}}) : Json());
    }
  }
}

TEST(CommandNumbers, AnEnhancedFileTellsItsThickness) {
  for (const bool is_shared : {false, true}) {
    const fs::path folder = fresh_path("enhanced");
    fs::create_directories(folder);
    io::internal::TestImage image;
    image.edit = [is_shared](DcmDataset& d) {
      d.findAndDeleteElement(DCM_SliceThickness);
      io::internal::make_multi_frame(d, {0, 2, 4}, [&](std::size_t, DcmItem& frame) {
        if (is_shared) return;
        DcmItem& measures = io::internal::group(frame, DCM_PixelMeasuresSequence);
        io::internal::succeed(measures.putAndInsertString(DCM_PixelSpacing, "0.5\\0.75"));
        io::internal::succeed(measures.putAndInsertString(DCM_SliceThickness, "1.75"));
      });
      DcmItem& shared = io::internal::group(d, DCM_SharedFunctionalGroupsSequence);
      if (is_shared) {
        io::internal::succeed(
            io::internal::group(shared, DCM_PixelMeasuresSequence).putAndInsertString(DCM_SliceThickness, "1.75"));
      }
      io::internal::repeat_pixels(d, 3);
    };
    io::internal::write(image, folder / "a.dcm");
    const Json s = Json::parse(palpate("info --json " + folder.string(), false).output).at("series").at(0);
    EXPECT_EQ(s.at("thickness_mm"), 1.75);
  }
}

/// An archive's settings come back as they were entered, in words and as JSON.
TEST(CommandNumbers, AnArchivesSettingsAreListedAsTheyWereEntered) {
  const std::string program = "XDG_CONFIG_HOME=" + fresh_path("archives").string() +
                              " XDG_CACHE_HOME=" + fresh_path("cache").string() + " " + PALPATE_PROGRAM;
  ASSERT_EQ(testing::run_command(program + " archive add clinic --host pacs --port 4242 --called THEIRS --calling OURS "
                                           "--listen 11113 --listen-address 127.0.0.1 --wait 12 2>&1")
                .exit,
            0);
  const Json all = Json::parse(testing::run_command(program + " archive list --json 2>/dev/null").output);
  EXPECT_EQ(all.at("archives"), Json::parse(R"([{"name": "clinic", "host": "pacs", "port": 4242, "called": "THEIRS",
      "calling": "OURS", "get": false, "listen_address": "127.0.0.1", "listen_port": 11113, "tls": false}])"));
  EXPECT_EQ(all.at("fetched").at("series"), 0);
  EXPECT_EQ(all.at("fetched").at("bytes"), 0);
  EXPECT_THAT(testing::run_command(program + " archive list 2>/dev/null").output,
              HasSubstr("clinic  pacs:4242  its AE title THEIRS, ours OURS; C-MOVE to 127.0.0.1:11113\n"));
  EXPECT_EQ(testing::run_command(program + " archive remove clinic 2>&1").output, "clinic is no longer entered\n");
}

/// An archive that does not answer is an error of each command that asks it for something, and nothing is told as done.
TEST(CommandNumbers, AnArchiveThatDoesNotAnswerIsNamedByEveryCommand) {
  const std::string program = "XDG_CONFIG_HOME=" + fresh_path("no_archive").string() +
                              " XDG_CACHE_HOME=" + fresh_path("no_cache").string() + " " + PALPATE_PROGRAM;
  ASSERT_EQ(testing::run_command(program + " archive add clinic --host 127.0.0.1 --port 1 --called A --calling B --get "
                                           ">/dev/null 2>&1")
                .exit,
            0);
  const fs::path one = fresh_path("one_file");
  fs::create_directories(one);
  fs::copy(fs::directory_iterator(phantom())->path(), one / "image.dcm");
  for (const std::string& asked : {std::string("find --patient Doe"),
                                   "fetch 1.2.3 -o " + fresh_path("unfetched").string(), "send " + one.string()}) {
    const Outcome outcome = testing::run_command(program + " " + asked + " 2>&1");
    EXPECT_EQ(outcome.exit, 1) << asked;
    EXPECT_THAT(outcome.output, HasSubstr("archive clinic (127.0.0.1:1)")) << asked;
    EXPECT_EQ(std::ranges::count(outcome.output, '\n'), 1) << outcome.output;
  }
}

/// The last fault is told from its file; of a stylus what its driver says of itself.
TEST(CommandNumbers, DevicesTellTheLastFaultAndWhatEachKindCanDo) {
  const fs::path state = fresh_path("state_of_devices");
  fs::create_directories(state / "palpate");
  std::ofstream(state / "palpate/last-fault.csv") << "# stylus: a stylus\n# fault: device lost\n# time: then\n"
                                                     "# fastest: 1.250 m/s\n# strongest: 3.500 N\n";
  const Json told = Json::parse(
      testing::run_command("XDG_STATE_HOME=" + state.string() + " " + PALPATE_PROGRAM + " devices --json 2>/dev/null")
          .output);
  EXPECT_EQ(told.at("last_fault"), Json({{"stylus", "a stylus"},
                                         {"fault", "device lost"},
                                         {"time", "then"},
                                         {"fastest_m_per_s", 1.25},
                                         {"strongest_n", 3.5},
                                         {"file", (state / "palpate/last-fault.csv").string()}}));
  std::vector<Json> kinds;
  for (const device::DeviceType* type : device::device_types()) {
    kinds.push_back({{"kind", type->kind},
                     {"name", type->name},
                     {"can", type->can},
                     {"needs", type->needs},
                     {"homing", type->homing},
                     {"sold", type->sold},
                     {"tested", type->tested},
                     {"watchdog", type->watchdog}});
  }
  EXPECT_EQ(told.at("kinds"), Json(kinds));
  EXPECT_THAT(palpate("devices --check simulated --yes").output,
              HasSubstr("Axis x: a push to the right with 0.2 N, as the weight of 20 g, for a second.\n"));
}

}  // namespace
}  // namespace palpate::plugin
