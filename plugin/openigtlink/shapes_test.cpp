// The shapes of a scene for clients: surfaces of values against mathematics, boundaries where they are felt, valid
// names.

#include "plugin/openigtlink/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "io/errors.h"
#include "modes/scene/met_values.h"
#include "modes/scene/scene_json.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/isosurface.h"
#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/surface.h"
#include "plugin/openigtlink/testing/shared_session.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"

namespace palpate::plugin::igtl {
namespace {

using testing::SharedSession;
using testing::TestClient;

/// A seeded grid: oblique, with spacings of its own; tilted or with uneven slices.
testdata::Grid seeded_grid(std::mt19937& seeded, int n) {
  std::uniform_real_distribution<double> spacing(0.6, 2.5), angle(-60, 60), axis(-1, 1), center(-200, 200);
  testdata::Grid grid{.size = {31, 26, 22},
                      .spacing = {spacing(seeded), spacing(seeded), spacing(seeded)},
                      .center = {center(seeded), center(seeded), center(seeded)}};
  grid =
      testdata::rotated(grid, glm::normalize(glm::dvec3(axis(seeded), axis(seeded), axis(seeded) + 2)), angle(seeded));
  if (n % 3 == 1) grid.tilt_degrees = 17;
  if (n % 3 == 2) grid.uneven_mm = 0.2 * grid.spacing.z;
  return grid;
}

/// The value of each voxel, from its place.
template <typename Value>
io::Volume volume_of(const io::Geometry& geometry, const Value& value) {
  io::Volume volume;
  volume.geometry = geometry;
  std::vector<float> voxels;
  const glm::ivec3& size = geometry.dimensions;
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) voxels.push_back(static_cast<float>(value(geometry.to_patient({i, j, k}))));
    }
  }
  volume.voxels = std::move(voxels);
  return volume;
}

glm::dvec3 middle_of(const io::Geometry& geometry) {
  return geometry.to_patient(0.5 * glm::dvec3(geometry.dimensions - 1));
}

// Values that rise evenly are interpolated without an error, so that the surface is the plane itself.
TEST(ValueSurface, OfEvenlyRisingValuesIsThePlaneAndTurnedTowardsLowerValues) {
  std::mt19937 seeded(21);
  std::uniform_real_distribution<double> axis(-1, 1), offset(-5, 5);
  for (int n = 0; n < 30; ++n) {
    const io::Geometry geometry = testdata::make_geometry(seeded_grid(seeded, n));
    const glm::dvec3 rise = 10.0 * glm::normalize(glm::dvec3(axis(seeded), axis(seeded), axis(seeded)));
    const glm::dvec3 middle = middle_of(geometry);
    const double value = offset(seeded);
    const Surface surface =
        isosurface(volume_of(geometry, [&](const glm::dvec3& at) { return glm::dot(rise, at - middle); }), value);
    ASSERT_GT(surface.triangles.size(), 50U) << n;
    for (const glm::dvec3& point : surface.points) EXPECT_NEAR(glm::dot(rise, point - middle), value, 1e-3) << n;
    for (const auto& [a, b, c] : surface.triangles) {
      const glm::dvec3 normal =
          glm::cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a]);
      EXPECT_LE(glm::dot(normal, rise), 1e-6) << n;
    }
  }
}

// A ball's surface is closed: each edge is in two triangles, once in each direction.
TEST(ValueSurface, OfABallIsClosedAndOnItEvenWhereVoxelsAreLeftOut) {
  const io::Geometry geometry = testdata::make_geometry({.size = glm::ivec3(150)});
  for (const double radius : {6.0, 20.0, 70.0}) {  // the last takes more cells than a surface may have
    const Surface surface =
        isosurface(volume_of(geometry, [&](const glm::dvec3& at) { return radius - glm::length(at); }), 0);
    EXPECT_LT(surface.points.size(), 60'001U);
    for (const glm::dvec3& point : surface.points) EXPECT_NEAR(glm::length(point), radius, 0.15);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& triangle : surface.triangles) {
      for (std::size_t n = 0; n < 3; ++n) ++edges[{triangle[n], triangle[(n + 1) % 3]}];
    }
    ASSERT_GT(edges.size(), 100U);
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
  }
}

TEST(ValueSurface, HasNoneBesidePaddingAndWhereSlicesAreMissing) {
  testdata::Grid grid{.size = glm::ivec3(40)};
  grid.missing = {19, 20, 21};
  io::Volume volume = testdata::scan(testdata::make_sphere(15), testdata::make_geometry(grid), {.circle_radius = 18});
  ASSERT_FALSE(volume.geometry.gaps.empty());
  const double low = volume.geometry.slice_positions[static_cast<std::size_t>(volume.geometry.gaps.front())].z;
  const double high = volume.geometry.slice_positions[static_cast<std::size_t>(volume.geometry.gaps.front()) + 1].z;
  const Surface surface = isosurface(volume, -500);
  ASSERT_GT(surface.triangles.size(), 100U);
  for (const glm::dvec3& point : surface.points) {
    EXPECT_NEAR(glm::length(point), 15, 1) << "the edge of the circle is none";
    EXPECT_TRUE(point.z <= low || point.z >= high) << point.z;
  }
}

const Shape* find(const std::vector<Shape>& shapes, const std::string& type, const std::string& name) {
  for (const Shape& shape : shapes) {
    if (shape.type == type && shape.name == name) return &shape;
  }
  return nullptr;
}

TEST(Shapes, ABoundaryOfTheScanIsSentWhereItIsFelt) {
  const modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  const auto volume = testing::ball_of_tissue();
  const std::vector<Shape> shapes = shapes_of(prepare(scene, volume, glm::dvec3(0.08)), scene);
  ASSERT_EQ(shapes.size(), 1U) << "a ball of tissue has no bone";
  EXPECT_EQ(shapes[0].type, "POLYDATA");
  const Surface skin = surface_of(shapes[0].content);
  ASSERT_GT(skin.points.size(), 1000U);
  for (const auto& corners : skin.triangles) {
    for (const std::uint32_t n : corners) EXPECT_NEAR(glm::length(skin.points[n]), 25, 0.5);
  }
}

// Values that rise evenly to the patient's left, beside the origin: each boundary is the plane where its value is met.
TEST(Shapes, ABoundaryLiesWhereItsValueIsMetInRasAxes) {
  const modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  const glm::dvec3 center(7, -8, 3);
  constexpr double hu_per_mm = 100;
  io::Volume rising = volume_of(testdata::make_geometry({.size = {31, 26, 22}, .spacing = {1, 1, 1}, .center = center}),
                                [&](const glm::dvec3& at) { return hu_per_mm * (at.x - center.x); });
  rising.modality = "CT";
  rising.unit = "HU";
  const auto volume = std::make_shared<const io::Volume>(std::move(rising));
  const PreparedScene felt = prepare(scene, volume, glm::dvec3(0.08));
  const std::vector<Shape> shapes = shapes_of(felt, scene);
  const Shape* const shape = find(shapes, "POLYDATA", scene.modes[0].name);
  ASSERT_NE(shape, nullptr);
  const std::vector<double> met = modes::met_values(scene.modes[0], modes::Side::entering);
  ASSERT_FALSE(met.empty());
  const Surface surface = surface_of(shape->content);
  glm::dvec3 mean(0);
  for (const glm::dvec3& point : surface.points) {
    double nearest = 1e9;
    for (const double value : met) nearest = std::min(nearest, std::abs(-point.x - center.x - value / hu_per_mm));
    EXPECT_LT(nearest, 0.01);
    mean += point / static_cast<double>(surface.points.size());
  }
  EXPECT_NEAR(mean.y, -center.y, 1);
  EXPECT_NEAR(mean.z, center.z, 1);
}

TEST(Shapes, NamesAreCutAtALetterAndToldApart) {
  const std::string hollow = "Oberfl\xC3\xA4\x63he der H\xC3\xB6\xC3\xB6\x68le ";
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  scene.modes.assign(3, modes::Mode(scene.modes.front()));
  for (std::size_t n = 0; n < 3; ++n) scene.modes[n].name = hollow + std::to_string(n);
  const std::vector<Shape> shapes = shapes_of(prepare(scene, testing::ball_of_tissue(), glm::dvec3(0.08)), scene);
  ASSERT_EQ(shapes.size(), 3U);
  EXPECT_TRUE(find(shapes, "POLYDATA", hollow.substr(0, 19))) << "its twentieth byte begins a letter of two";
  EXPECT_TRUE(find(shapes, "POLYDATA", hollow.substr(0, 17) + " 2"));
  EXPECT_TRUE(find(shapes, "POLYDATA", hollow.substr(0, 17) + " 3"));
}

/// A structure is asked at each place that is looked at, a boundary of the scan a few times.
TEST(Shapes, AreNotMadeForNobody) {
  const auto asked_before_it_ends = [](const modes::Scene& scene, int most) {
    int asked = 0;
    EXPECT_THROW(shapes_of(prepare(scene, testing::ball_of_tissue(), glm::dvec3(0.08)), scene,
                           [&](double) { return ++asked < most; }),
                 io::Cancelled);
    return asked;
  };
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  EXPECT_EQ(asked_before_it_ends(scene, 2), 2);
  const auto file = plugin::testing::fresh_path("ball.nrrd");
  write_nrrd(image_of(testing::ball_of_labels("", glm::dvec3(0), 10).content), file);
  scene.structures = {{.name = "ball", .file = file.string(), .segment_number = 1}};
  scene.modes = {{.type = "surface", .structure = "ball"}};
  scene.modes.back().strength_n = modes::TransferFunction(0.5);
  EXPECT_EQ(asked_before_it_ends(scene, 1000), 1000);
}

/// What a scene's change leaves as it was is not sent again.
TEST(Shapes, OnlyWhatHasChangedIsSent) {
  SharedSession shared;
  TestClient client(shared.server.port());
  client.send(testing::ball_of_labels("liver", glm::dvec3(0), 12));
  std::vector<std::string> got;
  const auto comes = [&](const std::string& name) {
    return shared.comes([&] {
      while (auto message = client.next(2)) {
        if (message->type == "POLYDATA") got.push_back(message->device);
      }
      return std::ranges::count(got, name) > 0;
    });
  };
  ASSERT_TRUE(comes("liver"));
  got.clear();
  modes::Scene scene = shared.session.scene();
  scene.modes.front().name = "renamed";
  shared.session.set_scene(scene);
  ASSERT_TRUE(comes("renamed"));
  shared.look_for(std::chrono::milliseconds(300));
  EXPECT_EQ(std::ranges::count(got, std::string("liver")), 0);
  TestClient late(shared.server.port());
  EXPECT_TRUE(late.next("POLYDATA", "liver")) << "a new client gets it";
}

std::size_t inside(const Image& image) {
  return static_cast<std::size_t>(std::count(image.voxels.begin(), image.voxels.end(), 1));
}

/// A client sends an outline, then the scene with an edit of it: the corrected outline comes back.
TEST(Shapes, ACorrectedLabelMapComesBack) {
  SharedSession shared;
  TestClient client(shared.server.port());
  client.send(testing::ball_of_labels("liver", glm::dvec3(0), 12));
  std::optional<Message> scene, labels;
  const auto comes = [&](const auto& holds) {
    return shared.comes([&] {
      while (auto message = client.next(2)) {
        if (message->device == scene_name) scene = message;
        if (message->type == "IMAGE") labels = message;
      }
      return holds();
    });
  };
  ASSERT_TRUE(
      comes([&] { return scene && string_of(scene->content).find("\"openigtlink:liver\"") != std::string::npos; }));
  shared.look_for(std::chrono::milliseconds(300));
  EXPECT_FALSE(labels) << "nothing was corrected";
  modes::Scene edited = modes::scene_from_json(string_of(scene->content), "wire");
  const glm::dvec3 added(14, 0, 0);
  edited.structures.at(0).edits = {io::AddEdit{{.path_mm = {added}, .radius_mm = 5}}};
  client.send_text(scene_name, modes::to_json(edited));
  ASSERT_TRUE(comes([&] { return labels.has_value(); }));
  EXPECT_EQ(labels->device, "liver");
  const Image image = image_of(labels->content);
  std::size_t expected = 0;
  for (int k = 0; k < image.size.z; ++k) {
    for (int j = 0; j < image.size.y; ++j) {
      for (int i = 0; i < image.size.x; ++i) {
        const glm::dvec3 at = image.first + static_cast<double>(i) * image.along[0] +
                              static_cast<double>(j) * image.along[1] + static_cast<double>(k) * image.along[2];
        if (glm::length(at) < 12 || glm::distance(at, added) < 5) ++expected;
      }
    }
  }
  EXPECT_NEAR(static_cast<double>(inside(image)), static_cast<double>(expected), 0.04 * static_cast<double>(expected));

  // Without the edit it is no correction any more: a new client gets none.
  edited.structures.at(0).edits.clear();
  client.send_text(scene_name, modes::to_json(edited));
  scene.reset();
  ASSERT_TRUE(comes([&] { return scene.has_value(); }));
  shared.look_for(std::chrono::milliseconds(1000));
  TestClient second(shared.server.port());
  bool came = false;
  shared.comes([&] {
    while (const auto message = second.next(2)) {
      EXPECT_NE(message->type, "IMAGE");
      came = came || message->type == "POLYDATA";
    }
    return came;
  });
  EXPECT_TRUE(came);
}

}  // namespace
}  // namespace palpate::plugin::igtl
