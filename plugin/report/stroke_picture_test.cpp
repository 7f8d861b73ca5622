#include "plugin/report/stroke_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "modes/scene/scene_json.h"
#include "plugin/report/summary.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using namespace ::testing;
using testing::fresh_path;

/// From in front of a ball of 25 mm to its middle.
Profile through_the_skin() {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(25), testdata::make_geometry({.size = glm::ivec3(60)})));
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  scene.tissues = {{.name = "air, \"outside\"", .low = -2000, .high = -500, .softness = 50},
                   {.name = "flesh", .low = -500, .high = 3000, .softness = 50}};
  const PreparedScene felt = prepare(scene, volume, glm::dvec3(0.1));
  return {.stroke = run_stroke(*felt.plan, *felt.source, {0, -29, 0}, {0, -15, 0}, 50),
          .plan = felt.plan,
          .scene = scene,
          .unit = volume->unit};
}

TEST(StrokePicture, CrossesTheTissuesInTheirOrder) {
  const Profile profile = through_the_skin();
  const std::vector<Chart> charts = charts_of(profile);
  ASSERT_EQ(charts.size(), 3U);
  const std::vector<Band>& bands = charts[1].bands;
  ASSERT_EQ(bands.size(), 2U);
  EXPECT_EQ(bands[0].label, "air, \"outside\"");
  EXPECT_EQ(bands[1].label, "flesh");
  EXPECT_DOUBLE_EQ(bands[0].from, 0);
  EXPECT_NEAR(bands[0].to, 4, 1) << "the ball begins 4 mm along the stroke";
  EXPECT_NEAR(bands[1].to, 14, 1e-9);
}

TEST(StrokePicture, ShowsEveryForceOnceInTheColorOfWhoPushes) {
  const Profile profile = through_the_skin();
  const std::vector<Curve> curves = charts_of(profile).front().curves;
  ASSERT_GT(curves.size(), 1U);
  EXPECT_THAT(curves, Contains(Field(&Curve::label, HasSubstr("(plane)"))));
  for (std::size_t n = 0; n < profile.stroke.size(); ++n) {
    const double force = glm::length(profile.stroke[n].force_n);
    std::size_t shown = 0;
    for (const Curve& curve : curves) {
      if (std::isnan(curve.y[n])) continue;
      EXPECT_EQ(curve.y[n], force);
      ++shown;
      if (profile.stroke[n].boundary &&
          curve.label.starts_with(display_name(profile.scene, *profile.stroke[n].boundary))) {
        EXPECT_EQ(curve.color.red,
                  color_from(profile.scene.modes[*profile.stroke[n].boundary].color, colors::vermilion).red);
      }
    }
    EXPECT_GE(shown, 1U) << "point " << n;
    EXPECT_LE(shown, 2U) << "two only where one stretch ends and the next begins";
  }
}

/// A stroke along y at this distance from the middle of a ball of 25 mm meets it at a slant.
std::vector<MetBoundary> met_beside_the_middle(double x_mm, Profile& profile, double begin_mm = -29) {
  const auto volume = std::make_shared<const io::Volume>(testdata::scan(
      testdata::make_sphere(25), testdata::make_geometry({.size = glm::ivec3(60)}), {.noise = 40, .seed = 3}));
  const modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  const PreparedScene felt = prepare(scene, volume, glm::dvec3(0.1));
  profile = {.stroke = run_stroke(*felt.plan, *felt.source, {x_mm, begin_mm, 0}, {x_mm, -10, 0}, 50),
             .plan = felt.plan,
             .scene = scene,
             .unit = volume->unit};
  return met_along(profile, felt);
}

TEST(StrokePicture, HasABandAsWideAsTheBoundaryIsUncertainAlongTheStroke) {
  Profile straight, slanted;
  straight.met = met_beside_the_middle(0, straight);
  slanted.met = met_beside_the_middle(15, slanted);
  ASSERT_FALSE(straight.met.empty());
  ASSERT_FALSE(slanted.met.empty());
  for (const auto& [profile, cosine] : {std::pair{&straight, 1.0}, std::pair{&slanted, 0.8}}) {
    const MetBoundary& met = profile->met.front();
    ASSERT_TRUE(met.known_to_mm && met.known_along_mm);
    EXPECT_NEAR(*met.known_to_mm / *met.known_along_mm, cosine, 0.03);
    for (const Chart& chart : charts_of(thinned(*profile, 200))) {
      const auto band = std::ranges::find_if(chart.bands, [](const Band& one) { return one.color.alpha < 1; });
      ASSERT_NE(band, chart.bands.end()) << chart.title;
      EXPECT_DOUBLE_EQ(band->from, met.depth_mm - *met.known_along_mm);
      EXPECT_DOUBLE_EQ(band->to, met.depth_mm + *met.known_along_mm);
    }
  }
}

/// By the ball's own shape: the skin begins within the first third of a voxel of it, where its value reaches -200 HU. A
/// stroke that begins earlier has its boundaries as much deeper.
TEST(StrokePicture, ABoundaryIsAsDeepAsItsSurfaceIsAlongTheStroke) {
  for (const double x : {0.0, 8.0, 15.0}) {
    const double to_middle = std::sqrt(25 * 25 - x * x), cosine = to_middle / 25;
    std::vector<double> places;  // mm, along y
    for (const double begin : {-29.0, -27.3}) {
      Profile profile;
      const std::vector<MetBoundary> met = met_beside_the_middle(x, profile, begin);
      ASSERT_FALSE(met.empty());
      places.push_back(begin + met.front().depth_mm);
      EXPECT_GT((places.back() + to_middle) * cosine, 0.15) << x;
      EXPECT_LT((places.back() + to_middle) * cosine, 0.35) << x;
    }
    EXPECT_NEAR(places[0], places[1], 0.05) << "the probe moves by 0.05 mm in a tick";
  }
}

TEST(StrokePicture, ItsTableTellsHowWellTheHeldBoundaryIsKnown) {
  Profile profile;
  profile.met = met_beside_the_middle(0, profile);
  const auto file = fresh_path("known.csv");
  write_csv(profile, file);
  std::ifstream table(file);
  std::string line;
  std::getline(table, line);
  EXPECT_THAT(line, EndsWith(",known_to_mm"));
  const Contact& contact = profile.met.front().contact;
  for (std::size_t n = 0; std::getline(table, line); ++n) {
    const double told = std::stod(line.substr(line.rfind(',') + 1));
    if (n >= contact.first && n <= contact.last) {
      ASSERT_NEAR(told, *profile.met.front().known_to_mm, 1e-12) << n;
    } else if (n < contact.first) {
      ASSERT_TRUE(std::isnan(told)) << line;
    }
  }
}

TEST(StrokePicture, TellsWhoPushesWithWhat) {
  const Profile profile = through_the_skin();
  const std::vector<Contact> contacts = contacts_of(profile.stroke, *profile.plan, met_n);
  ASSERT_FALSE(contacts.empty());
  const std::size_t held = (contacts.front().first + contacts.front().last) / 2;
  EXPECT_EQ(profile.stroke[held].primitive, solver::PrimitiveType::plane);
  EXPECT_THAT(point_in_words(profile, held), AllOf(HasSubstr(display_name(profile.scene, contacts.front().boundary)),
                                                   HasSubstr("(plane)"), HasSubstr("HU, flesh")));
  EXPECT_THAT(point_in_words(profile, 0), AllOf(HasSubstr("0.00 N"), Not(HasSubstr(" by "))));
}

TEST(StrokePicture, ItsTableHasALineATick) {
  const Profile profile = through_the_skin();
  const auto file = fresh_path("profile.csv");
  write_csv(profile, file);
  std::ifstream table(file);
  std::string line;
  std::size_t lines = 0;
  while (std::getline(table, line)) {
    if (lines == 1) {
      EXPECT_THAT(line, AllOf(StartsWith("0,0,-29,0,"), HasSubstr("\"air, \"\"outside\"\"\"")));
    }
    ++lines;
  }
  EXPECT_EQ(lines, profile.stroke.size() + 1);
  EXPECT_THAT([&] { write_csv(profile, "/nowhere/profile.csv"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("/nowhere/profile.csv")));
}

TEST(StrokePicture, ColorsAreReadOrReplaced) {
  EXPECT_EQ(color_from("#ff8000", {}).green, 128 / 255.0);
  for (const char* const wrong : {"", "red", "#ff80", "#gggggg", "#ff80000"}) {
    EXPECT_EQ(color_from(wrong, colors::blue).blue, colors::blue.blue) << wrong;
  }
}

/// A band ends at the last point of its own tissue: what belongs to none has no band.
TEST(StrokePicture, ABandIsOfTheTissueAtEachOfItsPoints) {
  const double none = std::nan("");
  const std::vector<std::vector<double>> ways{{1, 1, none, none, none, 2, 2},
                                              {none, none, 1, 1, none, none},
                                              {1, none, none, 1, 1, none},
                                              {1, 1, 2, none, 2, 2, none, none, none},
                                              {none, none},
                                              {1, 7, 7, 7, 1, 2}};  // 7 is of no tissue
  Profile profile = through_the_skin();
  profile.unit = "";
  profile.scene.tissues = {{.name = "one", .low = 0.5, .high = 1.5, .softness = 1},
                           {.name = "two", .low = 1.5, .high = 2.5, .softness = 1}};
  const auto name_of = [](double value) { return value == 1 ? "one" : value == 2 ? "two" : ""; };
  for (const std::vector<double>& way : ways) {
    profile.stroke.clear();
    for (std::size_t n = 0; n < way.size(); ++n) {
      StrokePoint point;
      point.position_mm = {0, static_cast<double>(n), 0};
      point.value_passed = way[n];
      profile.stroke.push_back(point);
    }
    const std::vector<Band> bands = charts_of(profile)[1].bands;
    std::size_t stretches = 0;
    for (std::size_t n = 0; n < way.size(); ++n) {
      const std::string name = name_of(way[n]);
      if (!name.empty() && (n == 0 || name_of(way[n - 1]) != name)) ++stretches;
      std::string drawn;
      for (const Band& band : bands) {
        if (band.from <= static_cast<double>(n) && static_cast<double>(n) <= band.to) drawn += band.label;
      }
      EXPECT_EQ(drawn, name) << n << " of " << way.size();
    }
    EXPECT_EQ(bands.size(), stretches) << way.size();
  }
}

}  // namespace
}  // namespace palpate::plugin
