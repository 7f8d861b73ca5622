// `palpate archive`, `find`, `fetch`, `send`, `marks` and `export` as a person uses them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/archive/testing/orthanc.h"
#include "io/archive/testing/says.h"
#include "plugin/testing/command_archive_case.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;
using io::testing::says;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;
namespace fs = std::filesystem;

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

}  // namespace
}  // namespace palpate::plugin
