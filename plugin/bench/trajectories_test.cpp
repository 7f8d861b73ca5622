#include "plugin/bench/trajectories.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>

#include "modes/scene/scene_json.h"
#include "plugin/app/errors.h"
#include "plugin/testing/test_files.h"
#include "testdata/analytic.h"

namespace palpate::plugin {
namespace {

std::filesystem::path trajectory_of(const std::string& text) {
  static int number = 0;
  const auto file = testing::fresh_path(fmt::format("stroke{}.traj", ++number));
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

std::string refusal_of(const std::string& text, const std::string& columns = usual_columns) {
  try {
    (void)read_trajectory(trajectory_of(text), columns);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "read";
}

TEST(Trajectories, AreReadWhateverStandsBetweenTheNumbers) {
  for (const std::string between : {" ", "\t", ",", ";", ", ", "  \t "}) {
    for (const std::string end : {"\n", "\r\n"}) {
      std::string text = "# of a plane" + end + "% measured" + end + end;
      for (int n = 0; n < 3; ++n) {
        const std::array<std::string, 7> values{
            fmt::format("{}", 0.01 * n), fmt::format("{}", n - 1.5), "+2e-1", "-3", "0", "0.25", "-.5"};
        for (std::size_t v = 0; v < values.size(); ++v) text += (v == 0 ? "" : between) + values[v];
        text += n == 2 ? "" : end;  // the last line has no end
      }
      const auto samples = read_trajectory(trajectory_of(text), usual_columns);
      ASSERT_EQ(samples.size(), 3U) << text;
      for (int n = 0; n < 3; ++n) {
        const MeasuredSample& sample = samples[static_cast<std::size_t>(n)];
        EXPECT_DOUBLE_EQ(sample.time_s, 0.01 * n);
        EXPECT_EQ(sample.position_mm, glm::dvec3(n - 1.5, 0.2, -3));
        EXPECT_EQ(sample.force_n, glm::dvec3(0, 0.25, -0.5));
      }
    }
  }
}

TEST(Trajectories, ColumnsStandInAnyOrderAndMayBeLeftOut) {
  const auto file = trajectory_of("9 1 2 3 8 4 5 6\n9 1 2 3 8 4 5 6\n");
  for (const auto& [columns, position, force] :
       {std::tuple{"-,x,y,z,-,fx,fy,fz", glm::dvec3(1, 2, 3), glm::dvec3(4, 5, 6)},
        std::tuple{"-,fz,fy,fx,-,z,y,x", glm::dvec3(6, 5, 4), glm::dvec3(3, 2, 1)}}) {
    const auto samples = read_trajectory(file, columns);
    ASSERT_EQ(samples.size(), 2U);
    EXPECT_EQ(samples[1].position_mm, position) << columns;
    EXPECT_EQ(samples[1].force_n, force) << columns;
    EXPECT_EQ(samples[1].time_s, 0);
  }
  for (const char* wrong : {"", "x,y,z", "t,x,y,z,fx,fy,fz,fz", "t,t,x,y,z,fx,fy,fz", "x,y,z,fx,fy,force", "-"}) {
    EXPECT_THROW((void)read_trajectory(file, wrong), WrongUsage) << wrong;
  }
}

TEST(Trajectories, WhatIsNoStrokeIsRefusedByFileAndLine) {
  using ::testing::HasSubstr;
  const std::string good = "0 1 2 3 4 5 6\n";
  EXPECT_THAT(refusal_of(good + "0.1 1 2 3 4 5\n"), HasSubstr("line 2: 6 numbers"));
  EXPECT_THAT(refusal_of(good + "\n0.1 1 2 3 4 5 6 7\n"), HasSubstr("line 3: 8 numbers"));
  for (const std::string bad :
       {"nan", "inf", "-inf", "1e999", "0x10", "1,5e", "x", "1..2", "--1", "++1", "1e", "\xff"}) {
    // A comma parts two numbers: then there is one too many.
    EXPECT_THAT(refusal_of(good + "0.1 1 2 3 4 5 " + bad + "\n"), HasSubstr("line 2: ")) << bad;
  }
  EXPECT_THAT(refusal_of(good + std::string("0.1 1 2 3 4 5 6\0\n", 17)), HasSubstr("line 2"));
  EXPECT_THAT(refusal_of(good + good), HasSubstr("line 2: the time 0 s"));
  EXPECT_THAT(refusal_of("1 1 2 3 4 5 6\n0.5 1 2 3 4 5 6\n"), HasSubstr("line 2: the time 0.5 s"));
  for (const std::string& few : {std::string(), std::string("# nothing\n"), good}) {
    EXPECT_THAT(refusal_of(few), HasSubstr("samples; two or more")) << few;
  }
  EXPECT_THAT(refusal_of(std::string(100000, '7')), HasSubstr("line 1: 1 numbers"));
  EXPECT_THROW((void)read_trajectory("/nowhere/stroke.traj", usual_columns), InputRefused);
  EXPECT_THROW((void)read_trajectory(std::filesystem::temp_directory_path(), usual_columns), InputRefused);
}

/// A real plane, pressed and let go: a hard surface renders the measured force.
TEST(Trajectories, OfAPlaneAreRenderedAsTheyWereMeasured) {
  const glm::dvec3 outward = glm::normalize(glm::dvec3(0.2, -0.4, 0.9));
  FeltScene felt;
  felt.scene = modes::scene_from_json(R"({"version": 1, "modes": [{"type": "surface",
    "strength_n": {"of": "value", "nodes": [[-490, 0], [-470, 9]]}}]})",
                                      "plane");
  felt.on.source = std::make_shared<testdata::AnalyticSource>(
      testdata::make_slab(-outward, std::array{testdata::Layer{0, testdata::soft_tissue_hu}}), 0.5);
  felt.on.plan = std::make_shared<const modes::Plan>(
      modes::make_plan(felt.scene, felt.on.source->available(), modes::Workspace{}));
  const glm::dvec3 along = glm::normalize(glm::cross(outward, glm::dvec3(1, 0, 0)));
  const auto stroke = [&](double told_n) {
    std::vector<MeasuredSample> samples;
    for (int n = 0; n <= 4000; ++n) {
      const double press = std::max(0.0, std::sin(std::numbers::pi * n / 2000.0));  // N; then off the plane
      const double above = n <= 2000 ? 0 : 2 * std::sin(std::numbers::pi * (n - 2000) / 2000.0);
      samples.push_back({.time_s = 1e-3 * n,
                         .position_mm = 0.005 * n * along + above * outward,
                         .force_n = told_n * press * outward});
    }
    return samples;
  };
  for (const double stiffness : {0.4, 0.5, 1.0}) {
    EXPECT_LT(compare_with_measured(stroke(1), felt, stiffness).rms_n(), 0.02) << stiffness;
    EXPECT_LT(compare_with_measured(stroke(1), felt, stiffness).largest_n(), 0.06) << stiffness;
  }
  // A surface that gives way at 9 N cannot render 12 N.
  EXPECT_GT(compare_with_measured(stroke(12), felt, 0.5).largest_n(), 2.5);
}

}  // namespace
}  // namespace palpate::plugin
