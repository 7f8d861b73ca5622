/// Every scan is described, and opens with the scene that suits it, whatever its source.

#include "plugin/app/open_scan.h"

#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <memory>
#include <string>

#include "io/bounding_box.h"
#include "io/fields/filtered.h"
#include "io/interchange/voxel_file.h"
#include "io/load.h"
#include "modes/scene/scene_json.h"
#include "modes/scene/starting_scene.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

TEST(Scan, ItsBoxHoldsTheCentersOfItsCornerVoxels) {
  testdata::Grid grid;
  grid.size = {17, 9, 13};
  grid.spacing = {0.7, 1.3, 2.1};
  grid.center = {10, -20, 30};
  grid.tilt_degrees = 12;
  const io::Geometry geometry =
      testdata::make_geometry(testdata::rotated(grid, glm::normalize(glm::dvec3(2, 1, -1)), 40));
  glm::dvec3 low(1e9), high(-1e9);
  for (int k = 0; k < 13; ++k) {
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 17; ++i) {
        const glm::dvec3 at = geometry.to_patient(glm::dvec3(i, j, k));
        low = glm::min(low, at);
        high = glm::max(high, at);
      }
    }
  }
  EXPECT_LT(glm::distance(io::bounding_box(geometry).low, low), 1e-9);
  EXPECT_LT(glm::distance(io::bounding_box(geometry).high, high), 1e-9);
}

TEST(Scan, IsDescribedByItsVoxelsAndItsFilter) {
  io::Volume volume = testdata::scan(testdata::make_sphere(5),
                                     testdata::make_geometry({.size = {12, 10, 8}, .spacing = {0.75, 0.957, 2.5}}));
  EXPECT_EQ(describe_scan(volume), "CT, 12 x 10 x 8 voxels of 0.75 x 0.957 x 2.5 mm");
  const auto filtered =
      io::filtered(std::make_shared<const io::Volume>(volume), {.type = io::find_filter_type("median")});
  EXPECT_EQ(describe_scan(*filtered),
            "CT, 12 x 10 x 8 voxels of 0.75 x 0.957 x 2.5 mm, " + io::in_words(io::filter_of(*filtered)));
}

TEST(Scan, WithoutASceneIsFeltAsItsModalitySuits) {
  io::Volume volume = testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(8)}));
  const auto felt_as = [&] { return modes::to_json(scene_for("", volume)); };
  const auto named = [](const char* name) { return modes::to_json(modes::load_scene(name)); };
  EXPECT_EQ(felt_as(), named("ct-skin-and-bone"));
  EXPECT_EQ(modes::to_json(scene_for("ct-bone", volume)), named("ct-bone"));
  volume.modality = "MR";
  EXPECT_EQ(felt_as(), named("mr-brain"));
  volume.vectors = std::make_shared<const io::VectorComponents>();
  EXPECT_EQ(felt_as(), named("flow"));
}

/// Of the same words in any of the two places that name a part of the body, the scan opens with the scene that its
/// series would: when it is loaded, filtered, and when only the word of the part has come over a wire.
TEST(OpenScan, TheStartingSceneOfAVolumeIsThatOfItsSeries) {
  for (const char* const modality : {"CT", "MR", ""}) {
    for (const char* const body_part : {"", "CHEST", "ABDOMEN", "LSPINE", "HEAD", "FOOT"}) {
      for (const char* const description : {"", "Thorax 1.0", "LWS 1.0 B60s", "Routine"}) {
        io::Series series;
        series.modality = modality;
        series.details.body_part = body_part;
        series.description = description;
        io::Volume volume = testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(8)}));
        volume.modality = modality;
        volume.body_part = body_part;
        volume.description = description;
        const auto loaded = std::make_shared<const io::Volume>(volume);
        const std::string wanted = modes::starting_scene(series);
        EXPECT_EQ(modes::starting_scene(*loaded), wanted) << modality << ", " << body_part << ", " << description;
        const auto filtered = io::filtered(loaded, {.type = io::find_filter_type("median")});
        EXPECT_EQ(modes::starting_scene(*filtered), wanted);
        io::Volume served = volume;
        served.body_part = modes::part_of_body(volume);
        served.description.clear();
        EXPECT_EQ(modes::starting_scene(served), wanted) << modality << ", " << body_part << ", " << description;
        EXPECT_EQ(modes::to_json(scene_for("", *loaded)), modes::to_json(modes::load_scene(wanted)));
      }
    }
  }
}

/// ParaView asks a list of its own for the reader of a file.
TEST(OpenScan, ParaViewListsTheEndingsOfEveryFormat) {
  std::ifstream file(PALPATE_SOURCES "/plugin/paraview/server/module/reader.xml");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::string endings;
  for (const std::string& ending : io::label_format_endings())
    endings += (endings.empty() ? "" : " ") + ending.substr(1);
  EXPECT_NE(text.find("extensions=\"" + endings + "\""), std::string::npos) << endings;
}

}  // namespace
}  // namespace palpate::plugin
