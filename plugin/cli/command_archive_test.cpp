// `palpate archive`, `find`, `fetch`, `send`, `marks` and `export` as a person uses them; with a real Orthanc if it is
// installed, from an empty folder to a report in the archive.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "io/archive/testing/orthanc.h"
#include "io/archive/testing/says.h"
#include "io/structures/label_image.h"
#include "io/testing/test_image.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;
using io::testing::says;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;
namespace fs = std::filesystem;

/// Settings and fetched files of its own.
class CommandArchive : public ::testing::Test {
 protected:
  void SetUp() override {
    home_ = fresh_path("home");
    fs::create_directories(home_);
  }
  Outcome run(const std::string& arguments, bool with_errors = true) const {
    return run_command("XDG_CONFIG_HOME=" + (home_ / "config").string() +
                       " XDG_CACHE_HOME=" + (home_ / "cache").string() + " " + PALPATE_PROGRAM + " " + arguments +
                       (with_errors ? " 2>&1" : " 2>/dev/null"));
  }
  Json json(const std::string& arguments) const { return Json::parse(run(arguments, false).output); }
  fs::path settings() const { return home_ / "config/palpate/archives.json"; }

  fs::path home_;
};

const std::string clinic = "archive add clinic --host 127.0.0.1 --port 4242 --called CLINIC --calling PALPATE ";

TEST_F(CommandArchive, KeepsItsSettingsPrivate) {
  EXPECT_TRUE(
      says(run("find").output,
           "no archive is entered yet: enter one with `palpate archive add NAME --host --port --called --calling`"));
  const Outcome added = run(clinic + "--listen 11113");
  EXPECT_EQ(added.exit, 0) << added.output;
  EXPECT_THAT(added.output, HasSubstr("port 11113, as a place to send to"));
  EXPECT_EQ(fs::status(settings()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(fs::status(settings().parent_path()).permissions(), fs::perms::owner_all);
  ASSERT_EQ(run("archive add other --host pacs --port 104 --called X --calling Y --get").exit, 0);
  const Json listed = json("archive list --json");
  ASSERT_EQ(listed["archives"].size(), 2U);
  EXPECT_EQ(listed["archives"][0]["listen_port"], 11113);
  EXPECT_EQ(listed["archives"][1]["get"], true);
  EXPECT_TRUE(says(run("find").output, "choose one of the archives with --archive: {}"));
  EXPECT_TRUE(says(run("find --archive third").output, "no archive {} is entered; there are: {}"));
  EXPECT_EQ(run("archive remove other").exit, 0);
  EXPECT_EQ(json("archive list --json")["archives"].size(), 1U);
  ASSERT_EQ(run(clinic + "--get").exit, 0) << "entered again, it is changed";
  EXPECT_EQ(json("archive list --json")["archives"].size(), 1U);
}

TEST_F(CommandArchive, RefusesSettingsThatCannotBe) {
  EXPECT_EQ(run("archive add a --host h --port 104 --called X").exit, 2) << "--calling is missing";
  EXPECT_EQ(run("archive add a --host h --port 104 --called TOO_LONG_FOR_A_TITLE --calling Y").exit, 1);
  EXPECT_FALSE(fs::exists(settings()));
  fs::create_directories(settings().parent_path());
  std::ofstream(settings()) << "{";
  EXPECT_TRUE(says(run("archive list").output, "the settings {} cannot be read ({}): correct or delete the file"));
  fs::remove_all(home_ / "config");
  std::ofstream(home_ / "config") << "a file";
  EXPECT_TRUE(says(run(clinic).output,
                   "the settings {} cannot be written ({}): make room, or get the right to write to the folder"));
  EXPECT_TRUE(says(output_of("env -u HOME -u XDG_CONFIG_HOME " + std::string(PALPATE_PROGRAM) + " archive list"),
                   "neither {} nor HOME names a folder for the settings: set one of them"));
}

TEST_F(CommandArchive, TellsOfWhatIsMissing) {
  io::testing::Process half({ODD_ARCHIVE, "half"}), two({ODD_ARCHIVE, "two-studies"});
  for (const auto& [name, process] : {std::pair{"half", &half}, std::pair{"two", &two}}) {
    ASSERT_EQ(run(std::string("archive add ") + name + " --host 127.0.0.1 --port " + process->read_line() +
                  " --called ODD --calling PALPATE --get")
                  .exit,
              0);
  }
  const fs::path folder = fresh_path("half");
  const Outcome fetched = run("fetch --archive half 1.2.3 -o " + folder.string());
  EXPECT_EQ(fetched.exit, 1);
  EXPECT_TRUE(says(fetched.output, "not all images came: see the warnings"));
  EXPECT_TRUE(fs::exists(folder / "series-001/image-000001.dcm")) << "what came is kept";
  const Outcome found = run("find --archive two --most 1");
  EXPECT_EQ(found.exit, 0);
  EXPECT_TRUE(
      says(found.output,
           "palpate: the archive holds more than these {} studies: narrow the search, or list more with --most"));
}

// PS3.4 B.2.3: the archive keeps the file, and what it says of it is said.
TEST_F(CommandArchive, SendSaysWhatTheArchiveWarnsOf) {
  io::testing::Process odd({ODD_ARCHIVE, "leaves-out-at-store"});
  ASSERT_EQ(run("archive add odd --host 127.0.0.1 --port " + odd.read_line() + " --called ODD --calling PALPATE").exit,
            0);
  const std::string file = fs::directory_iterator(phantom())->path().string();
  const Outcome sent = run("send " + file);
  EXPECT_EQ(sent.exit, 0) << sent.output;
  EXPECT_THAT(sent.output, HasSubstr("took it, with a warning: it left elements out (status B006)"));
  const Json told = json("send " + file + " --json");
  EXPECT_EQ(told["sent"], 1);
  ASSERT_EQ(told["warned"].size(), 1U) << told;
  EXPECT_EQ(told["warned"][0]["file"], file);
  EXPECT_EQ(told["not_sent"].size(), 0U);
}

/// A ball whose hand presses the second button twice on the surface, and keeps it down once.
fs::path path_with_buttons() {
  const fs::path file = fresh_path("path.csv");
  std::ofstream(file) << "time_s,x_mm,y_mm,z_mm,buttons\n"
                         "0,0,-29,0,0\n0.4,0,-23,0,0\n0.6,0,-23,0,2\n0.7,0,-23,0,0\n"
                         "1.2,8,-22,0,0\n1.4,8,-22,0,2\n1.5,8,-22,0,0\n"
                         "1.6,8,-22,0,2\n2.4,-8,-22,0,0\n2.6,-8,-22,0,0\n";
  return file;
}

/// A recording of it on a scan.
fs::path recorded(const fs::path& scan) {
  const fs::path out = fresh_path("probed");
  const Outcome probed =
      palpate("probe " + scan.string() + " --path " + path_with_buttons().string() + " -o " + out.string());
  EXPECT_EQ(probed.exit, 0) << probed.output;
  return out / "recording.h5";
}

double distance(const Json& a, const Json& b) {
  double sum = 0;
  for (std::size_t n = 0; n < 3; ++n) sum += std::pow(a[n].get<double>() - b[n].get<double>(), 2);
  return std::sqrt(sum);
}

TEST_F(CommandArchive, MarksArePrintedForPeopleAndPrograms) {
  const std::string arguments = "marks " + recorded(phantom()).string() + " " + phantom().string();
  const Json marks = json(arguments + " --json");
  ASSERT_EQ(marks["marks"].size(), 2U);
  ASSERT_EQ(marks["paths"].size(), 1U);
  // The hand holds 2 mm and more inside the ball of 25 mm, whose surface holds the proxy.
  const Json center = {0, 0, 0};
  for (const Json& mark : marks["marks"]) {
    EXPECT_NEAR(distance(mark["position_mm"], center), 25, 1.0) << mark;
    EXPECT_GT(mark["force_n"].get<double>(), 0.1);
    EXPECT_FALSE(mark["boundary"].get<std::string>().empty());
  }
  EXPECT_NEAR(marks["marks"][0]["position_mm"][0].get<double>(), 0, 1);
  EXPECT_NEAR(marks["marks"][1]["position_mm"][0].get<double>(), 8, 1.5);
  const double between = distance(marks["marks"][0]["position_mm"], marks["marks"][1]["position_mm"]);
  EXPECT_NEAR(marks["distances"][0]["length_mm"].get<double>(), between, 1e-9);
  // From x = 8 to -8 over the ball: an arc of 2 asin(8 / 25) * 25 mm.
  EXPECT_NEAR(marks["paths"][0]["length_mm"].get<double>(), 2 * std::asin(8.0 / 25) * 25, 2);

  const Json slicer = json(arguments + " --mrk.json");
  EXPECT_THAT(slicer["@schema"].get<std::string>(), HasSubstr("markups-schema-v1.0.3.json"));
  EXPECT_EQ(slicer["markups"][0]["type"], "Fiducial");
  EXPECT_EQ(slicer["markups"][0]["coordinateSystem"], "LPS");
  EXPECT_EQ(slicer["markups"][0]["controlPoints"][1]["position"], marks["marks"][1]["position_mm"]);
  EXPECT_EQ(slicer["markups"].back()["type"], "Curve");

  std::istringstream csv(run(arguments + " --csv", false).output);
  std::string line;
  std::size_t rows = 0;
  while (std::getline(csv, line)) {
    ++rows;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 10) << line;
  }
  EXPECT_EQ(rows, 1 + 2 + 1 + 1U);
  EXPECT_THAT(run(arguments).output, HasSubstr("Mark 2  at"));
  EXPECT_EQ(run(arguments + " --csv --json").exit, 2);
}

TEST_F(CommandArchive, WithoutMarksSaysHowTheyAreMade) {
  const fs::path out = fresh_path("unmarked");
  ASSERT_EQ(palpate("probe " + phantom().string() + forehead + "-o " + out.string()).exit, 0);
  const std::string arguments = (out / "recording.h5").string() + " " + phantom().string();
  EXPECT_THAT(run("marks " + arguments).output, HasSubstr("no marks: the stylus' second button was never pressed"));
  const fs::path folder = fresh_path("nothing");
  EXPECT_TRUE(says(run("export " + arguments + " -o " + folder.string()).output,
                   "{} holds no marks: the stylus' second button makes them, or the column `buttons` of a --path"));
  EXPECT_FALSE(fs::exists(folder));
}

/// All triples of numbers in a dump's GraphicData.
std::vector<Json> dumped_points(const std::string& file) {
  std::vector<Json> points;
  std::istringstream dump(output_of("dcmdump +L " + file));
  for (std::string line; std::getline(dump, line);) {
    if (line.find("(0070,0022) FL") == std::string::npos) continue;
    std::istringstream numbers(line.substr(line.find("FL") + 2));
    Json point = Json::array();
    for (std::string number; std::getline(numbers, number, '\\') && point.size() < 3;)
      point.push_back(std::stod(number));
    points.push_back(point);
  }
  return points;
}

TEST_F(CommandArchive, ExportsWhatOtherProgramsAccept) {
  const std::string arguments = recorded(phantom()).string() + " " + phantom().string();
  const fs::path folder = fresh_path("exported");
  const Outcome exported = run("export " + arguments + " -o " + folder.string());
  ASSERT_EQ(exported.exit, 0) << exported.output;
  const std::string report = (folder / "measurements.dcm").string();
  ASSERT_TRUE(fs::exists(report));
  ASSERT_TRUE(fs::exists(folder / "picture-002.dcm"));
  if (output_of("which dcmdump dsrdump dciodvfy").find("/dciodvfy") == std::string::npos) {
    GTEST_SKIP() << "dcmtk and dicom3tools are not installed";
  }
  // DCMTK reads the points back to 0.001 mm.
  const Json marks = json("marks " + arguments + " --json");
  const std::vector<Json> points = dumped_points(report);
  ASSERT_EQ(points.size(), 4U) << "two marks, a distance, a path";
  EXPECT_LT(distance(points[0], marks["marks"][0]["position_mm"]), 0.001);
  EXPECT_LT(distance(points[1], marks["marks"][1]["position_mm"]), 0.001);
  const std::string dump = output_of("dsrdump +Pl " + report);
  EXPECT_THAT(dump, HasSubstr("Comprehensive 3D SR Document"));
  EXPECT_THAT(dump, HasSubstr("Imaging Measurement Report"));
  EXPECT_THAT(dump, HasSubstr("research software"));
  EXPECT_THAT(dump, Not(HasSubstr("E: ")));
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string verdict = output_of("dciodvfy " + entry.path().string());
    EXPECT_THAT(verdict, Not(HasSubstr("Error"))) << entry.path() << "\n" << verdict;
  }
}

class CommandOrthanc : public CommandArchive {
 protected:
  void SetUp() override {
    if (io::testing::orthanc_program().empty()) GTEST_SKIP() << "Orthanc is not installed: apt-get install orthanc";
    CommandArchive::SetUp();
    orthanc_ = std::make_unique<io::testing::Orthanc>(fresh_path("orthanc"));
    const io::Archive& there = orthanc_->archive();
    const std::string entered = "archive add here --host 127.0.0.1 --port " + std::to_string(there.port) +
                                " --called ORTHANC --calling PALPATE --listen-address 127.0.0.1 --listen " +
                                std::to_string(there.listen_port);
    ASSERT_EQ(run(entered).exit, 0);
    ASSERT_EQ(run(entered + " --get").exit, 0);
    ASSERT_EQ(run("archive remove here").exit, 0);
    ASSERT_EQ(run(entered).exit, 0);
    by_get_ = "archive add by-get " + entered.substr(std::string("archive add here ").size()) + " --get";
  }
  std::unique_ptr<io::testing::Orthanc> orthanc_;
  std::string by_get_;
};

TEST_F(CommandOrthanc, FromTheArchiveAndBack) {
  EXPECT_THAT(run("archive echo").output, HasSubstr("here answers and knows us as PALPATE"));
  EXPECT_EQ(json("archive echo --json")["answers"], true);
  EXPECT_THAT(run("find").output, HasSubstr("nothing found"));
  EXPECT_EQ(json("send " + phantom().string() + " --json")["sent"], 60);

  const Json found = json("find --modality CT --json");
  ASSERT_EQ(found["studies"].size(), 1U) << found;
  const std::string study = found["studies"][0]["study_uid"], series = found["studies"][0]["series"][0]["series_uid"];
  EXPECT_EQ(found["studies"][0]["series"][0]["images"], 60);

  // By C-MOVE into a folder of ours, by C-GET into the private one.
  const fs::path folder = fresh_path("fetched");
  const Json moved = json("fetch " + series + " -o " + folder.string() + " --json");
  EXPECT_EQ(moved["images"], 60);
  EXPECT_EQ(moved["complete"], true);
  ASSERT_EQ(run(by_get_).exit, 0);
  const Outcome got = run("fetch --archive by-get " + study);
  EXPECT_EQ(got.exit, 0) << got.output;
  EXPECT_TRUE(says(got.output, "palpate: what was fetched stays in {} until `palpate archive empty`"));
  const fs::path hidden = home_ / "cache/palpate/fetched";
  EXPECT_EQ(fs::status(hidden).permissions(), fs::perms::owner_all);
  EXPECT_EQ(json("archive list --json")["fetched"]["series"], 1);
  EXPECT_THAT(run("archive empty").output, HasSubstr("1 series deleted"));
  EXPECT_FALSE(fs::exists(hidden));

  // Felt, marked, sent back, and found there in the same study.
  const std::string fetched = moved["series"][0]["folder"];
  const fs::path out = fresh_path("results");
  const Outcome exported = run("export " + recorded(fetched).string() + " " + fetched + " -o " + out.string());
  ASSERT_EQ(exported.exit, 0) << exported.output;
  EXPECT_EQ(json("send --archive here " + out.string() + " --json")["sent"], 3);
  const Json after = json("find --archive here --json");
  ASSERT_EQ(after["studies"].size(), 1U) << after;
  EXPECT_EQ(after["studies"][0]["study_uid"], study);
  std::map<std::string, int> modalities;
  for (const Json& one : after["studies"][0]["series"]) modalities[one["modality"]] += one["images"].get<int>();
  EXPECT_EQ(modalities, (std::map<std::string, int>{{"CT", 60}, {"SR", 1}, {"OT", 2}}));

  const fs::path text = fresh_path("text");
  std::ofstream(text) << "not DICOM";
  const Outcome refused = run("send --archive here " + text.string());
  EXPECT_EQ(refused.exit, 1);
  EXPECT_TRUE(says(refused.output, "{} of {} files were not sent"));
}

/// What was outlined on a scan goes into the scan's study, is found there, and comes back as it was.
TEST_F(CommandOrthanc, OutlinesGoIntoTheStudyAndComeBack) {
  ASSERT_EQ(json("send " + phantom().string() + " --json")["sent"], 60);
  const io::Series scan = io::find_series(std::array{phantom()}).series.at(0);
  io::StructureLabel label;
  label.name = "Größe";
  label.type = {"10200004", "SCT", "Liver"};
  const auto outline = [](const io::Vec3& at) { return 20 - std::sqrt(at.x * at.x + at.y * at.y + at.z * at.z); };
  const fs::path out = fresh_path("outlines");
  fs::create_directories(out);
  for (const auto& [form, name] :
       {std::pair{io::StructureForm::segmentation, "seg.dcm"}, std::pair{io::StructureForm::contours, "rt.dcm"}}) {
    write_structure(label, scan, scan.geometry, outline, {}, form, out / name, {.software_version = "1"});
  }
  EXPECT_EQ(json("send --archive here " + out.string() + " --json")["sent"], 2);

  const Json found = json("find --archive here --json");
  ASSERT_EQ(found["studies"].size(), 1U) << found;
  std::map<std::string, std::string> series;
  for (const Json& one : found["studies"][0]["series"]) series[one["modality"]] = one["series_uid"];
  ASSERT_EQ(series.size(), 3U) << found;
  const fs::path back = fresh_path("outlines_back");
  ASSERT_EQ(
      json("fetch " + series.at("SEG") + " " + series.at("RTSTRUCT") + " -o " + back.string() + " --json")["images"],
      2);
  const Json sent = json("structures --json " + out.string()), fetched = json("structures --json " + back.string());
  ASSERT_EQ(fetched["structures"].size(), 2U) << fetched;
  std::set<std::string> kinds;
  for (const Json& one : fetched["structures"]) {
    kinds.insert(one["kind"]);
    EXPECT_EQ(one["name"], "Größe");
    const auto was = std::ranges::find_if(sent["structures"], [&](const Json& s) { return s["kind"] == one["kind"]; });
    ASSERT_NE(was, sent["structures"].end());
    for (const char* const key : {"volume_mm3", "centroid_mm", "box_mm", "frame_of_reference_uid"}) {
      EXPECT_EQ(one[key], (*was)[key]) << key;
    }
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"SEG", "RTSTRUCT"}));
}

/// A study of 1.5 MiB whose every text is another: each is told as what it is, in the text and in the JSON, and a MiB
/// is a MiB.
TEST_F(CommandOrthanc, TellsEachTextAndSizeAsWhatItIs) {
  const fs::path study = fresh_path("told_study");
  fs::create_directories(study);
  io::internal::write_stack(study, 12, [](int, io::internal::TestImage& image) {
    image.columns = image.rows = 256;
    image.edit = [](DcmDataset& d) {
      using io::internal::put;
      put(d, DCM_PatientName, "Plastic^Head");
      put(d, DCM_PatientID, "P-77");
      put(d, DCM_StudyDate, "20260104");
      put(d, DCM_StudyDescription, "PHANTOMS");
    };
  });
  ASSERT_EQ(json("send " + study.string() + " --json")["sent"], 12);
  const Json found = json("find --json")["studies"].at(0);
  const std::string uid = found["study_uid"];
  EXPECT_THAT(found["patient"].get<std::string>(), HasSubstr("Plastic"));
  EXPECT_EQ(found["patient_id"], "P-77");
  EXPECT_EQ(found["date"], "20260104");
  EXPECT_EQ(found["description"], "PHANTOMS");
  EXPECT_THAT(run("find").output, HasSubstr(found["patient"].get<std::string>() +
                                            "  P-77  20260104  \"PHANTOMS\"\n   study " + uid + "\n"));

  const fs::path folder = fresh_path("told_fetched");
  EXPECT_EQ(run("fetch " + uid + " --most-mib 1 -o " + folder.string()).exit, 1);
  EXPECT_EQ(json("fetch " + uid + " --most-mib 2 -o " + folder.string() + " --json")["images"], 12);
  ASSERT_EQ(run("fetch " + uid).exit, 0);
  EXPECT_EQ(json("archive list --json")["fetched"]["bytes"].get<std::size_t>() >> 20U, 1U);
  EXPECT_THAT(run("archive list").output, HasSubstr("1 series fetched and not deleted yet, 1 MiB, in "));
  EXPECT_THAT(run("archive empty").output, HasSubstr("1 series deleted, 1 MiB\n"));
}

TEST_F(CommandOrthanc, CtrlCLeavesNothingHalfWritten) {
  ASSERT_EQ(json("send " + phantom().string() + " --json")["sent"], 60);
  const std::string series = json("find --json")["studies"][0]["series"][0]["series_uid"];
  const fs::path folder = fresh_path("interrupted");
  // SIGTERM, which ends it as Ctrl-C does, as soon as the first file has come; a fetch that was faster left all of it.
  const Outcome outcome =
      run_command("XDG_CONFIG_HOME=" + (home_ / "config").string() + " sh -c '" + PALPATE_PROGRAM + " fetch " + series +
                  " -o " + folder.string() + " 2>&1 & pid=$!; for n in $(seq 1000); do ls -A " + folder.string() +
                  " 2>/dev/null | grep -q . && break; sleep 0.002; done; kill -TERM $pid; wait $pid'");
  const bool whole = outcome.exit == 0;
  EXPECT_EQ(fs::exists(folder), whole) << outcome.output;
  EXPECT_EQ(outcome.output.find("cancelled") == std::string::npos, whole) << outcome.output;
}

}  // namespace
}  // namespace palpate::plugin
