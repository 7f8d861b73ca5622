/// Every number and word that a command prints, against an independent calculation: on a grid that is oblique, tilted,
/// uneven and not square, and with options other than the defaults.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "modes/scene/scene_json.h"
#include "modes/scene/suggest.h"
#include "plugin/app/open_scan.h"
#include "plugin/app/run_session.h"
#include "plugin/options/series_option.h"
#include "plugin/recording/recorded_session.h"
#include "plugin/recording/recording.h"
#include "plugin/report/summary.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/testing/command_rig.h"
#include "plugin/testing/expect_near.h"
#include "plugin/testing/odd_scan.h"
#include "solver/analytical.h"
#include "solver/descent.h"
#include "solver/exact.h"
#include "solver/solution.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::array_of;
using testing::ball_scan;
using testing::expect_near;
using testing::fresh_path;
using ::testing::HasSubstr;
using testing::odd_center;
using testing::odd_from;
using testing::odd_grid;
using testing::odd_inward;
using testing::odd_scene;
using testing::odd_to;
using testing::Outcome;
using testing::palpate;
using testing::typed;
using testing::write_odd;

const glm::dvec3 odd_rise(11, -17, 23);  // HU per mm
double odd_value(const glm::dvec3& place_mm) {
  return 200 + glm::dot(odd_rise, place_mm - odd_center);
}

/// A scan whose value rises evenly in one direction, so that value and gradient are known everywhere.
const fs::path& ramp_scan() {
  static const fs::path folder = [] {
    io::Volume volume = testdata::scan(testdata::make_sphere(1), testdata::make_geometry(odd_grid()));
    auto& voxels = std::get<std::vector<std::int16_t>>(volume.voxels);
    const glm::ivec3 size = volume.geometry.dimensions;
    for (int k = 0; k < size.z; ++k) {
      for (int j = 0; j < size.y; ++j) {
        for (int i = 0; i < size.x; ++i) {
          const double value = odd_value(volume.geometry.to_patient(glm::dvec3(i, j, k)));
          voxels[volume.offset(i, j, k)] = static_cast<std::int16_t>(std::lround(value - volume.intercept));
        }
      }
    }
    return write_odd(volume, "ramp");
  }();
  return folder;
}

TEST(CommandNumbers, SampleTellsTheValueAndTheWholeGradient) {
  const io::Geometry geometry = testdata::make_geometry(odd_grid());
  std::vector<glm::dvec3> places;
  for (int n = 0; n < 12; ++n) {
    places.push_back(geometry.to_patient({9.3 + 1.7 * n, 27.1 - 1.5 * n, 9.2 + (7 * n % 11)}));
  }
  places.emplace_back(0, 0, 900);
  std::string at;
  for (const glm::dvec3& place : places) at += " " + typed(place);
  const std::string arguments = "sample " + ramp_scan().string() + " --at" + at;
  const Json samples = Json::parse(palpate(arguments + " --json", false).output);
  ASSERT_EQ(samples.size(), places.size());
  std::string words;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const Json& told = samples[n];
    EXPECT_EQ(told.at("position_mm"), array_of(places[n]));
    words += fmt::format("({:.10g}, {:.10g}, {:.10g}) mm: ", places[n].x, places[n].y, places[n].z);
    if (n + 1 == places.size()) {
      EXPECT_EQ(told.at("outside"), true);
      words += "outside the scan\n";
      continue;
    }
    EXPECT_NEAR(told.at("value").get<double>(), odd_value(places[n]), 1) << n;
    expect_near(told.at("gradient_per_mm"), array_of(odd_rise), 0.3, "gradient_per_mm");
    const std::vector<double> gradient = told.at("gradient_per_mm");
    words += fmt::format("{:.10g} HU, gradient ({:.6g}, {:.6g}, {:.6g}) per mm\n", told.at("value").get<double>(),
                         gradient[0], gradient[1], gradient[2]);
  }
  EXPECT_EQ(palpate(arguments, false).output, words);
}

/// On a step of the value the gradient of a Gaussian is the step over its width times the root of 2 pi, along the
/// step's normal; the voxels' own width adds to it.
TEST(CommandNumbers, SampleTakesTheScaleThatItIsGiven) {
  const glm::dvec3 inward(2.0 / 3, -1.0 / 3, 2.0 / 3);
  const fs::path folder =
      write_odd(testdata::scan(testdata::make_slab(inward, std::array{testdata::Layer{0, testdata::soft_tissue_hu}}),
                               testdata::make_geometry({.size = glm::ivec3(34)})),
                "step");
  for (const double scale_mm : {1.5, 3.0}) {
    const Json told = Json::parse(
        palpate(fmt::format("sample {} --at 0,0,0 --scale {} --json", folder.string(), scale_mm), false).output);
    const double width_mm = std::sqrt(scale_mm * scale_mm + 1.0 / 12);
    const double steepest =
        (testdata::soft_tissue_hu - testdata::air_hu) / (width_mm * std::sqrt(2 * std::numbers::pi));
    expect_near(told.at(0).at("gradient_per_mm"), array_of(steepest * inward), 0.04 * steepest, "gradient");
  }
}

TEST(CommandNumbers, APlanNamesWhatItRunsInTextAndJson) {
  const fs::path file = odd_scene();
  const auto volume = std::make_shared<const io::Volume>(load_series({.path = ball_scan().string(), .series = {}}));
  const modes::Scene scene = modes::load_scene(file.string());
  for (const bool with_landmark : {false, true}) {
    modes::Scene felt = scene;
    if (with_landmark) {
      felt.modes.push_back({.type = "landmark", .name = "here", .strength_n = modes::TransferFunction(0.1)});
      felt.modes.back().position_mm = odd_center;
    }
    const fs::path asked = file.parent_path() / "asked.json";
    std::ofstream(asked) << modes::to_json(felt);
    const auto plan = plan_for(felt, *volume, {0.08, 0.06, 0.06});
    const std::string command = "plan " + ball_scan().string() + " --scene " + asked.string();
    const Json told = Json::parse(palpate(command + " --json", false).output);
    std::vector<std::string> modes{"friction", "surface \"skin\"", "surface", "surface \"edge\""};
    if (with_landmark) modes.emplace_back("landmark \"here\"");
    std::vector<std::string> solvers;
    const bool exact = plan->solvers.contains(solver::exact_solver);
    const bool descent = plan->solvers.contains(solver::descent_solver);
    if (plan->solvers.contains(solver::analytical_solver)) solvers.emplace_back("analytical");
    if (exact) solvers.emplace_back("exact");
    if (descent) solvers.emplace_back("descent");
    EXPECT_EQ(told.at("modes"), Json(modes));
    EXPECT_EQ(told.at("fields"), Json(modes::names_of(plan->fields)));
    EXPECT_EQ(told.at("solvers"), Json(solvers));
    EXPECT_EQ(told.at("device"), "simulated");
    EXPECT_NE(exact, descent) << "else the one could be told for the other";
    const std::string words = palpate(command, false).output;
    std::string left_out = "\nleft out:\n";
    const auto joined = [](const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); };
    EXPECT_THAT(
        words, ::testing::StartsWith(fmt::format("fields    {}\nmodes     {}\nsolvers   {}\ndevice    simulated\n{}",
                                                 joined(told.at("fields")), joined(modes), joined(solvers), left_out)));
    ASSERT_GE(told.at("left_out").size(), plan->left_out.size());
    for (std::size_t n = 0; n < plan->left_out.size(); ++n) {
      EXPECT_EQ(told["left_out"][n]["what"], plan->left_out[n].what);
      EXPECT_EQ(told["left_out"][n]["why"], plan->left_out[n].why);
      EXPECT_THAT(words, HasSubstr("\n  " + plan->left_out[n].what + ": " + plan->left_out[n].why + "; saves "));
    }
    // In words what a thing saves is as much as in numbers.
    for (const Json& entry : told.at("left_out")) {
      const std::string saves = entry.at("saves");
      if (const double bytes = entry.value("saves_bytes", 0.0); bytes > 0) {
        const double kib = bytes / 1024;
        EXPECT_THAT(saves,
                    HasSubstr(kib < 100 ? fmt::format("{:.1f} KiB", kib) : fmt::format("{:.1f} MiB", kib / 1024)));
      }
      if (entry.value("saves_us_a_sub_step", 0.0) > 0) {
        EXPECT_THAT(saves, HasSubstr(fmt::format("{:.2f} us a sub-step", entry["saves_us_a_sub_step"].get<double>())));
      }
    }
  }
}

TEST(CommandNumbers, WhatIsSuggestedIsToldInWordsAndAsAScene) {
  const auto volume = std::make_shared<const io::Volume>(load_series({.path = ball_scan().string(), .series = {}}));
  const modes::Suggestion suggestion = modes::suggest(volume);
  ASSERT_GE(suggestion.boundaries.size(), 2U);
  const std::string command = "suggest " + ball_scan().string();
  EXPECT_EQ(palpate(command, false).output, modes::to_json(suggestion.scene) + "\n");
  const fs::path file = fresh_path("suggested.json");
  std::string words = "tissues\n";
  for (std::size_t n = 0; n < suggestion.typical.size(); ++n) {
    words += fmt::format("  {:<24} typically {:.0f} HU\n", suggestion.scene.tissues[n].name, suggestion.typical[n]);
  }
  words += "boundaries\n";
  double percent = 0;
  for (const modes::FoundBoundary& found : suggestion.boundaries) {
    words += fmt::format("  {:<36} felt at {:.0f} HU; {:.1f} % of what lies at boundaries\n",
                         suggestion.scene.modes[found.mode].name, found.middle, 100 * found.share);
    percent += 100 * found.share;
  }
  EXPECT_GT(percent, 50);
  EXPECT_LE(percent, 100 + 1e-6);
  std::string picture = file.string();
  picture.replace(picture.rfind(".json"), 5, ".png");
  words += fmt::format("\nwritten: {0} and {1}\nfeel it: palpate probe {2} --scene {0}\n", file.string(), picture,
                       ball_scan().string());
  EXPECT_EQ(palpate(command + " -o " + file.string(), false).output, words);
  EXPECT_GT(fs::file_size(picture), 1000U);
  std::ifstream written(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(written), {}), modes::to_json(suggestion.scene) + "\n");
}

/// A session with options that are not the defaults: each of them is in its recording, and the summary is that of the
/// recording.
TEST(CommandNumbers, AProbesOptionsAreInItsRecordingAndItsSummaryIsOfIt) {
  const fs::path scene = odd_scene(), out = fresh_path("odd_probe");
  const std::string command = fmt::format(
      "probe {} --scene {} --from={} --to={} --rate 2000 --seed 9 --seconds 2.5 -o {}", ball_scan().string(),
      scene.string(), typed(odd_from + 10.0 * odd_inward), typed(odd_to), out.string());
  const Outcome outcome = palpate(command + " --json", false);
  ASSERT_EQ(outcome.exit, 0);
  const Recording recording = read_recording(out / "recording.h5");
  EXPECT_EQ(recording.header.rate_hz, 2000);
  EXPECT_EQ(recording.header.seed, 9);
  EXPECT_EQ(recording.header.device, "simulated");
  ASSERT_EQ(recording.ticks.size(), 5000U);
  for (std::size_t n = 0; n < 5000; ++n) ASSERT_NEAR(recording.ticks[n].time_s, 5e-4 * static_cast<double>(n), 1e-12);
  ASSERT_EQ(recording.scenes.size(), 1U);
  ASSERT_EQ(recording.styluses.size(), 1U);
  EXPECT_EQ(recording.scenes[0].half_extent_m, glm::dvec3(0.08, 0.06, 0.06));
  EXPECT_EQ(recording.styluses[0].name, "simulated");
  EXPECT_EQ(recording.styluses[0].maximum_force_n, recording.scenes[0].maximum_force_n);
  EXPECT_EQ(recording.styluses[0].force_axes, 3);
  // The structure's file is named by what is in it: here it is called by its path again.
  modes::Scene felt = modes::scene_from_json(recording.scenes[0].scene, "test");
  for (modes::SceneStructure& one : felt.structures) one.file = (scene.parent_path() / "labels.mha").string();
  const auto volume = std::make_shared<const io::Volume>(load_series({.path = ball_scan().string(), .series = {}}));
  const PreparedScene prepared = prepare(felt, volume, recording.scenes[0].half_extent_m);
  Summary summary = summarize(recording, *prepared.plan);
  add_uncertainty(summary, felt, *prepared.source, volume->geometry);
  EXPECT_FALSE(summary.holds.empty());
  EXPECT_EQ(Json::parse(outcome.output), Json::parse(to_json(summary, felt)));
  std::ifstream file(out / "summary.txt");
  const std::string words{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(words, to_text(summary, felt, describe_scan(*volume), "simulated"));
}

std::string triple(const Json& v) {
  return fmt::format("{:.6g}, {:.6g}, {:.6g}", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
}

/// The text of `info` has the numbers of its JSON, which are the grid's.
TEST(CommandNumbers, InfosTextHasTheGridsNumbers) {
  const io::Geometry geometry = testdata::make_geometry(odd_grid());
  const Json s = Json::parse(palpate("info --json " + ball_scan().string(), false).output).at("series").at(0);
  expect_near(s.at("origin_mm"), array_of(geometry.slice_positions.front()), 1e-6, "origin_mm");
  EXPECT_EQ(s.at("uniform"), false);
  const std::string text = palpate("info " + ball_scan().string(), false).output;
  EXPECT_THAT(text, HasSubstr(fmt::format("40 x 36 x 28 voxels of 0.9 x 1.1 x {:.3g} mm", geometry.slice_spacing())));
  EXPECT_THAT(text,
              HasSubstr(fmt::format("   first voxel at {} mm; along a row {}; along a column {}; from slice to slice "
                                    "{} mm on average\n",
                                    triple(s.at("origin_mm")), triple(s.at("direction_i")), triple(s.at("direction_j")),
                                    triple(s.at("step_mm")))));
  EXPECT_THAT(text, HasSubstr(fmt::format("   values {:.6g} to {:.6g}, mean {:.6g} HU\n", s.at("minimum").get<double>(),
                                          s.at("maximum").get<double>(), s.at("mean").get<double>())));
  EXPECT_THAT(text, HasSubstr("28 files\n"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("set apart"))) << "nothing was";
}

}  // namespace
}  // namespace palpate::plugin
