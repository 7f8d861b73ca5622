// The program as a person uses it: exit codes, messages, JSON, and no incomplete files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "plugin/recording/recording.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;
using ::testing::HasSubstr;

std::string write_scene(const std::string& name, const std::string& text) {
  const auto file = fresh_path(name);
  std::ofstream(file) << text;
  return file.string();
}

TEST(Command, HelpTeachesAndUnknownWordsAreWrongUsage) {
  EXPECT_EQ(palpate("--help").exit, 0);
  for (const char* command : {"info", "sample", "plan", "profile", "probe", "record", "replay", "solve"}) {
    const Outcome help = palpate(std::string(command) + " --help");
    EXPECT_EQ(help.exit, 0) << command;
    EXPECT_THAT(help.output, HasSubstr("--")) << command;
  }
  EXPECT_EQ(palpate("").exit, 2);
  EXPECT_EQ(palpate("prod x").exit, 2);
  EXPECT_EQ(palpate("probe").exit, 2);
  EXPECT_EQ(palpate("profile " + phantom().string() + " --from 1,2 --to 0,0,0").exit, 2);
}

TEST(Command, PlanSaysWhatItLeftOutAndWhatThatSavesMeasured) {
  const std::string scene = write_scene("plan.json", R"({"version": 1, "modes": [
    {"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1]]}},
    {"type": "friction", "name": "drag", "strength_n": 0},
    {"type": "tube", "name": "vessel", "strength_n": 0.3, "enabled": false},
    {"type": "follow", "name": "flow", "strength_n": 0.3}]})");
  const Outcome outcome = palpate("plan " + phantom().string() + " --json --scene " + scene, false);
  ASSERT_EQ(outcome.exit, 0) << outcome.output;
  const auto plan = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(plan["solvers"], nlohmann::json::array({"analytical"}));
  const auto entry = [&plan](const std::string& what) {
    for (const auto& left : plan["left_out"]) {
      if (left["what"].get<std::string>().find(what) == 0) return left;
    }
    return nlohmann::json();
  };
  EXPECT_EQ(entry("friction \"drag\"")["why"], "its strength is zero everywhere");
  for (const char* what : {"friction", "tube", "Hessian", "low and high", "exact solver"}) {
    EXPECT_TRUE(entry(what)["saves_us_a_sub_step"].is_number()) << what;
    EXPECT_TRUE(entry(what)["saves_bytes"].is_number()) << what;
  }
  EXPECT_FALSE(entry("follow").contains("saves_bytes")) << "what cannot be felt here cannot be measured";
  EXPECT_GT(entry("Hessian")["saves_bytes"], 100'000);
  EXPECT_GT(entry("exact solver")["saves_bytes"], 1000);
  EXPECT_TRUE(entry("slices").is_null()) << "all of them are in reach";
  EXPECT_EQ(entry("guardian")["why"], "a simulated stylus pushes nobody");
}

TEST(Command, PlanNamesTheSlicesOutOfReachAndWhatTheStylusDoesNotNeed) {
  const std::string scene = write_scene("near.json", R"({"version": 1, "workspace": {"scale": 0.1}, "modes": [
    {"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1]]}}]})");
  const auto left_out = [&scene](const std::string& device) {
    const Outcome outcome =
        palpate("plan " + phantom().string() + " --json --scene " + scene + " --device " + device, false);
    EXPECT_EQ(outcome.exit, 0) << outcome.output;
    const auto plan = nlohmann::json::parse(outcome.output);
    std::map<std::string, nlohmann::json> entries;
    for (const auto& entry : plan["left_out"]) {
      entries[entry["what"].get<std::string>()] = entry;
    }
    return entries;
  };
  const auto simulated = left_out("simulated");
  EXPECT_TRUE(simulated.contains("drivers of falcon, wooden_haptics, space_mouse, haply, touch, force_dimension"));
  const auto slices = simulated.lower_bound("slices");
  ASSERT_TRUE(slices != simulated.end() && slices->first.starts_with("slices 0-"));
  EXPECT_EQ(slices->second["why"], "outside the workspace");
  EXPECT_GT(slices->second["saves_ms_once"], 0);
  EXPECT_GT(slices->second["saves_bytes"], 10'000);
  const auto falcon = left_out("falcon");
  EXPECT_FALSE(falcon.contains("guardian")) << "it can push";
  EXPECT_TRUE(falcon.contains("drivers of wooden_haptics, space_mouse, haply, touch, force_dimension"));
  const auto space_mouse = left_out("space_mouse");
  EXPECT_EQ(space_mouse.at("guardian")["why"], "the stylus has no motors");
  EXPECT_THAT(space_mouse.at("damping of ringing")["saves"], HasSubstr(" us a tick"));
}

TEST(Command, ProbeLeavesARecordingASummaryAndPictures) {
  const auto out = fresh_path("probe");
  const Outcome outcome =
      palpate("probe " + phantom().string() + forehead + "--scene ct-skin-and-bone --json -o " + out.string(), false);
  ASSERT_EQ(outcome.exit, 0) << outcome.output;
  const auto summary = nlohmann::json::parse(outcome.output);
  std::vector<std::string> felt;
  for (const auto& hold : summary["holds"]) {
    felt.push_back(hold["boundary"]);
  }
  EXPECT_THAT(felt, ::testing::AllOf(::testing::Contains("skin"), ::testing::Contains("bone")));
  EXPECT_EQ(felt.front(), "skin");
  EXPECT_TRUE(summary["faults"].empty());
  for (const char* file :
       {"recording.h5", "summary.txt", "slice.png", "force-depth.png", "force-time.png", "tick-time.png"}) {
    EXPECT_GT(std::filesystem::file_size(out / file), 300U) << file;
  }
  const Recording recording = read_recording(out / "recording.h5");
  EXPECT_EQ(recording.ticks.size(), summary["frames"].get<std::size_t>());
  EXPECT_EQ(recording.header.scan_hash.size(), 16U);
}

TEST(Command, ProfileIsTheContract) {
  const Outcome outcome =
      palpate("profile " + phantom().string() + forehead + "--scene ct-skin-and-bone --json", false);
  ASSERT_EQ(outcome.exit, 0);
  const auto profile = nlohmann::json::parse(outcome.output);
  const std::size_t count = profile["position_mm"].size();
  EXPECT_GT(count, 500U);
  for (const char* key : {"proxy_mm", "force_n", "value", "solver", "error_bound_m", "boundary"}) {
    EXPECT_EQ(profile[key].size(), count) << key;
  }
  // Pressed from the front towards the back: every force is towards the front.
  for (const auto& force : profile["force_n"]) {
    EXPECT_LE(force[1].get<double>(), 1e-9);
  }
}

TEST(Command, ProfileTellsHowWellABoundaryIsKnownAndLessWellInNoise) {
  constexpr double radius = 25;
  struct Met {
    double missed_mm, known_to_mm;
  };
  const auto met_in = [](double noise) {
    const auto folder = fresh_path("known");
    testdata::write_series(
        testdata::scan(testdata::make_sphere(radius), testdata::make_geometry({.size = glm::ivec3(60)}),
                       {.noise = noise, .seed = 5}),
        folder);
    const Outcome outcome = palpate("profile " + folder.string() + forehead + "--scene ct-skin-and-bone --json", false);
    const auto met = nlohmann::json::parse(outcome.output).at("met");
    EXPECT_FALSE(met.empty());
    const auto at = met.at(0).at("proxy_mm").get<std::array<double, 3>>();
    return Met{std::abs(radius - std::hypot(at[0], at[1], at[2])), met.at(0).at("known_to_mm").get<double>()};
  };
  const Met clean = met_in(0), noisy = met_in(80);
  // The skin's level lies beside the middle of air and tissue, so a place is felt beside the sphere even without noise.
  EXPECT_GT(clean.missed_mm, 0.1);
  EXPECT_GT(clean.known_to_mm, clean.missed_mm);
  EXPECT_LT(clean.known_to_mm, clean.missed_mm + 0.1);
  // 80 HU, of which the cubic leaves about 0.4, on a slope of some 550 HU/mm: two standard deviations are 0.12 mm.
  EXPECT_GT(noisy.known_to_mm, clean.known_to_mm);
  EXPECT_GT(noisy.known_to_mm, noisy.missed_mm);
  EXPECT_LT(noisy.known_to_mm, noisy.missed_mm + 0.3);
}

TEST(Command, RefusesBadInputAndLeavesNothing) {
  const auto out = fresh_path("refused");
  const std::string tail = " -o " + out.string();
  const auto refused = [&](const std::string& arguments, int exit, const std::string& words) {
    const Outcome outcome = palpate(arguments + tail);
    EXPECT_EQ(outcome.exit, exit) << arguments << "\n" << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(words)) << arguments;
    EXPECT_FALSE(std::filesystem::exists(out)) << arguments;
  };
  const auto empty = fresh_path("empty_folder");
  std::filesystem::create_directory(empty);
  const std::string scan = "probe " + phantom().string() + forehead;
  refused("probe /no/such/folder", 1, "/no/such/folder");
  refused("probe " + empty.string(), 1, "empty_folder");
  refused(scan + "--scene no-such-scene", 1, "no-such-scene");
  refused(scan + "--scene " +
              write_scene("mode.json", R"({"version":1,"name":"x","modes":[{"type":"surfce","strength_n":1}]})"),
          1, "modes[0].type");
  refused(
      scan + "--scene " +
          write_scene(
              "negative.json",
              R"({"version":1,"name":"x","modes":[{"type":"friction","strength_n":{"of":"value","nodes":[[0,-2]]}}]})"),
      1, "modes[0].strength_n.nodes[0][1]");
  refused(scan + "--scene " + write_scene("k.json", R"({"version":1,"name":"x","stiffness_n_per_m":0,"modes":[]})"), 1,
          "stiffness_n_per_m");
  refused(scan + "--device harpoon", 2, "harpoon");
  refused("probe " + phantom().string() + " --from 100,100,100 --to 100,100,200", 1, "nothing can be felt");
}

TEST(Command, SeveralSeriesAndNoneChosenListsThem) {
  const auto both = fresh_path("both");
  const auto geometry = testdata::make_geometry({.size = glm::ivec3(8)});
  testdata::write_series(testdata::scan(testdata::make_sphere(3), geometry), both / "a", {.description = "first"});
  testdata::write_series(testdata::scan(testdata::make_sphere(2), geometry), both / "b",
                         {.description = "second", .number = 2});
  const Outcome none = palpate("profile " + both.string() + " --from 0,-3,0 --to 0,0,0");
  EXPECT_EQ(none.exit, 2);
  EXPECT_THAT(none.output, ::testing::AllOf(HasSubstr("first"), HasSubstr("second"), HasSubstr("--series")));
  EXPECT_EQ(palpate("profile " + both.string() + " --series 1 --from 0,-3,0 --to 0,0,0").exit, 0);
  EXPECT_EQ(palpate("profile " + both.string() + " --series 3 --from 0,-3,0 --to 0,0,0").exit, 2);
}

TEST(Command, SolveAnswersEveryLineOfItsInput) {
  const auto input = fresh_path("balances.jsonl");
  std::ofstream(input) << R"({"id":1,"stiffness":400,"probe":[0,0,-0.002],"primitives":[)"
                          R"({"type":"plane","strength":2,"position":[0,0,0],"direction":[0,0,1]}]})"
                       << "\n";
  const Outcome solved = palpate("solve --solver exact --repeat 3 < " + input.string(), false);
  EXPECT_EQ(solved.exit, 0);
  const auto answer = nlohmann::json::parse(solved.output);
  EXPECT_EQ(answer["id"], 1);
  EXPECT_EQ(answer["solver"], "exact");
  EXPECT_NEAR(answer["force"][2].get<double>(), 0.8, 1e-14);

  std::ofstream(input, std::ios::app) << "\n"
                                      << R"({"id":3,"stiffness":-1,"probe":[0,0,0],"primitives":[]})";
  const Outcome partly = palpate("solve < " + input.string(), false);
  EXPECT_EQ(partly.exit, 1);
  std::istringstream lines(partly.output);
  std::vector<nlohmann::json> answers;
  for (std::string line; std::getline(lines, line);) answers.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_TRUE(answers[0].contains("proxy"));
  EXPECT_EQ(answers[1]["error"], "the line is empty");
  EXPECT_EQ(answers[2]["id"], 3);
  EXPECT_EQ(answers[2]["error"], "stiffness is not positive (-1)");
  EXPECT_EQ(palpate("solve --solver magic < /dev/null").exit, 2);
}

/// At the end it is said how many lines were not solved, and of how many.
TEST(Command, SolveCountsItsLines) {
  const auto input = fresh_path("bad_balances.jsonl");
  for (int lines = 1; lines <= 3; ++lines) {
    std::ofstream(input, std::ios::app) << "{}\n";
    const Outcome outcome = palpate("solve < " + input.string());
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_THAT(outcome.output, HasSubstr(std::to_string(lines) + " of " + std::to_string(lines) + " line" +
                                          (lines == 1 ? "" : "s") + " could not be solved"));
  }
}

/// A port has 16 bits: another number is wrong usage, before anything is read.
TEST(Command, ServeRefusesWhatIsNoPort) {
  for (const char* const port : {"65536", "100000", "131070", "-1"}) {
    EXPECT_EQ(palpate("serve /no/such/scan --port=" + std::string(port)).exit, 2) << port;
  }
  for (const char* const port : {"0", "1024", "65535"}) {
    EXPECT_EQ(palpate("serve /no/such/scan --port=" + std::string(port)).exit, 1) << port;
  }
}

TEST(Command, NothingIsOverwritten) {
  const auto out = fresh_path("kept");
  std::filesystem::create_directory(out);
  std::ofstream(out / "recording.h5") << "precious";
  EXPECT_EQ(palpate("probe " + phantom().string() + forehead + "-o " + out.string()).exit, 1);
  EXPECT_EQ(std::filesystem::file_size(out / "recording.h5"), 8U);
}

TEST(Command, WithoutASceneTakesTheOneOfThePartOfTheBody) {
  const auto chest = fresh_path("chest");
  std::filesystem::copy(phantom(), chest);
  ASSERT_EQ(run_command("dcmodify -nb -i '(0018,0015)=CHEST' " + chest.string() + "/* 2>&1").exit, 0);
  for (const std::string& command : {std::string("plan"), "profile" + forehead}) {
    const auto told = [&](const std::filesystem::path& scan, const std::string& scene) {
      const Outcome outcome = palpate(command + ' ' + scan.string() + " --json" + scene, false);
      EXPECT_EQ(outcome.exit, 0) << command;
      const auto json = nlohmann::json::parse(outcome.output);
      return json.value("modes", json);  // a plan tells times, too
    };
    EXPECT_EQ(told(chest, ""), told(chest, " --scene ct-chest")) << command;
    EXPECT_NE(told(chest, ""), told(chest, " --scene ct-skin-and-bone")) << command;
    EXPECT_EQ(told(phantom(), ""), told(phantom(), " --scene ct-skin-and-bone")) << command;
  }
}

}  // namespace
}  // namespace palpate::plugin
