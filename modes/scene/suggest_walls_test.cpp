// Walls that are thin, faint or both, with known truth: fissures, vessel walls and plates of bone. What is suggested
// has a boundary for them with a strength there, and noise alone makes none. What a stylus is held by is not tested
// here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/scene/defaults.h"
#include "modes/scene/faint_walls.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene_json.h"
#include "modes/scene/suggest.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

using testdata::air_hu;
using testdata::bone_hu;
using testdata::HalfSpace;
using testdata::soft_tissue_hu;

const Vec3 outward = glm::normalize(Vec3(0.2, 0.1, 1));

/// Air, 7 mm of one tissue, another; a plate whose far side goes through the origin; and a third below.
testdata::Phantom with_plate(double first, double within, double plate, double width_mm, double last) {
  return {.background = air_hu,
          .bodies = {{HalfSpace{{0, 0, 1}, 26}, first},
                     {HalfSpace{{0, 0, 1}, 19}, within},
                     {HalfSpace{outward, width_mm}, plate},
                     {HalfSpace{outward, 0}, within},
                     {HalfSpace{{0, 0, 1}, -22}, last}}};
}

std::shared_ptr<const io::Volume> scanned(const testdata::Phantom& phantom, double noise) {
  return std::make_shared<const io::Volume>(
      testdata::scan(phantom, testdata::make_geometry(testdata::Grid{}), {.noise = noise}));
}

io::VolumeFields fields_of(const std::shared_ptr<const io::Volume>& volume) {
  return {volume, io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::low_high,
          io::default_gradient_scale_mm(volume->geometry)};
}

/// The boundary of a plate; it may have been found between tissues or within one.
std::optional<FoundBoundary> boundary_of(const Suggestion& found, double within, double plate) {
  for (const FoundBoundary& boundary : found.boundaries) {
    const double low = found.typical[boundary.low], high = found.typical[boundary.high];
    if (std::abs(low - within) < 25 && high > low && high < plate + 25) return boundary;
  }
  return std::nullopt;
}

struct Shown {
  double place_mm = -100;  ///< along `outward`: the outermost with half of the strength
  double strength_n = 0;   ///< the most on the near side of the plate, of all these modes together
};

/// What boundaries take on the way in, as a profile shows it: where the gradient points along the way.
Shown shown_along(const Suggestion& found, const std::vector<std::size_t>& modes, const io::FieldSource& source,
                  const Vec3& on_plate) {
  const Plan plan = make_plan(found.scene, source.available(), {});
  std::vector<std::pair<double, double>> profile;
  Shown shown;
  for (double height = 6; height > -3; height -= 0.02) {
    const io::Sample sample = source.sample(on_plate + height * outward, plan.fields);
    if (glm::dot(sample.gradient, outward) > 0) continue;
    double newtons = 0;
    for (const ActiveMode& active : plan.modes) {
      if (std::ranges::find(modes, active.scene_index) != modes.end()) newtons += active.strength(sample);
    }
    profile.emplace_back(height, newtons);
    shown.strength_n = std::max(shown.strength_n, newtons);
  }
  for (const auto& [height, newtons] : profile) {
    if (newtons >= 0.5 * shown.strength_n) shown.place_mm = std::max(shown.place_mm, height);
  }
  return shown;
}

/// Places on the plate's far side, none of them at a voxel.
std::vector<Vec3> places() {
  std::vector<Vec3> places;
  for (const Vec3& aside : {Vec3(0.3, 0.4, 0), Vec3(7, 3, -1.7), Vec3(-9, 5, 1.3), Vec3(4, -11, 0.3)}) {
    places.push_back(aside - glm::dot(aside, outward) * outward);
  }
  return places;
}

struct Wall {
  double within, plate, width_mm, noise;
};

TEST(SuggestWalls, a_fissure_and_the_walls_of_vessels_are_boundaries_where_they_are) {
  std::vector<Wall> walls{{-850, -700, 1, 0}, {-850, -700, 1, 20}, {-850, -700, 2, 20}, {-850, -750, 1.5, 10},
                          {-100, 40, 1, 0},   {-100, 40, 1, 20},   {-100, 40, 2, 30},   {40, 90, 2, 10},
                          {40, 140, 1, 10},   {40, 140, 4, 20}};
  walls.resize(static_cast<std::size_t>(repeats(10, 2)));
  for (const Wall& wall : walls) {
    SCOPED_TRACE(::testing::Message() << wall.within << " to " << wall.plate << " HU, " << wall.width_mm
                                      << " mm, noise " << wall.noise);
    const bool is_lung = wall.within < -200;
    const auto volume = scanned(with_plate(is_lung ? soft_tissue_hu : wall.within, wall.within, wall.plate,
                                           wall.width_mm, is_lung ? soft_tissue_hu : bone_hu),
                                wall.noise);
    const Suggestion found = suggest(volume);
    EXPECT_EQ(scene_from_json(to_json(found.scene), "suggested").tissues.size(), found.typical.size());
    const auto boundary = boundary_of(found, wall.within, wall.plate);
    EXPECT_TRUE(boundary);
    if (!boundary) continue;
    EXPECT_FALSE(found.scene.modes[boundary->mode].name.starts_with("Bone"));
    for (const Mode& mode : found.scene.modes) {  // no strength sets in at once, however high the noise
      const auto nodes = mode.strength_n.nodes();
      if (mode.type != "surface") continue;
      EXPECT_GE(nodes[1].at, 1.4 * nodes[0].at) << mode.name;
    }
    const io::VolumeFields source = fields_of(volume);
    for (const Vec3& place : places()) {
      const Shown shown = shown_along(found, {boundary->mode}, source, place);
      // Noise moves it by a part of a voxel on a slope so faint.
      EXPECT_NEAR(shown.place_mm, wall.width_mm, 0.75);
      EXPECT_GT(shown.strength_n, 0.3 * defaults::skin_strength_n);
    }
  }
}

/// The law: a plate of bone of a voxel or more has its strength, less what the gradient loses from the value's steepest
/// place to its middle; one of 0.75 of a voxel still has what skin has. In one of half a voxel partial volume leaves
/// 0.3 of the way to bone, which is where bone begins: it may have none.
TEST(SuggestWalls, a_thin_plate_of_bone_has_its_strength_where_its_value_reaches_bone) {
  for (const double width : {0.75, 1.0, 1.5, 2.0}) {
    for (const double noise : {0.0, 20.0}) {
      if (is_sanitized && (width != 0.75 || noise == 0)) continue;
      SCOPED_TRACE(::testing::Message() << width << " mm, noise " << noise);
      const auto volume = scanned(with_plate(soft_tissue_hu, soft_tissue_hu, bone_hu, width, bone_hu), noise);
      const Suggestion found = suggest(volume);
      std::vector<std::size_t> to_bone;
      for (const FoundBoundary& b : found.boundaries) {
        if (found.typical[b.low] > -100 && found.typical[b.high] > 200) to_bone.push_back(b.mode);
      }
      const io::VolumeFields source = fields_of(volume);
      for (const Vec3& place : places()) {
        const Shown shown = shown_along(found, to_bone, source, place);
        EXPECT_GE(shown.strength_n, width < 1 ? 0.99 * defaults::skin_strength_n : 0.8 * defaults::bone_strength_n);
        EXPECT_NEAR(shown.place_mm, width, 0.8);
      }
    }
  }
}

TEST(SuggestWalls, the_sides_of_one_are_together_the_tissue_that_it_is_within) {
  // Soft tissue is the darkest here, and has no lower end.
  testdata::Phantom phantom = with_plate(40, 40, 80, 2, bone_hu);
  phantom.background = 40;
  const Suggestion found = suggest(scanned(phantom, 2));
  const auto wall = std::ranges::find_if(found.boundaries, [](const FoundBoundary& b) { return !b.within.empty(); });
  ASSERT_NE(wall, found.boundaries.end());
  const std::vector<Tissue>& tissues = found.scene.tissues;
  EXPECT_EQ(wall->within, tissues[0].name);
  EXPECT_TRUE(std::isinf(tissues[wall->low].low));
  EXPECT_LT(tissues[wall->low].low, 0);
  EXPECT_EQ(tissues[wall->low].high, tissues[wall->high].low);
  EXPECT_EQ(tissues[wall->high].high, tissues[0].high);
}

/// The gradient of the faintest plate that is looked for, half a scale thick: the difference of two Gaussians.
TEST(SuggestWalls, the_edges_of_a_plate_half_a_scale_thick_are_steep_enough) {
  const auto volume = scanned(with_plate(soft_tissue_hu, soft_tissue_hu, bone_hu, 4, bone_hu), 0);
  for (const double scale_mm : {1.5, 2.5}) {
    const internal::ScanNoise noise(*volume, io::GradientKernel(volume, scale_mm), 1);
    const double step = 3.5 * 0.005 * (noise.spread().high - noise.spread().low);
    double steepest = 0;
    for (double at = -4; at < 4; at += 0.001) {
      const auto edge = [&](double place) { return std::exp(-0.5 * place * place) / std::sqrt(2 * M_PI) / scale_mm; };
      steepest = std::max(steepest, step * (edge(at) - edge(at - 0.5)));
    }
    EXPECT_NEAR(internal::least_gradient_of_walls(noise, scale_mm), steepest, 0.03 * steepest);
  }
}

/// Noise as a reconstruction smears it: each voxel's is the mean of nine in its slice.
io::Volume with_smeared_noise(io::Volume volume, double noise) {
  const glm::ivec3 size = volume.geometry.dimensions;
  std::mt19937_64 random(7);
  std::normal_distribution<double> grain(0, noise * 3);  // the mean of nine has a third of it
  std::vector<float> values;
  for (int k = 0; k < size.z; ++k) {
    std::vector<double> grains(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    std::ranges::generate(grains, [&] { return grain(random); });
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        double sum = 0;
        for (int n = 0; n < 9; ++n) {
          const int column = (i + n % 3) % size.x, row = (j + n / 3) % size.y;
          sum += grains[static_cast<std::size_t>(row) * static_cast<std::size_t>(size.x) +
                        static_cast<std::size_t>(column)];
        }
        values.push_back(static_cast<float>(volume.value_at(i, j, k) + sum / 9));
      }
    }
  }
  volume.voxels = std::move(values);
  volume.slope = 1;
  volume.intercept = 0;
  return volume;
}

TEST(SuggestWalls, noise_alone_makes_none) {
  testdata::Phantom even{.background = soft_tissue_hu, .bodies = {}};
  for (const double noise : {10.0, 40.0}) {
    for (const bool smeared : {false, true}) {
      if (is_sanitized && (noise < 20 || !smeared)) continue;
      SCOPED_TRACE(::testing::Message() << "noise " << noise << (smeared ? ", smeared" : ""));
      const auto noisy = [&](const testdata::Phantom& phantom) {
        return suggest(smeared ? std::make_shared<const io::Volume>(with_smeared_noise(*scanned(phantom, 0), noise))
                               : scanned(phantom, noise));
      };
      EXPECT_TRUE(noisy(even).boundaries.empty());
      const Suggestion ball = noisy(testdata::make_sphere(24));
      EXPECT_EQ(ball.boundaries.size(), 1U) << "skin alone";
      const Suggestion lung = noisy({.background = air_hu,
                                     .bodies = {{HalfSpace{{0, 0, 1}, 26}, soft_tissue_hu},
                                                {HalfSpace{{0, 0, 1}, 19}, -850},
                                                {HalfSpace{{0, 0, 1}, -22}, soft_tissue_hu}}});
      EXPECT_TRUE(std::ranges::all_of(lung.boundaries, [](const FoundBoundary& b) { return b.within.empty(); }));
    }
  }
}

}  // namespace
}  // namespace palpate::modes
