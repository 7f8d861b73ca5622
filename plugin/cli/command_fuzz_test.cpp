// Random arguments, as from faulty scripts: the program ends with one of its exit codes, and prints the reason on
// stderr. PALPATE_FUZZ_COMMANDS sets their number.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "io/testing/working_folder.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;

using Words = std::vector<std::string>;

/// What each command takes; what makes it work, or nearly.
struct Command {
  Words begin;
  Words options;
};

const std::map<std::string, Command>& commands(const std::string& scan, const std::string& recording) {
  static const std::map<std::string, Command> all{
      {"info", {{scan}, {"--json", "--patient"}}},
      {"sample", {{scan, "--at", "0,0,0"}, {"--series", "--frame", "--at", "--scale", "--json"}}},
      {"suggest", {{scan}, {"--series", "--frame", "--structures", "-o"}}},
      {"plan", {{scan}, {"--scene", "--series", "--frame", "--json"}}},
      {"profile",
       {{scan, "--from", "0,-29,0", "--to", "0,-20,0"},
        {"--from", "--to", "--scene", "--speed", "-o", "--table", "--json"}}},
      {"probe",
       {{scan, "--seconds", "0.02", "-o", "OUT"},
        {"--scene", "--path", "--from", "--to", "--device", "--firmware", "--device-settings", "--seed", "--rate",
         "--live", "--json"}}},
      {"replay", {{recording, scan}, {"--csv", "--json", "--series", "--frame"}}},
      {"compare", {{recording, recording, scan}, {"-o", "--table", "--json", "--series"}}},
      {"solve", {{}, {"--solver", "--repeat"}}},
      {"devices", {{}, {"--json"}}}};
  return all;
}

const Words& odd_words() {
  static const Words all{
      "",         "0",         "-1",       "1",           "1e300",   "nan", "inf",    "1e-320", "99999999999999999999",
      "0,0,0",    "1e300,0,0", "nan,0,0",  "1,2",         "1,2,3,4", ",,",  "a,b,c",  "flow",   "no-scene",
      "{}",       "falcon@0",  "falcon@x", "space_mouse", "--",      "-x",  "--json", "%s%n",   "\xff\xfe",
      "/nowhere", "2.25.1",    "OUT.png",  "exact"};
  return all;
}

std::string quoted(const std::string& word) {
  return "'" + word + "'";
}

TEST(CommandFuzz, AnswersWhateverItIsAskedWithAnExitCodeAndAReason) {
  const auto out = fresh_path("fuzzed");
  // Some of the words name files that are then written: not in the folder that the tests are run in.
  const auto here = fresh_path("here");
  std::filesystem::create_directories(here);
  const io::testing::WorkingFolder elsewhere(here);
  const std::string recorded = (fresh_path("recorded")).string();
  ASSERT_EQ(palpate("probe " + phantom().string() + forehead + "--seconds 0.1 -o " + recorded).exit, 0);
  const auto& all = commands(phantom().string(), recorded + "/recording.h5");
  const char* const wanted = std::getenv("PALPATE_FUZZ_COMMANDS");
  const int count = wanted ? std::atoi(wanted) : 80;
  std::mt19937_64 random(20261121);
  const auto one_of = [&](const auto& words) {
    auto at = words.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(random() % words.size()));
    return *at;
  };
  std::map<int, int> exits;
  for (int n = 0; n < count; ++n) {
    const auto [name, command] = one_of(all);
    Words words{name};
    for (const std::string& word : command.begin) {
      const bool left_out = random() % 16 == 0;
      const bool replaced = random() % 16 == 0;
      if (!left_out) words.push_back(replaced ? one_of(odd_words()) : word);
    }
    for (std::size_t more = random() % 3; more > 0; --more) {
      words.push_back(one_of(command.options));
      if (random() % 8 != 0) words.push_back(one_of(odd_words()));
    }
    std::string line;
    for (const std::string& word : words) line += " " + quoted(word);
    std::size_t place = 0;
    while ((place = line.find("OUT", place)) != std::string::npos) line.replace(place, 3, out.string());
    const Outcome outcome = palpate(line + " </dev/null");
    ++exits[outcome.exit];
    EXPECT_THAT(outcome.exit, ::testing::AnyOf(0, 1, 2)) << "palpate" << line << "\n" << outcome.output;
    EXPECT_TRUE(outcome.exit == 0 || !outcome.output.empty()) << "no reason is given: palpate" << line;
    std::filesystem::remove_all(out);
    std::filesystem::remove(out.string() + ".png");
  }
  // It would be no test if all were refused at once.
  EXPECT_GT(exits[0], count / 10);
  EXPECT_GT(exits[1] + exits[2], count / 10);
}

}  // namespace
}  // namespace palpate::plugin
