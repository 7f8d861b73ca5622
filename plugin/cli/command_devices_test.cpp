// `palpate devices`: on the fakes that a program can reach (loaded libraries, a service on a socket), and its check of
// the axes on every fake, in this process and in the fake's own time.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "device/safety/safety_filter.h"
#include "device/testing/fake_rigs.h"
#include "device/testing/haply_server.h"
#include "plugin/app/errors.h"
#include "plugin/cli/check_device.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::Not;

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
  EXPECT_EQ(found.at("kinds").size(), device::device_types().size());
  const std::string text = palpate("devices").output;
  for (const auto& kind : found.at("kinds")) {
    const std::string line = fmt::format("{} ({}): {}\n", kind.at("name").get<std::string>(),
                                         kind.at("sold").get<std::string>(), kind.at("tested").get<std::string>());
    EXPECT_THAT(text, HasSubstr(line));
  }
  EXPECT_THAT(text, HasSubstr("A session holds one stylus at a time. Torque stays zero"));
}

/// The text tells of each stylus what the JSON does: whether it may be opened, and what takes its force away when the
/// program dies.
TEST_F(CommandDevices, TheTextTellsWhatTheJsonDoes) {
  const auto json = nlohmann::json::parse(palpate("devices --json", false).output);
  const std::string text = palpate("devices").output;
  std::map<std::string, nlohmann::json> kinds;
  for (const auto& kind : json.at("kinds")) kinds[kind.at("kind").get<std::string>()] = kind;
  int listed = 0;
  for (const auto& one : json.at("devices")) {
    const auto& kind = kinds.at(one.at("kind").get<std::string>());
    const std::string head = fmt::format("{}  {}\n  '{}'\n", one.at("kind").get<std::string>(),
                                         one.at("address").get<std::string>(), one.at("name").get<std::string>());
    const std::size_t begin = text.find(head);
    if (one.at("kind") == "simulated") continue;
    ASSERT_NE(begin, std::string::npos) << head;
    // Its lines are indented; the next stylus is not.
    std::istringstream lines(text.substr(begin + head.size()));
    std::string about;
    for (std::string line; std::getline(lines, line) && line.starts_with("  ");) about += line + "\n";
    EXPECT_EQ(about.find("PERMISSION DENIED") == std::string::npos, one.at("accessible").get<bool>()) << about;
    const auto has_line = [&](const std::string& words, const char* key) {
      const auto told = kind.at(key).get<std::string>();
      EXPECT_EQ(about.find(words + told + "\n") != std::string::npos, !told.empty()) << about;
    };
    has_line("  if the program dies: ", "watchdog");
    has_line("  to home: ", "homing");
    has_line("  needs: ", "needs");
    ++listed;
  }
  EXPECT_GE(listed, 3);
  const auto advice = json.at("realtime").at("advice").get<std::string>();
  EXPECT_THAT(text, HasSubstr("\nReal time: " + (advice.empty() ? "allowed" : advice) + "\n"));
}

/// What `palpate devices --check` says and writes of a stylus whose time is its own.
struct Checked {
  std::string output;
  std::string refusal;
  std::filesystem::path file;
};

/// Milliseconds of the stylus' own time.
std::function<double()> ticks_of(const device::FakeRig& rig) {
  return [&rig] {
    const double until = rig.now() + 1e-3;
    while (rig.now() < until - 1e-9) rig.exchange();
    return rig.now();
  };
}

/// The answers are those of a person, a line each; without any of them nobody is asked.
Checked check(const device::FakeRig& rig, const std::string& answers, const std::function<double()>& next_tick,
              const std::string& settings = {}) {
  static int files = 0;
  Checked checked{.file = fresh_path(fmt::format("settings_{}.json", ++files))};
  DeviceCheck wanted;
  wanted.stylus.device = rig.type->kind;
  wanted.stylus.settings = settings;
  wanted.output = checked.file.string();
  wanted.yes = answers.empty();
  std::istringstream typed(answers);
  std::streambuf* const terminal = std::cin.rdbuf(typed.rdbuf());
  ::testing::internal::CaptureStdout();
  try {
    check_device(wanted, *rig.stylus, next_tick);
  } catch (const InputRefused& refused) {
    checked.refusal = refused.what();
  }
  std::cin.rdbuf(terminal);
  std::cin.clear();
  checked.output = ::testing::internal::GetCapturedStdout();
  return checked;
}

constexpr const char* not_all_felt =
    ": not every push was felt in the direction that was said; the result stands above and in the settings file";
constexpr const char* not_finished = ": the check ended before every axis was pushed; nothing was written";

TEST(CheckDevice, PushesEachAxisAndWritesTheSettings) {
  for (const char* const kind : device::rig_kinds()) {
    const device::FakeRig rig = device::make_rig(kind);
    if (!rig.type->has_force) continue;
    const Checked checked = check(rig, "", ticks_of(rig));
    EXPECT_EQ(checked.refusal, "") << kind;
    EXPECT_THAT(checked.output, HasSubstr("Axis x: a push to the right with 0.2 N")) << kind;
    EXPECT_THAT(checked.output, HasSubstr("Axis y: a push up with 0.2 N")) << kind;
    EXPECT_THAT(checked.output, HasSubstr("Axis z: a push towards you with 0.2 N")) << kind;
    for (const char axis : {'x', 'y', 'z'}) {
      EXPECT_THAT(checked.output, HasSubstr(fmt::format("Axis {}: as it should be.", axis))) << kind;
    }
    if (rig.is_arithmetic()) continue;  // it has no settings
    const auto settings = json_of(checked.file);
    EXPECT_EQ(settings.at("force_signs"), nlohmann::json({1.0, 1.0, 1.0})) << kind;
    EXPECT_EQ(settings.at("position_signs"), nlohmann::json({1.0, 1.0, 1.0})) << kind;
    EXPECT_EQ(settings.at("maximum_force"), rig.stylus->specification().maximum_force) << kind;
    EXPECT_EQ(settings.at("stiffness_limit"), rig.stylus->specification().stiffness_limit) << kind;
  }
}

TEST(CheckDevice, WhatTheHandAnswersTurnsAnAxisRound) {
  const device::FakeRig rig = device::make_rig("haply");
  const Checked checked = check(rig, "y\n\ny\n\no\n\ny\n", ticks_of(rig));
  EXPECT_THAT(checked.refusal, HasSubstr(not_all_felt));
  EXPECT_THAT(checked.output, HasSubstr("Axis y: the position runs the other way: turned round."))
      << "it moved as it was said, and the hand felt the opposite";
  const auto settings = json_of(checked.file);
  EXPECT_EQ(settings.at("force_signs"), nlohmann::json({1.0, -1.0, 1.0}));
  EXPECT_EQ(settings.at("position_signs"), nlohmann::json({1.0, -1.0, 1.0}));
  // What is found is found on top of the settings that the driver has read.
  const device::FakeRig again = device::make_rig("haply");
  const auto both = json_of(check(again, "y\n\ny\n\no\n\ny\n", ticks_of(again), checked.file.string()).file);
  EXPECT_EQ(both.at("force_signs"), nlohmann::json({1.0, 1.0, 1.0}));
  EXPECT_EQ(both.at("position_signs"), nlohmann::json({1.0, 1.0, 1.0}));
}

/// A stylus whose height is told upside down.
class UpsideDown : public device::Stylus {
 public:
  explicit UpsideDown(std::shared_ptr<device::Stylus> real) : real_(std::move(real)) {}
  device::Specification specification() const override { return real_->specification(); }
  void open() override { real_->open(); }
  void close() noexcept override { real_->close(); }
  device::Reading read() noexcept override {
    device::Reading reading = real_->read();
    reading.position.y = -reading.position.y;
    return reading;
  }
  void write_force(const device::Vec3& force) noexcept override { real_->write_force(force); }
  device::State state() const noexcept override { return real_->state(); }

 private:
  std::shared_ptr<device::Stylus> real_;
};

/// The person is told which way the stylus says that it moved: along the push, or against it where an axis is turned.
TEST(CheckDevice, SaysWhichWayTheStylusMoved) {
  for (const bool turned : {false, true}) {
    device::FakeRig rig = device::make_rig("haply");
    const auto next_tick = [ticks = ticks_of(rig)] { return ticks(); };
    if (turned) rig.stylus = std::make_shared<UpsideDown>(rig.stylus);
    const std::string output = check(rig, "", next_tick).output;
    EXPECT_THAT(output, ::testing::ContainsRegex("The stylus says that it moved [0-9.]+ mm to the right\\."));
    EXPECT_THAT(output, ::testing::ContainsRegex(turned ? "moved [0-9.]+ mm against up\\." : "moved [0-9.]+ mm up\\."));
    EXPECT_THAT(output, ::testing::ContainsRegex("moved [0-9.]+ mm towards you\\."));
  }
}

TEST(CheckDevice, AStylusThatIsLostIsSaidAndNothingIsWritten) {
  const device::FakeRig rig = device::make_rig("haply");
  const auto next_tick = [&, tick = ticks_of(rig), ticks = 0]() mutable {
    if (++ticks == 500) rig.unplug();
    return tick();
  };
  const Checked checked = check(rig, "", next_tick);
  EXPECT_THAT(checked.output,
              HasSubstr(fmt::format("The force was taken away: {}. {}", name_of(device::Fault::device_lost),
                                    advice_for(device::Fault::device_lost))));
  EXPECT_THAT(checked.refusal, HasSubstr(not_finished));
  EXPECT_FALSE(std::filesystem::exists(checked.file));
}

TEST(CheckDevice, WhoEndsItGetsNoSettings) {
  const device::FakeRig rig = device::make_rig("haply");
  const Checked checked = check(rig, "y\n\ny\nq\n", ticks_of(rig));
  EXPECT_THAT(checked.refusal, HasSubstr(not_finished));
  EXPECT_THAT(checked.output, Not(HasSubstr("Axis z: a push")));
  EXPECT_FALSE(std::filesystem::exists(checked.file));
}

/// On the computer's clock, however busy the machine is. These fakes' arms stand still: no push is felt by the pose,
/// and nothing is turned round. Where an answer came too late, the force went, which is said, and nothing is written.
TEST_F(CommandDevices, ChecksEachFakeOnTheComputersClock) {
  const std::vector<std::string> kinds{"haply@049D", "touch", "force_dimension"};
  std::vector<std::future<void>> checks;
  for (const std::string& kind : kinds) {
    checks.push_back(std::async(std::launch::async, [kind, file = fresh_path(kind + ".json")] {
      const Outcome outcome = palpate("devices --check " + kind + " --yes -o " + file.string());
      EXPECT_EQ(outcome.exit, 1) << kind;
      EXPECT_THAT(outcome.output, HasSubstr("Axis x: a push to the right with 0.2 N")) << kind;
      if (outcome.output.find("The force was taken away: ") != std::string::npos) {
        EXPECT_THAT(outcome.output, HasSubstr(not_finished)) << kind;
        EXPECT_FALSE(std::filesystem::exists(file)) << kind;
        return;
      }
      EXPECT_THAT(outcome.output, HasSubstr(not_all_felt)) << kind;
      const auto settings = json_of(file);
      ASSERT_TRUE(settings.is_object()) << kind << ": " << outcome.output;
      EXPECT_EQ(settings.value("force_signs", nlohmann::json()), nlohmann::json({1.0, 1.0, 1.0})) << kind;
      EXPECT_EQ(settings.value("address", ""), kind == "haply@049D" ? "049D" : "");
    }));
  }
  for (auto& one : checks) one.get();
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

/// Its time is its own: three pushes of a second each are over much sooner.
TEST(CheckDevice, TheSimulatedOneNeedsNoClock) {
  DeviceCheck wanted;
  wanted.stylus.device = "simulated";
  wanted.yes = true;
  ::testing::internal::CaptureStdout();
  const auto begin = std::chrono::steady_clock::now();
  check_device(wanted);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("Axis z: as it should be."));
  EXPECT_LT(took.count(), 2.5);
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

/// The keys are a contract; a missed goal is an exit status.
TEST_F(CommandDevices, PlaysTheFaultsOfTheDeviceThatIsNamed) {
  const Outcome outcome = palpate("devices --faults falcon --json", false);
  EXPECT_EQ(outcome.exit, 0);
  const auto rows = nlohmann::json::parse(outcome.output);
  ASSERT_GT(rows.size(), 15U);
  int by_device = 0;
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("device"), "Novint Falcon");
    EXPECT_FALSE(row.at("event").get<std::string>().empty());
    EXPECT_TRUE(row.at("largest_after_n").is_number());
    EXPECT_TRUE(row.at("largest_step_n").is_number());
    const bool is_null = row.at("zero_taken_s").is_null();
    EXPECT_TRUE(is_null || row.at("ended_by") != "device");
    EXPECT_TRUE(!is_null || row.at("ended_by") != "program");
    by_device += row.at("ended_by") == "device" ? 1 : 0;
  }
  EXPECT_GT(by_device, 0);
  const Outcome table = palpate("devices --faults falcon");
  EXPECT_THAT(table.output, HasSubstr("unplugged in contact"));
  EXPECT_THAT(table.output, Not(HasSubstr("Haply")));
  EXPECT_THAT(table.output, Not(HasSubstr("MISSED")));
  EXPECT_EQ(palpate("devices --faults toaster").exit, 2) << "no such kind";
}

}  // namespace
}  // namespace palpate::plugin
