// `palpate suspects` as a script uses it, on the phantom's core.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "io/archive/testing/says.h"
#include "io/structures/label_image.h"
#include "io/testing/outlined_scan.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using io::testing::says;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;
using testing::phantom;

constexpr double bone_mm = 15;

/// The phantom's core as somebody outlined it, and what `palpate suspects` says of that.
Outcome suspects(const io::SignedDistance& mm, const std::string& name, const std::string& more) {
  const fs::path folder = testing::fresh_path("suspects");
  fs::create_directories(folder);
  const io::Series scan = io::find_series(std::array{phantom()}).series.at(0);
  const fs::path file = folder / (name + ".nii.gz");
  write_label_map(sample_labels(io::testing::full_label(), scan.geometry, mm), file, io::testing::by_test);
  return palpate("suspects " + phantom().string() + " --structure " + file.string() + " " + more, more.empty());
}

double core(const io::Vec3& at) {
  return bone_mm - glm::length(at);
}

TEST(CommandSuspects, ACapThatWasCutOffIsListedAndAnOutlineAsItIsIsNot) {
  const auto cut = [](const io::Vec3& at) { return std::min(core(at), 10.5 - at.x); };
  const Json json = Json::parse(suspects(cut, "cut", "--json").output);
  std::set<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.insert(key);
  EXPECT_EQ(keys, (std::set<std::string>{"places", "sampled", "without_edge"}));
  EXPECT_GT(json["sampled"].get<int>(), 300);
  ASSERT_EQ(json["places"].size(), 1U) << json;
  const Json& place = json["places"][0];
  keys.clear();
  for (const auto& [key, value] : place.items()) keys.insert(key);
  EXPECT_EQ(keys, (std::set<std::string>{"position_mm", "normal", "area_mm2", "mean_mm", "largest_mm", "known_to_mm",
                                         "kind"}));
  EXPECT_EQ(place["kind"], "edge");
  EXPECT_NEAR(place["position_mm"][0].get<double>(), 10.5, 0.7);
  EXPECT_GT(place["normal"][0].get<double>(), 0.95);
  EXPECT_NEAR(place["largest_mm"].get<double>(), bone_mm - 10.5, 0.7);
  EXPECT_GT(place["mean_mm"].get<double>(), 1);
  EXPECT_GT(place["area_mm2"].get<double>(), 100);
  const Json whole = Json::parse(suspects(core, "whole", "--json").output);
  EXPECT_EQ(whole["places"].size(), 0U) << whole;
  const Outcome words = suspects(cut, "cut", "");
  EXPECT_EQ(words.exit, 0);
  EXPECT_THAT(words.output, HasSubstr(": 1 doubtful place; "));
  EXPECT_THAT(words.output, ::testing::ContainsRegex("edge: the scan's edge lies [1-4][.][0-9] mm outside in the mean, "
                                                     "(4[.][5-9]|5[.]0) at most, [+]- 0[.]"));
  // The numbers end below their headings.
  std::istringstream lines(words.output.substr(words.output.find(": 1 doubtful place; ")));
  std::string told, heading, row;
  std::getline(lines, told);
  std::getline(lines, heading);
  std::getline(lines, row);
  const std::size_t area_ends = row.find("  edge: ");
  ASSERT_NE(area_ends, std::string::npos) << row;
  EXPECT_EQ(heading.size(), area_ends) << heading;
  EXPECT_TRUE(heading.ends_with("cm2")) << heading;
  const std::size_t place_ends = row.find_last_not_of(' ', row.find_last_of(' ', area_ends - 1)) + 1;
  EXPECT_EQ(heading.find(" mm)") + 4, place_ends) << heading << "\n" << row;
}

TEST(CommandSuspects, AHoleAndAnIslandAreListed) {
  const auto spoilt = [](const io::Vec3& at) {
    const double island = 3 - glm::distance(at, io::Vec3(0, 22, 0)), hole = glm::length(at) - 4;
    return std::max(std::min(core(at), hole), island);
  };
  const Outcome outcome = suspects(spoilt, "parts", "");
  EXPECT_THAT(outcome.output, ::testing::ContainsRegex("hole: a small hole, [34][.][0-9] mm deep"));
  EXPECT_THAT(outcome.output, ::testing::ContainsRegex("island: a small separate part, [23][.][0-9] mm deep"));
}

TEST(CommandSuspects, IsRefusedInWords) {
  EXPECT_EQ(palpate("suspects " + phantom().string()).exit, 2) << "without a structure";
  const Outcome none = palpate("suspects " + phantom().string() + " --structure /no/such.nii.gz");
  EXPECT_EQ(none.exit, 1);
  EXPECT_TRUE(says(none.output, "no such file or folder: /no/such.nii.gz; check its name"));
  const Outcome other = palpate("suspects " + phantom().string() + " --structure " + phantom().string());
  EXPECT_EQ(other.exit, 1) << "a scan is no structure";
  EXPECT_TRUE(says(other.output, "{} holds no structures{}"));
}

}  // namespace
}  // namespace palpate::plugin
