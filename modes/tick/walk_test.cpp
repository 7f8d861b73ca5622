// Random walks through every shared scan with every mode on. PALPATE_WALK_TICKS in the environment says how many
// ticks in each scan, and PALPATE_WALK_SCAN in which folder, if not in all. A million ticks take a minute a scan.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/errors.h"
#include "io/fields/volume_fields.h"
#include "io/load.h"
#include "io/series.h"
#include "modes/testing/test_rig.h"
#include "solver/text/testing/not_finite.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

int ticks() {
  const char* wanted = std::getenv("PALPATE_WALK_TICKS");
  return wanted != nullptr ? std::max(1, std::atoi(wanted)) : repeats(2000, 200);
}

/// The boundary between what is darker and what is brighter than the scan's mean, and every other mode; strong enough
/// to be felt, each in the others' way.
Scene every_mode(const io::Volume& volume, const Vec3& middle_mm) {
  const io::Statistics statistics = io::statistics(volume);
  const double softness = 0.1 * (statistics.maximum - statistics.minimum) + 1e-3;
  Scene scene;
  scene.tissues = {{"dark", -infinity, statistics.mean, softness, ""},
                   {"bright", statistics.mean, infinity, softness, ""}};
  scene.modes.push_back(testing::mode_of("surface", TransferFunction(1)));
  scene.modes.back().strength_of = Datum::gradient_magnitude;
  scene.modes.back().from = "dark";
  scene.modes.back().to = "bright";
  scene.modes.push_back(testing::mode_of("surface", TransferFunction(0.4)));
  scene.modes.back().side = Side::both;
  scene.modes.back().strength_of = Datum::gradient_magnitude;
  scene.modes.push_back(testing::mode_of("friction", TransferFunction(0.1)));
  scene.modes.push_back(testing::mode_of("tube", TransferFunction(0.3)));
  for (const char* type : {"follow", "force"}) {
    scene.modes.push_back(testing::mode_of(type, TransferFunction(0.2)));
    scene.modes.back().direction_of = DirectionField::gradient;
    scene.modes.back().strength_of = Datum::gradient_magnitude;
  }
  for (const Shape shape : {Shape::point, Shape::line, Shape::plane}) {
    scene.modes.push_back(testing::mode_of("landmark", TransferFunction(0.15)));
    scene.modes.back().shape = shape;
    scene.modes.back().position_mm = middle_mm;
    scene.modes.back().direction = glm::normalize(Vec3(1, 2, 3));
  }
  return scene;
}

struct Walk {
  std::vector<Vec3> forces;
  int inside = 0;  ///< ticks whose proxy was in the scan
  int capped = 0;
  double worst_bound_m = 0;
  double largest_n = 0;
};

/// Steps of a hand that wanders, rests, and is put somewhere else now and then, also outside the scan.
Walk walk(const Scene& scene, const io::VolumeFields& source, const io::Geometry& g, int ticks) {
  testing::Hand hand(scene, source);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> part(-0.05, 1.05);
  std::normal_distribution<double> step;
  const auto anywhere = [&] {
    const double i = part(random), j = part(random), k = part(random);  // in this order with every compiler
    const Vec3 place = g.to_patient(Vec3(i, j, k) * Vec3(g.dimensions - 1));
    source.prepare(place, 3);
    return place;
  };
  const bool had_failed = ::testing::Test::HasFailure();
  Walk result;
  Vec3 probe = anywhere();
  for (int i = 0; i < ticks; ++i) {
    const double what = part(random);
    // Outside there is little to be felt: it does not stay there as long.
    if (what < (i == 0 || hand.result.sample.inside ? -0.0485 : -0.03)) {
      probe = anywhere();
    } else if (what < 0.9) {
      // 70 mm/s, and now and then ten times that.
      const double length = part(random) < 0 ? 0.4 : 0.04;
      const double x = step(random), y = step(random), z = step(random);
      probe += length * Vec3(x, y, z);
    }
    const StepResult& tick = hand.move_to(probe);
    double most = 0;
    for (const solver::Primitive& primitive : tick.primitives) {
      most += primitive.strength;
    }
    EXPECT_TRUE(tick.outcome == solver::Outcome::solved || tick.outcome == solver::Outcome::capped) << i;
    EXPECT_LT(tick.error_bound, 1e-6) << i;
    EXPECT_TRUE(std::isfinite(glm::length(tick.force_n))) << i;
    // The spring pulls no harder than all primitives together can hold, but for rounding and the certified error.
    EXPECT_LE(glm::length(tick.force_n), most + hand.plan.stiffness_n_per_m * tick.error_bound + 1e-9) << i;
    if (!tick.sample.inside) {
      EXPECT_TRUE(std::all_of(tick.mode_of.begin(), tick.mode_of.end(),
                              [&](std::uint8_t mode) { return scene.modes[mode].type == "landmark"; }))
          << "felt outside the scan, tick " << i;
    }
    result.inside += tick.sample.inside ? 1 : 0;
    result.capped += tick.capped;
    result.worst_bound_m = std::max(result.worst_bound_m, tick.error_bound);
    result.largest_n = std::max(result.largest_n, glm::length(tick.force_n));
    result.forces.push_back(tick.force_n);
    if (::testing::Test::HasFailure() && !had_failed) {
      break;
    }
  }
  return result;
}

/// With bricks that a worker fills at its own pace; some of it again; some of it with none.
void walk_through(const std::string& name, const std::shared_ptr<const io::Volume>& volume) {
  const io::Geometry& g = volume->geometry;
  const Scene scene = every_mode(*volume, g.to_patient(0.5 * Vec3(g.dimensions - 1)));
  const io::FieldSet fields =
      io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::low_high | io::FieldSet::tube;
  const double scale_mm = io::default_gradient_scale_mm(g);
  const io::FieldOptions roomy{.brick_bytes = std::size_t{400} << 20};
  const Walk first = walk(scene, io::VolumeFields(volume, fields, scale_mm, roomy), g, ticks());
  std::printf("%-28s %9zu ticks, %4.1f %% inside, force at most %.2f N, %d sub-steps capped, bound at most %.0e m\n",
              name.c_str(), first.forces.size(), 100.0 * first.inside / ticks(), first.largest_n, first.capped,
              first.worst_bound_m);
  std::fflush(stdout);
  EXPECT_GT(first.largest_n, 0.1);
  // A dozen primitives at once, as here, may exhaust the exact solver's work now and then; the bound is true then too.
  EXPECT_LE(first.capped, ticks() / 1000);
  const auto repeats = [&](int count, const io::FieldOptions& options) {
    const Walk again = walk(scene, io::VolumeFields(volume, fields, scale_mm, options), g, count);
    return std::equal(again.forces.begin(), again.forces.end(), first.forces.begin());
  };
  EXPECT_TRUE(repeats(std::min(ticks(), ticks() / 10 + 500), roomy)) << "the same seed gave other forces";
  EXPECT_TRUE(repeats(std::min(ticks(), ticks() / 50 + 500), {.brick_bytes = 0, .background = false}))
      << "other forces without bricks";
}

/// On phantoms, scanned as oddly as scans are: oblique, tilted, not square, uneven, with a slice missing and noise.
TEST(Walk, through_an_odd_scan_with_every_mode_on_stays_finite_bounded_certified_and_repeatable) {
  testdata::Grid grid;
  grid.size = {64, 56, 40};
  grid.spacing = {0.7, 0.9, 1.6};
  grid.tilt_degrees = 12;
  grid.uneven_mm = 0.3;
  grid.missing = {20};
  grid = testdata::rotated(std::move(grid), glm::normalize(Vec3(1, 2, 3)), 30);
  testdata::Phantom head = testdata::make_sphere(18);
  head.bodies.push_back(testdata::make_sphere(12, testdata::bone_hu).bodies.front());
  walk_through("an odd scan",
               std::make_shared<const io::Volume>(testdata::scan(head, testdata::make_geometry(grid), {.noise = 15})));
}

TEST(SharedWalk, through_every_shared_scan_with_every_mode_on_stays_finite_bounded_certified_and_repeatable) {
  if (!std::filesystem::exists(PALPATE_SHARED_DATA)) {
    GTEST_SKIP() << "needs the shared series in " << PALPATE_SHARED_DATA;
  }
  const char* const only = std::getenv("PALPATE_WALK_SCAN");
  int scans = 0;
  for (const auto& folder : std::filesystem::directory_iterator(PALPATE_SHARED_DATA)) {
    const std::string name = folder.path().filename().string();
    if (!folder.is_directory() || name == "truth" || (only != nullptr && name != only)) {
      continue;
    }
    for (const io::Series& series : io::find_series(std::array{folder.path()}).series) {
      if (series.usable) {
        SCOPED_TRACE(name + ", " + series.uid);
        walk_through(name, std::make_shared<const io::Volume>(io::load(series)));
        ++scans;
      }
    }
  }
  EXPECT_GT(scans, 0);
}

}  // namespace
}  // namespace palpate::modes
