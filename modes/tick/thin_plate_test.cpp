// What a thin plate takes is what is shown of it. A plate of one voxel between two tissues, at any tilt to the voxels
// and any part of a voxel: the peak of the force on a stroke through it is the strength that is shown there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/testing/test_rig.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

using testdata::HalfSpace;

constexpr double tolerance = 0.15;  // of the strength: a hand tells a tenth

struct Plate {
  double outer, plate, inner;  ///< HU
  double noise;
};

/// As scenes are suggested: felt beyond the middle of the step, with a strength that sets in at a part of its gradient.
Mode boundary_of(const Plate& plate, double scale_mm) {
  const double step = plate.plate - plate.outer;
  const double steepest = step / (scale_mm * std::sqrt(2 * M_PI));
  Mode mode = testing::surface(TransferFunction({{0.08 * steepest, 0}, {0.2 * steepest, 1.0}}));
  const double place = 0.4;  // of the way: partial volume leaves a plate across the voxels about a half
  mode.gates = {{Datum::value, TransferFunction({{plate.outer + (place - 0.08) * step, 0},
                                                 {plate.outer + (place + 0.02) * step, 1}})}};
  return mode;
}

struct Stroke {
  Vec3 middle, inward;  ///< of the plate; across it
};

/// The most on the near side of the plate, where the gradient points along the stroke.
double shown_n(const ActiveMode& mode, const io::FieldSource& source, const Stroke& stroke) {
  double most = 0;
  for (double way = -4; way < 4; way += 0.005) {
    const io::Sample sample = source.sample(stroke.middle + way * stroke.inward, source.available());
    if (glm::dot(sample.gradient, stroke.inward) > 0) most = std::max(most, mode.strength(sample));
  }
  return most;
}

double felt_n(const Scene& scene, const io::FieldSource& source, const Stroke& stroke, double speed_mm_per_s) {
  testing::Hand hand(scene, source);
  double most = 0;
  for (double way = -8; way < 8; way += speed_mm_per_s / 1000) {
    hand.move_to(stroke.middle + way * stroke.inward);
    most = std::max(most, glm::length(hand.force()));
  }
  return most;
}

struct ScannedPlate {
  std::shared_ptr<const io::Volume> volume;
  Stroke stroke;
};

/// A plate of 1 mm in voxels of 1 mm: leaning, anywhere between the voxels, and met anywhere.
ScannedPlate scan(const Plate& plate, double tilt_degrees, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  const double tilt = tilt_degrees * M_PI / 180, turn = M_PI * any(random), middle = 0.5 * any(random);
  const Vec3 inward(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt));
  const testdata::Phantom phantom{
      .background = plate.outer,
      .bodies = {{HalfSpace{-inward, 0.5 - middle}, plate.plate}, {HalfSpace{-inward, -0.5 - middle}, plate.inner}}};
  const double x = any(random), y = any(random), z = any(random);  // in this order with every compiler
  const Vec3 aside = 3.0 * Vec3(x, y, z);
  return {std::make_shared<const io::Volume>(
              testdata::scan(phantom, testdata::make_geometry({.size = glm::ivec3(32)}), {.noise = plate.noise})),
          {.middle = aside + (middle - glm::dot(aside, inward)) * inward, .inward = inward}};
}

void expect_felt_as_shown(const Plate& plate, const ScannedPlate& scanned) {
  const double scale_mm = io::default_gradient_scale_mm(scanned.volume->geometry);
  const io::VolumeFields source(scanned.volume, io::FieldSet::value | io::FieldSet::gradient, scale_mm);
  const Scene scene = testing::scene_of({boundary_of(plate, scale_mm)}, 8);
  const testing::Hand hand(scene, source);
  const double shown = shown_n(hand.plan.modes.front(), source, scanned.stroke);
  // Smoothed, the gradient at a thin plate before something much darker points out of the plate: it is not shown
  // either.
  EXPECT_TRUE(shown > 0.1 || plate.inner < plate.outer - 100) << shown;
  for (const double speed : {1.0, 3.0, 10.0, 30.0}) {
    EXPECT_NEAR(felt_n(scene, source, scanned.stroke, speed), shown, tolerance * shown) << speed << " mm/s";
  }
}

TEST(ThinPlate, takes_what_is_shown_of_it_at_every_speed) {
  const std::vector<Plate> plates{{40, 1000, 40, 0},      {40, 1000, 40, 20},  {40, 400, 40, 0},
                                  {40, 140, 40, 0},       {-100, 40, -100, 5}, {-850, -600, -850, 0},
                                  {-1000, 700, -1000, 0}, {40, 1000, 20, 0},   {40, 1000, -100, 0}};
  std::mt19937 random(18);
  for (const Plate& plate : plates) {
    for (const double tilt : {0.0, 15.0, 30.0, 45.0}) {
      for (int place = 0; place < repeats(3, 1); ++place) {
        SCOPED_TRACE(::testing::Message() << plate.outer << ", " << plate.plate << ", " << plate.inner << " HU, noise "
                                          << plate.noise << ", " << tilt << " degrees");
        expect_felt_as_shown(plate, scan(plate, tilt, random));
      }
    }
  }
}

}  // namespace
}  // namespace palpate::modes
