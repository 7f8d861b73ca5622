// `palpate devices --check` on the fakes that a program can reach: libraries that it loads, a service on a socket.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "device/testing/haply_server.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;
using ::testing::HasSubstr;

nlohmann::json json_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream, nullptr, false);
}

class CommandDevices : public ::testing::Test {
 protected:
  CommandDevices() {
    setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
    setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
    setenv("PALPATE_HAPLY", ("localhost:" + std::to_string(server_.port())).c_str(), 1);
  }
  ~CommandDevices() override {
    for (const char* name : {"PALPATE_LIBHD", "PALPATE_LIBDRD", "PALPATE_HAPLY"}) unsetenv(name);
  }
  device::HaplyServer server_;
};

TEST_F(CommandDevices, ListsEachFakeAndHowItWasTested) {
  const Outcome outcome = palpate("devices --json", false);
  ASSERT_EQ(outcome.exit, 0);
  const auto found = nlohmann::json::parse(outcome.output);
  std::map<std::string, nlohmann::json> by_kind;
  for (const auto& one : found.at("devices")) by_kind[one.at("kind").get<std::string>()] = one;
  EXPECT_EQ(by_kind.at("haply").at("address"), "049D");
  EXPECT_THAT(by_kind.at("haply").at("note").get<std::string>(), HasSubstr("gravity compensation on"));
  EXPECT_EQ(by_kind.at("force_dimension").at("address"), "1234");
  for (const char* kind : {"haply", "touch", "force_dimension"}) {
    EXPECT_EQ(by_kind.at(kind).at("tested"), "protocol-tested, never run on hardware");
  }
  EXPECT_EQ(found.at("kinds").size(), 7U);
  const std::string text = palpate("devices").output;
  for (const auto& kind : found.at("kinds")) {
    const std::string line = fmt::format("{} ({}): {}\n", kind.at("name").get<std::string>(),
                                         kind.at("sold").get<std::string>(), kind.at("tested").get<std::string>());
    EXPECT_THAT(text, HasSubstr(line));
  }
  EXPECT_THAT(text, HasSubstr("A session holds one stylus at a time. Torque stays zero"));
}

/// The fakes' arms stand still: a push is not felt by the pose, and that is said; nothing is turned round.
TEST_F(CommandDevices, PushesEachAxisAndWritesTheSettings) {
  for (const std::string kind : {"haply", "touch", "force_dimension"}) {
    const auto file = fresh_path(kind + ".json");
    const Outcome outcome = palpate("devices --check " + kind + " --yes -o " + file.string());
    EXPECT_EQ(outcome.exit, 1) << kind;
    EXPECT_THAT(outcome.output, HasSubstr("Axis x: a push to the right with 0.2 N")) << kind;
    EXPECT_THAT(outcome.output, HasSubstr("Axis z: a push towards you with 0.2 N")) << kind;
    EXPECT_THAT(outcome.output, HasSubstr(": not every push was felt in the direction that was said; the result stands "
                                          "above and in the settings file"))
        << kind;
    const auto settings = json_of(file);
    EXPECT_EQ(settings.at("force_signs"), nlohmann::json({1.0, 1.0, 1.0})) << kind;
    EXPECT_GT(settings.at("maximum_force").get<double>(), 1) << kind;
  }
}

TEST_F(CommandDevices, WhatTheHandAnswersTurnsAnAxisRound) {
  const auto file = fresh_path("haply_hand.json");
  const Outcome outcome = run_command("{ printf 'y\\n\\ny\\n\\no\\n\\ny\\n' | " + std::string(PALPATE_PROGRAM) +
                                      " devices --check haply@049D -o " + file.string() + "; } 2>&1");
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.output, HasSubstr("Axis y: the force runs the other way: turned round."));
  const auto settings = json_of(file);
  EXPECT_EQ(settings.at("force_signs"), nlohmann::json({1.0, -1.0, 1.0}));
  EXPECT_EQ(settings.at("address"), "049D");
  // The file is one that the driver reads, and what is found is found on top of it.
  const auto again = fresh_path("haply_hand_again.json");
  run_command("{ printf 'y\\n\\ny\\n\\no\\n\\ny\\n' | " + std::string(PALPATE_PROGRAM) + " devices --check haply -o " +
              again.string() + " --device-settings " + file.string() + "; } 2>&1");
  EXPECT_EQ(json_of(again).at("force_signs"), nlohmann::json({1.0, 1.0, 1.0}));
}

TEST_F(CommandDevices, NothingMovesBeforeTheUserAgrees) {
  const auto file = fresh_path("unasked.json");
  const std::string check = std::string(PALPATE_PROGRAM) + " devices --check haply -o " + file.string();
  EXPECT_EQ(run_command("{ echo n | " + check + "; } 2>&1").exit, 0);
  const Outcome mute = run_command("{ " + check + " </dev/null; } 2>&1");
  EXPECT_EQ(mute.exit, 2);
  EXPECT_THAT(mute.output, HasSubstr("the check needs an answer to each push; call it from a terminal, or with --yes"));
  EXPECT_EQ(server_.sessions(), 0) << "the device was not even opened";
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(CommandDevices, TheSimulatedOneIsPushedWhereItSays) {
  const Outcome outcome = palpate("devices --check simulated --yes");
  EXPECT_EQ(outcome.exit, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("Axis y: as it should be."));
}

TEST_F(CommandDevices, RefusesWhatCannotBeChecked) {
  const Outcome puck = palpate("devices --check space_mouse --yes");
  EXPECT_EQ(puck.exit, 1);
  EXPECT_THAT(puck.output, HasSubstr("3Dconnexion SpaceMouse: it has no motors, and nothing to check; move it and look "
                                     "at its pose in the panel"));
  const std::string file = fresh_path("there.json").string();
  std::ofstream(file) << "{}";
  const Outcome there = palpate("devices --check touch --yes -o " + file);
  EXPECT_EQ(there.exit, 1);
  EXPECT_THAT(there.output, HasSubstr(file + " is there already; name another file with -o"));
}

}  // namespace
}  // namespace palpate::plugin
