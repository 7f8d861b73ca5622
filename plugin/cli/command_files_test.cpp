// What a command writes: it all goes out or the exit says so, and it never replaces what the command reads.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using namespace testing;
using ::testing::HasSubstr;

/// Of one session on the phantom.
const fs::path& recording() {
  static const fs::path file = [] {
    const fs::path out = fresh_path("felt");
    EXPECT_EQ(palpate("probe " + phantom().string() + forehead + "--seconds 1 -o " + out.string()).exit, 0);
    return out / "recording.h5";
  }();
  return file;
}

TEST(CommandFiles, OutputThatCannotBeWrittenIsToldByEveryCommand) {
  const std::string scan = phantom().string(), felt = recording().string();
  const std::vector<std::string> commands{
      "--help",
      "--version",
      "info " + scan,
      "info --json " + scan,
      "sample " + scan + " --at 0,0,0",
      "suggest " + scan,
      "suggest " + scan + " -o " + fresh_path("full.json").string(),
      "plan " + scan,
      "plan --json " + scan,
      "profile " + scan + forehead,
      "profile --json " + scan + forehead,
      "probe " + scan + forehead + "--seconds 0.2 -o " + fresh_path("full_out").string(),
      "record " + scan + forehead + "--seconds 0.2 -o " + fresh_path("full.h5").string(),
      "replay " + felt + " " + scan,
      "replay --json " + felt + " " + scan,
      "compare " + felt + " " + felt + " " + scan,
      "marks " + felt + " " + scan,
      "devices",
      "devices --json",
      "archive list",
      "archive list --json"};
  for (const std::string& command : commands) {
    const Outcome outcome = run_command("{ " PALPATE_PROGRAM " " + command + " >/dev/full; } 2>&1");
    EXPECT_EQ(outcome.exit, 1) << command;
    EXPECT_THAT(outcome.output, HasSubstr("palpate: standard output cannot be written\n")) << command;
  }
  EXPECT_EQ(run_command("{ " PALPATE_PROGRAM " replay " + felt + " --csv " + fresh_path("a.csv").string() +
                        " >/dev/full; } 2>&1")
                .exit,
            0)
      << "nothing is printed";
}

/// A command that reads `input`, and is to write it, too.
struct Overwriting {
  std::string command;
  fs::path input;
};

void expect_refused(const Overwriting& one) {
  const std::string before = text_in(one.input);
  ASSERT_FALSE(before.empty()) << one.input;
  const Outcome outcome = palpate(one.command);
  EXPECT_EQ(outcome.exit, 1) << one.command << "\n" << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr(" is read by this command, and would be replaced; name another file to write"))
      << one.command;
  EXPECT_EQ(text_in(one.input), before) << one.command;
}

TEST(CommandFiles, NoCommandReplacesWhatItReads) {
  const fs::path own = fresh_path("own");  // its scan may be spoiled
  fs::create_directories(own);
  fs::copy(phantom(), own / "scan");
  const fs::path slice = fs::directory_iterator(own / "scan")->path();
  const fs::path scene = own / "scene.json", felt = own / "felt.h5", other = own / "other.h5";
  fs::copy_file(recording(), felt);
  fs::copy_file(recording(), other);
  fs::create_symlink(felt, own / "link.csv");
  fs::create_hard_link(felt, own / "hard.csv");
  const std::string scan = (own / "scan").string();
  ASSERT_EQ(palpate("suggest " + scan + " -o " + scene.string()).exit, 0);
  const std::string replay = "replay " + felt.string(), profile = "profile " + scan + forehead;
  const std::string compare = "compare " + felt.string() + " " + other.string() + " " + scan;
  const std::vector<Overwriting> all{
      {replay + " --csv " + felt.string(), felt},
      {replay + " " + scan + " --csv " + felt.string(), felt},
      {replay + " --csv " + (own / "scan/../felt.h5").string(), felt},
      {replay + " --csv " + (own / "link.csv").string(), felt},
      {replay + " --csv " + (own / "hard.csv").string(), felt},
      {replay + " " + scan + " --csv " + slice.string(), slice},
      {compare + " --table " + other.string(), other},
      {compare + " --table " + slice.string(), slice},
      {compare + " -o " + felt.string(), felt},
      {profile + "--scene " + scene.string() + " --table " + scene.string(), scene},
      {profile + "--scene " + scene.string() + " -o " + scene.string(), scene},
      {profile + "--table " + slice.string(), slice},
      {"suggest " + scan + " -o " + slice.string(), slice},
  };
  for (const Overwriting& one : all) expect_refused(one);
  const fs::path both = own / "both";
  for (const std::string& command : {compare, profile}) {
    const Outcome outcome = palpate(command + " -o " + both.string() + " --table " + both.string());
    EXPECT_EQ(outcome.exit, 1) << command;
    EXPECT_THAT(outcome.output, HasSubstr(" would be written twice; name two files")) << command;
    EXPECT_FALSE(fs::exists(both));
  }
}

/// A scene's picture has its name; a picture of something else stays.
TEST(CommandFiles, SuggestReplacesNoOtherPicture) {
  const fs::path folder = fresh_path("suggested");
  fs::create_directories(folder);
  const fs::path picture = folder / "holiday.png", scene = folder / "holiday.json";
  std::ofstream(picture) << "the sea";
  const std::string suggest = "suggest " + phantom().string() + " -o ";
  const Outcome replaced = palpate(suggest + scene.string());
  EXPECT_EQ(replaced.exit, 1);
  EXPECT_THAT(replaced.output,
              HasSubstr(picture.string() + " is there already, and would be replaced by the picture of " +
                        scene.string() + "; name another scene"));
  EXPECT_EQ(text_in(picture), "the sea");
  EXPECT_FALSE(fs::exists(scene));
  const Outcome as_picture = palpate(suggest + (folder / "x.png").string());
  EXPECT_EQ(as_picture.exit, 1);
  EXPECT_THAT(as_picture.output, HasSubstr(": this ending is that of the picture beside the scene; name a .json file"));
  EXPECT_FALSE(fs::exists(folder / "x.png"));
  const std::string again = suggest + (folder / "scene.json").string();
  EXPECT_EQ(palpate(again).exit, 0);
  EXPECT_EQ(palpate(again).exit, 0) << "its own is replaced";
}

}  // namespace
}  // namespace palpate::plugin
