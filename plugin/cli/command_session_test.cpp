// `palpate probe`, `record` and `replay` as a person uses them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "device/simulated/simulated_stylus.h"
#include "io/testing/file_bytes.h"
#include "plugin/cli/ready_session.h"
#include "plugin/recording/recording.h"
#include "plugin/report/compare_strokes.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(CommandSession, WhatProbeRecordsReplaysToTheLastBitAndExports) {
  const auto out = fresh_path("probed");
  const auto csv = fresh_path("probed.csv");
  ASSERT_EQ(palpate("probe " + phantom().string() + forehead + "-o " + out.string()).exit, 0);
  const std::string recording = (out / "recording.h5").string();
  const Outcome same = palpate("replay " + recording + " " + phantom().string());
  EXPECT_EQ(same.exit, 0) << same.output;
  EXPECT_THAT(same.output, HasSubstr("the same to the last bit"));
  const Outcome json = palpate("replay " + recording + " " + phantom().string() + " --json", false);
  EXPECT_EQ(nlohmann::json::parse(json.output)["different"], 0);

  ASSERT_EQ(palpate("replay " + recording + " --csv " + csv.string()).exit, 0);
  std::ifstream lines(csv);
  std::string header, line;
  std::getline(lines, header);
  std::size_t rows = 0;
  while (std::getline(lines, line)) {
    ASSERT_EQ(std::count(line.begin(), line.end(), ','), std::count(header.begin(), header.end(), ',')) << line;
    ++rows;
  }
  EXPECT_EQ(rows, read_recording(recording).ticks.size());
  EXPECT_EQ(header.substr(0, 13), "index,time_s,");

  EXPECT_EQ(palpate("replay " + recording).exit, 2) << "neither a scan nor an export";
}

/// Of every tick in which a boundary of the scan holds the proxy, and of no other.
TEST(CommandSession, ARecordingTellsHowWellEachHeldBoundaryIsKnown) {
  const auto out = fresh_path("known");
  const Outcome probed = palpate("probe " + phantom().string() + forehead + "--json -o " + out.string(), false);
  ASSERT_EQ(probed.exit, 0);
  const auto holds = nlohmann::json::parse(probed.output)["holds"];
  ASSERT_FALSE(holds.empty());
  const Recording recording = read_recording(out / "recording.h5");
  ASSERT_EQ(recording.known_to_mm.size(), recording.ticks.size());
  std::size_t told = 0, first = recording.ticks.size();
  for (std::size_t n = 0; n < recording.ticks.size(); ++n) {
    if (!std::isfinite(recording.known_to_mm[n])) continue;
    ++told;
    first = std::min(first, n);
    const double* const force = recording.ticks[n].force_n;
    EXPECT_GT(std::hypot(force[0], force[1], force[2]), 0.01) << "a boundary that holds pushes";
  }
  EXPECT_GT(told, 300U);
  ASSERT_LT(first, recording.ticks.size());
  EXPECT_EQ(recording.ticks[first].time_s, holds[0]["begin_s"].get<double>());
  EXPECT_NEAR(recording.known_to_mm[first], holds[0]["known_to_mm"].get<double>(), 1e-9);
  const Outcome again =
      palpate("replay " + (out / "recording.h5").string() + " " + phantom().string() + " --json", false);
  const auto known = nlohmann::json::parse(again.output)["known_to_mm"];
  EXPECT_GT(known["median"].get<double>(), 0.005);
  EXPECT_GE(known["largest"].get<double>(), known["median"].get<double>());
}

/// A ball that shrinks in three phases: which of them was felt, the recording says, and replay finds it again.
TEST(CommandSession, ARecordingNamesTheFrameThatWasFelt) {
  const auto series = fresh_path("beating");
  std::filesystem::create_directory(series);
  for (int phase = 0; phase < 3; ++phase) {
    testdata::write_series(
        testdata::scan(testdata::make_sphere(25 - phase), testdata::make_geometry({.size = glm::ivec3(60)})),
        series / std::to_string(phase), {.study = "beating", .trigger_time_ms = 300.0 * phase});
  }
  const auto out = fresh_path("felt-late"), csv = fresh_path("felt-late.csv");
  const Outcome probed = palpate("probe " + series.string() + " --frame 2" + forehead + "-o " + out.string());
  ASSERT_EQ(probed.exit, 0) << probed.output;
  EXPECT_THAT(probed.output, HasSubstr("frame     2 of 0 to 2"));
  const std::string recording = (out / "recording.h5").string();
  ASSERT_EQ(read_recording(recording).scenes.at(0).frame, (ScanFrame{2, 3}));
  const Outcome again = palpate("replay " + recording + " " + series.string() + " --csv " + csv.string());
  EXPECT_EQ(again.exit, 0) << again.output;
  EXPECT_THAT(again.output, AllOf(HasSubstr("the same to the last bit"), HasSubstr("felt: frame 2 of 0 to 2")));
  const Outcome json = palpate("replay " + recording + " " + series.string() + " --json", false);
  EXPECT_EQ(nlohmann::json::parse(json.output)["scan_frames"], nlohmann::json::array({2}));
  std::ifstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_THAT(line, HasSubstr(",known_to_mm,scan_frame"));
}

TEST(CommandSession, ComparesTwoRecordingsOfOneStroke) {
  const auto first = fresh_path("once"), second = fresh_path("twice"), other = fresh_path("elsewhere");
  for (const auto& [out, seed] : {std::pair{first, "1"}, std::pair{second, "2"}}) {
    ASSERT_EQ(palpate("probe " + phantom().string() + forehead + "--seed " + seed + " -o " + out.string()).exit, 0);
  }
  const std::string both = (first / "recording.h5").string() + " " + (second / "recording.h5").string() + " ";
  const auto picture = fresh_path("both.png"), table = fresh_path("both.csv");
  const Outcome words =
      palpate("compare " + both + phantom().string() + " -o " + picture.string() + " --table " + table.string());
  EXPECT_EQ(words.exit, 0) << words.output;
  EXPECT_THAT(words.output, HasSubstr("Forces differ by at most"));
  EXPECT_TRUE(std::filesystem::exists(picture));
  EXPECT_TRUE(std::filesystem::exists(table));
  const auto json = nlohmann::json::parse(palpate("compare " + both + phantom().string() + " --json", false).output);
  EXPECT_EQ(json["first_n"].size(), json["along_mm"].size());
  EXPECT_GT(json["largest_difference_n"], 0) << "another tremor is another press";
  EXPECT_LT(json["most_apart_mm"], 1) << "and yet the same stroke";

  testdata::write_series(testdata::scan(testdata::make_sphere(24), testdata::make_geometry({.size = glm::ivec3(60)})),
                         other);
  const Outcome refused = palpate("compare " + both + other.string());
  EXPECT_EQ(refused.exit, 1);
  EXPECT_THAT(refused.output, ::testing::AllOf(HasSubstr("recording.h5"), HasSubstr("another scan")));
}

/// A recording that was changed is not the session, also where what was put in is no number.
TEST(CommandSession, AChangedRecordingIsRefusedByReplay) {
  const auto out = fresh_path("unchanged");
  ASSERT_EQ(palpate("probe " + phantom().string() + forehead + "--seconds 2 -o " + out.string()).exit, 0);
  const Recording original = read_recording(out / "recording.h5");
  const auto exit_of = [&](const auto& change) {
    Recording recording = original;
    change(recording.ticks);
    const auto file = fresh_path("changed.h5");
    write_recording(recording, file);
    const Outcome outcome = palpate("replay " + file.string() + " " + phantom().string());
    EXPECT_THAT(outcome.output, HasSubstr(outcome.exit == 0 ? "the same to the last bit" : "is not the session"));
    return outcome.exit;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(exit_of([](auto&) {}), 0);
  EXPECT_EQ(exit_of([](auto& ticks) { ticks[500].proxy_m[1] += 1e-3; }), 1);
  EXPECT_EQ(exit_of([](auto& ticks) { ticks[500].proxy_m[2] = nan; }), 1);
  EXPECT_EQ(exit_of([](auto& ticks) { ticks[500].sent_n[0] = nan; }), 1);
  EXPECT_EQ(exit_of([](auto& ticks) {
              ticks[500].proxy_m[0] = 1;
              ticks[600].proxy_m[0] = nan;
            }),
            1);
}

/// Also where its numbers would keep the session counting.
TEST(CommandSession, ADamagedRecordingIsNamedByReplay) {
  const auto out = fresh_path("damaged"), file = fresh_path("counts.h5");
  ASSERT_EQ(palpate("probe " + phantom().string() + forehead + "--seconds 0.3 -o " + out.string()).exit, 0);
  Recording recording = read_recording(out / "recording.h5");
  recording.scenes.push_back(recording.scenes.at(0));
  recording.scenes.back().epoch = recording.ticks.back().scene_epoch = 4'000'000'000;
  write_recording(recording, file);
  const Outcome outcome = palpate("replay " + file.string() + " " + phantom().string());
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.output, HasSubstr("palpate: " + file.string() +
                                        ": the recording goes on from its scene 0 to 4000000000: the file is damaged"));
}

/// What replay says of a recording that was changed at known ticks by known amounts, in words and as JSON.
TEST(CommandSession, ReplayTellsWhereAndByHowMuchARecordingDiffers) {
  const auto out = fresh_path("to change"), file = fresh_path("known.h5");
  ASSERT_EQ(palpate("probe " + phantom().string() + forehead + "--seconds 1 -o '" + out.string() + "'").exit, 0);
  Recording recording = read_recording(out / "recording.h5");
  const std::size_t all = recording.ticks.size();
  recording.ticks[300].proxy_m[0] += 3e-4;
  recording.ticks[310].error_bound_m = 5e-4;
  recording.ticks[400].sent_n[2] += 0.25;
  recording.ticks.erase(recording.ticks.begin() + 600, recording.ticks.begin() + 650);
  write_recording(recording, file);
  const std::string command = "replay " + file.string() + " " + phantom().string();
  const Outcome words = palpate(command);
  EXPECT_EQ(words.exit, 0) << "less than the two bounds: " << words.output;
  EXPECT_THAT(words.output,
              AllOf(HasSubstr("600 ticks replayed: 3 differ, the first is tick 300: the proxy by at most 3.0e-04 m "
                              "(certified bounds of the two together 5.0e-04 m), the force sent by at most 2.5e-01 N"),
                    HasSubstr(std::to_string(all - 650) + " ticks come after some that were lost")));
  const auto json = nlohmann::json::parse(palpate(command + " --json", false).output);
  EXPECT_EQ(json["frames"], 600);
  EXPECT_EQ(json["different"], 3);
  EXPECT_EQ(json["first_different"], 300);
  EXPECT_NEAR(json["largest_proxy_m"].get<double>(), 3e-4, 1e-9);
  EXPECT_NEAR(json["largest_bound_m"].get<double>(), 5e-4, 1e-9);
  EXPECT_NEAR(json["largest_force_n"].get<double>(), 0.25, 1e-9);
  EXPECT_EQ(json["after_gap"], all - 650);
}

/// Against the same way with all its forces doubled every number of a comparison is known.
TEST(CommandSession, ComparesWithAStrokeOfTwiceTheForce) {
  const auto out = fresh_path("single"), file = fresh_path("double.h5"), picture = fresh_path("single-double.png");
  ASSERT_EQ(palpate("probe " + phantom().string() + forehead + "--seconds 4 -o " + out.string()).exit, 0);
  Recording recording = read_recording(out / "recording.h5");
  for (TickRecord& tick : recording.ticks) {
    for (double& newtons : tick.sent_n) newtons *= 2;
  }
  write_recording(recording, file);
  const auto json = nlohmann::json::parse(palpate("compare " + (out / "recording.h5").string() + " " + file.string() +
                                                      " " + phantom().string() + " --json -o " + picture.string(),
                                                  false)
                                              .output);
  const std::vector<double> along_mm = json["along_mm"], first_n = json["first_n"], second_n = json["second_n"];
  ASSERT_GT(along_mm.size(), 10U);
  std::size_t most = 0;
  double sum_n = 0;
  for (std::size_t n = 0; n < along_mm.size(); ++n) {
    EXPECT_NEAR(second_n[n], 2 * first_n[n], 1e-12);
    sum_n += first_n[n];
    if (first_n[n] > first_n[most]) most = n;
  }
  EXPECT_GT(first_n[most], 0.1);
  EXPECT_NEAR(json["largest_difference_n"].get<double>(), first_n[most], 1e-12);
  EXPECT_EQ(json["largest_difference_at_mm"], along_mm[most]);
  EXPECT_NEAR(json["mean_difference_n"].get<double>(), sum_n / static_cast<double>(along_mm.size()), 1e-12);
  EXPECT_EQ(json["most_apart_mm"], 0);
  EXPECT_THAT(json["apart_mm"], ::testing::Each(0));
  // In the picture each curve has its own file's name.
  const Comparison compared{.along_mm = along_mm,
                            .first_n = first_n,
                            .second_n = second_n,
                            .apart_mm = json["apart_mm"].get<std::vector<double>>()};
  const auto wanted = fresh_path("wanted.png"), exchanged = fresh_path("exchanged.png");
  write_png(charts_of(compared, "recording", file.stem().string()), wanted);
  write_png(charts_of(compared, file.stem().string(), "recording"), exchanged);
  EXPECT_TRUE(io::internal::bytes_of(picture) == io::internal::bytes_of(wanted));
  EXPECT_FALSE(io::internal::bytes_of(picture) == io::internal::bytes_of(exchanged));
}

TEST(CommandSession, AnotherScanIsNotTheOneThatWasFelt) {
  const auto out = fresh_path("felt");
  const auto other = fresh_path("other");
  ASSERT_EQ(palpate("probe " + phantom().string() + forehead + "--seconds 1 -o " + out.string()).exit, 0);
  testdata::write_series(testdata::scan(testdata::make_sphere(24), testdata::make_geometry({.size = glm::ivec3(60)})),
                         other);
  const Outcome refused = palpate("replay " + (out / "recording.h5").string() + " " + other.string());
  EXPECT_EQ(refused.exit, 1);
  EXPECT_THAT(refused.output, HasSubstr("another scan"));
}

TEST(CommandSession, RecordKeepsTheClocksPaceAndItsRecordingReplays) {
  const auto file = fresh_path("live.h5");
  const auto begun = std::chrono::steady_clock::now();
  const Outcome outcome = palpate("record " + phantom().string() + forehead + "--seconds 2 --live -o " + file.string());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  ASSERT_EQ(outcome.exit, 0) << outcome.output;
  EXPECT_GT(seconds, 2.0);
  EXPECT_THAT(outcome.output, ::testing::AllOf(HasSubstr("missed"), HasSubstr("mm deep"), HasSubstr("us")));
  const Recording recording = read_recording(file);
  EXPECT_NEAR(recording.ticks.back().time_s, 2.0, 0.3);
  EXPECT_EQ(palpate("replay " + file.string() + " " + phantom().string()).exit, 0);
  EXPECT_EQ(palpate("record " + phantom().string() + forehead + "--seconds 1 -o " + file.string()).exit, 1)
      << "nothing is overwritten";
}

/// In a recording that is still being written; none where it is not there yet, or is read in the middle of a flush.
std::size_t flushed_ticks(const std::string& partial) {
  try {
    return read_recording(partial).ticks.size();
  } catch (const std::exception&) {
    return 0;
  }
}

TEST(CommandSession, InterruptedItEndsInGoodOrderAndKilledItLeavesAReadableFile) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGKILL}) {
    const auto file = fresh_path("signal.h5");
    const std::string folder = phantom().string();
    const pid_t child = fork();
    if (child == 0) {
      execl(PALPATE_PROGRAM, PALPATE_PROGRAM, "record", folder.c_str(), "--from", "0,-29,0", "--to", "0,0,0", "-o",
            file.c_str(), nullptr);
      _exit(127);
    }
    const std::string partial = file.string() + ".partial";
    while (flushed_ticks(partial) <= 800) usleep(25000);
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    if (signal != SIGKILL) {
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
      EXPECT_TRUE(read_recording(file).complete);
      EXPECT_EQ(read_recording(file).scenes.size(), 1U);
    } else {
      const Recording left = read_recording(partial);
      EXPECT_FALSE(left.complete);
      EXPECT_GT(left.ticks.size(), 800U);
      const Outcome again = palpate("replay " + partial + " " + folder);
      EXPECT_EQ(again.exit, 0);
      EXPECT_THAT(again.output, HasSubstr(" was not closed in good order; " + std::to_string(left.ticks.size()) +
                                          " ticks of it can be read"));
    }
  }
}

/// A stylus that tells only once it is open that it is weak.
class WeakOnceOpen : public device::Stylus {
 public:
  device::Specification specification() const override {
    device::Specification can = device::SimulatedStylus().specification();
    can.maximum_force = is_open ? 0.5 : 3;
    return can;
  }
  void open() override { is_open = true; }
  void close() noexcept override { is_open = false; }
  device::Reading read() noexcept override { return {}; }
  void write_force(const device::Vec3& /*force*/) noexcept override {}
  device::State state() const noexcept override { return device::State::disconnected; }
  bool is_open = false;
};

/// What a real stylus can do is asked of it when it is open; the simulated one is opened by the session alone.
TEST(CommandSession, AStylusIsAskedWhatItCanDoWhenItIsOpen) {
  SessionOption option;
  option.series.path = phantom().string();
  option.scene = "ct-skin-and-bone";
  const auto real = std::make_shared<WeakOnceOpen>();
  ::testing::internal::CaptureStderr();
  const ReadySession ready = prepare_session(option, real);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("reduced to 0.5 N"));
  EXPECT_TRUE(real->is_open);
  EXPECT_FALSE(ready.simulated);
  const auto simulated = std::make_shared<device::SimulatedStylus>();
  EXPECT_TRUE(prepare_session(option, simulated).simulated);
  EXPECT_EQ(simulated->state(), device::State::disconnected);
  std::signal(SIGPIPE, SIG_DFL);  // prepare_session() ignores it
}

TEST(CommandSession, ADeviceThatIsNotThereIsNamed) {
  const Outcome outcome = palpate("record " + phantom().string() + forehead + "--device falcon --seconds 1 -o " +
                                  fresh_path("falcon.h5").string());
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.output, HasSubstr("alcon"));
}

}  // namespace
}  // namespace palpate::plugin
