/// Every number and word that `palpate profile` prints, against an independently computed stroke.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/app/run_session.h"
#include "plugin/options/series_option.h"
#include "plugin/report/stroke_picture.h"
#include "plugin/report/structure_crossings.h"
#include "plugin/report/summary.h"
#include "plugin/session/stroke.h"
#include "plugin/testing/command_rig.h"
#include "plugin/testing/odd_scan.h"
#include "solver/solution.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::array_of;
using testing::ball_scan;
using testing::fresh_path;
using ::testing::HasSubstr;
using testing::number_or_null;
using testing::odd_center;
using testing::odd_from;
using testing::odd_inward;
using testing::odd_scene;
using testing::odd_to;
using testing::palpate;
using testing::phantom;
using testing::typed;

constexpr double odd_speed = 37;

/// A profile as the program makes it, made here.
struct OddProfile {
  std::shared_ptr<const io::Volume> volume;
  PreparedScene felt;
  Profile profile;
  std::vector<StructureCrossing> crossings;
};

OddProfile odd_profile(const fs::path& scene) {
  OddProfile odd;
  odd.volume = std::make_shared<const io::Volume>(load_series({.path = ball_scan().string(), .series = {}}));
  odd.profile.scene = modes::load_scene(scene.string());
  odd.felt = prepare(odd.profile.scene, odd.volume, glm::dvec3(0.1));
  odd.profile.plan = odd.felt.plan;
  odd.profile.stroke = run_stroke(*odd.felt.plan, *odd.felt.source, odd_from, odd_to, odd_speed);
  odd.profile.met = met_along(odd.profile, odd.felt);
  odd.crossings = crossings_along(odd_from, odd_to, odd.felt);
  return odd;
}

std::string profile_command(const fs::path& scene) {
  return fmt::format("profile {} --scene {} --speed {} --from={} --to={}", ball_scan().string(), scene.string(),
                     odd_speed, typed(odd_from), typed(odd_to));
}

void expect_points(const Json& told, const OddProfile& odd) {
  const auto& stroke = odd.profile.stroke;
  const double ticks = std::ceil(glm::distance(odd_from, odd_to) / odd_speed * 1000);
  ASSERT_EQ(stroke.size(), static_cast<std::size_t>(ticks) + 1) << "one a millisecond";
  for (const char* const key : {"position_mm", "proxy_mm", "force_n", "value", "solver", "error_bound_m", "boundary"}) {
    ASSERT_EQ(told.at(key).size(), stroke.size()) << key;
  }
  EXPECT_EQ(told.at("distance_mm").size(), 1U) << "of the structure that is read";
  int outside = 0, without_name = 0;
  for (std::size_t n = 0; n < stroke.size(); ++n) {
    const StrokePoint& point = stroke[n];
    EXPECT_EQ(told["position_mm"][n], array_of(point.position_mm));
    EXPECT_EQ(told["proxy_mm"][n], array_of(point.proxy_mm));
    EXPECT_EQ(told["force_n"][n], array_of(point.force_n));
    EXPECT_EQ(told["value"][n], number_or_null(point.value));
    EXPECT_EQ(told["solver"][n], solver::name_of(point.solver));
    EXPECT_EQ(told["error_bound_m"][n], number_or_null(point.error_bound_m));
    EXPECT_EQ(told["distance_mm"]["pit"][n], point.distance_mm[0]);
    const std::array<Json, 4> names{"friction", "skin", "surface", "edge"};
    EXPECT_EQ(told["boundary"][n], point.boundary ? names.at(*point.boundary) : Json());
    outside += std::isfinite(point.value) ? 0 : 1;
    without_name += point.boundary == 2 ? 1 : 0;
  }
  EXPECT_GT(outside, 0);
  EXPECT_GT(without_name, 0);
}

TEST(CommandProfile, AProfilesJsonIsWhatItsKeysSay) {
  const fs::path scene = odd_scene();
  const OddProfile odd = odd_profile(scene);
  const Json told = Json::parse(palpate(profile_command(scene) + " --json", false).output);
  expect_points(told, odd);
  ASSERT_EQ(told.at("met").size(), odd.profile.met.size());
  ASSERT_GE(odd.profile.met.size(), 2U);
  for (std::size_t n = 0; n < odd.profile.met.size(); ++n) {
    const MetBoundary& met = odd.profile.met[n];
    EXPECT_EQ(told["met"][n], Json({{"boundary", display_name(odd.profile.scene, met.contact.boundary)},
                                    {"proxy_mm", array_of(odd.profile.stroke[met.contact.first].proxy_mm)},
                                    {"peak_n", met.contact.peak_n},
                                    {"strength_n", met.contact.strength_n},
                                    {"full_strength_n", met.contact.full_strength_n},
                                    {"depth_mm", met.depth_mm},
                                    {"known_to_mm", number_or_null(met.known_to_mm.value_or(NAN))},
                                    {"known_along_mm", number_or_null(met.known_along_mm.value_or(NAN))}}));
  }
  EXPECT_LT(odd.profile.met[0].contact.strength_n, odd.profile.met[0].contact.full_strength_n);
  ASSERT_EQ(told.at("crossings").size(), 1U);
  ASSERT_EQ(odd.crossings.size(), 1U);
  const StructureCrossing& crossing = odd.crossings.front();
  const io::ScanEdge edge = crossing.own_edge.value_or(io::ScanEdge{NAN, NAN, NAN});
  EXPECT_EQ(told["crossings"][0], Json({{"structure", "pit"},
                                        {"entering", true},
                                        {"position_mm", array_of(crossing.place_mm)},
                                        {"depth_mm", crossing.depth_mm},
                                        {"scan_edge_mm", number_or_null(edge.mm)},
                                        {"scan_edge_rise", number_or_null(edge.rise)},
                                        {"scan_edge_known_to_mm", number_or_null(edge.known_to_mm)},
                                        {"scan_edge_within_mm", 5}}));
  EXPECT_NEAR(crossing.depth_mm, 16, 0.5) << "the pit of 10 mm";
}

/// A line every half millimeter, then what was met and crossed; and the files that were asked for.
TEST(CommandProfile, AProfilesTextHasTheSameNumbers) {
  const fs::path scene = odd_scene(), table = fresh_path("odd.csv"), picture = fresh_path("odd.png");
  const OddProfile odd = odd_profile(scene);
  std::string words = " depth mm   force N  proxy mm     value  solver      boundary\n";
  const auto along = [](const glm::dvec3& at) { return glm::dot(at - odd_from, odd_inward); };
  int lines = 0;
  for (const StrokePoint& point : odd.profile.stroke) {
    if (along(point.position_mm) + 1e-9 < 0.5 * lines) continue;
    ++lines;
    words += fmt::format("{:9.2f} {:9.3f} {:9.2f} {:9.1f}  {:<11} {}\n", along(point.position_mm),
                         glm::length(point.force_n), along(point.proxy_mm), point.value, solver::name_of(point.solver),
                         point.boundary ? display_name(odd.profile.scene, *point.boundary) : "");
  }
  EXPECT_EQ(lines, 55) << "27 mm";
  words += "\n";
  for (const MetBoundary& met : odd.profile.met) {
    const StrokePoint& first = odd.profile.stroke[met.contact.first];
    words += fmt::format("{} met at depth {:.2f} mm ({}), value {:.0f}; up to {:.2f} N{}{}\n",
                         display_name(odd.profile.scene, met.contact.boundary), met.depth_mm,
                         patient_coordinates(first.proxy_mm), first.value, met.contact.peak_n,
                         known_to_text(met.known_to_mm),
                         strength_to_text(met.contact.strength_n, met.contact.full_strength_n));
  }
  words += in_words(odd.crossings.front(), odd.profile.scene) + "\n";
  EXPECT_EQ(palpate(profile_command(scene) + " --table " + table.string() + " -o " + picture.string(), false).output,
            words);
  EXPECT_GT(fs::file_size(picture), 1000U);
  std::ifstream rows(table);
  EXPECT_EQ(std::count(std::istreambuf_iterator<char>(rows), {}, '\n'),
            static_cast<std::ptrdiff_t>(odd.profile.stroke.size() + 1));
}

/// Without --speed a stroke takes 50 mm/s, which its help says; no speed is refused.
TEST(CommandProfile, AStrokesSpeedIsWhatItsHelpSays) {
  EXPECT_THAT(palpate("profile --help").output, ::testing::ContainsRegex("--speed FLOAT *[=[]50[] ]"));
  const std::string stroke = "profile " + phantom().string() + " --from 0,-29,0 --to 0,-26,0";
  EXPECT_EQ(Json::parse(palpate(stroke + " --json", false).output)["value"].size(), 61U);
  EXPECT_EQ(palpate(stroke + " --speed 0").exit, 2);
  EXPECT_EQ(palpate(stroke + " --speed=-5").exit, 2);
}

}  // namespace
}  // namespace palpate::plugin
