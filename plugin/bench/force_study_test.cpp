#include "plugin/bench/force_study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>

#include "io/errors.h"
#include "modes/scene/scene_json.h"
#include "plugin/bench/force_labels.h"
#include "plugin/bench/force_phantom.h"
#include "plugin/bench/force_tables.h"
#include "testdata/analytic.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using glm::dvec3;

constexpr double ball_mm = 15;

PathWorld world_of_a_ball() {
  PathWorld world;
  world.targets = {{.name = "ball", .place_in = [](std::mt19937_64& random) {
                      std::uniform_real_distribution<double> even(-3, 3);
                      const double x = even(random), y = even(random), z = even(random);
                      return dvec3(x, y, z);
                    }}};
  world.is_outside = [](const dvec3& at) { return glm::length(at) > ball_mm; };
  world.is_bone = [](const dvec3&) { return false; };
  world.is_known = [](const dvec3&) { return true; };
  return world;
}

modes::Scene wall(double level_hu, double strength_n) {
  return modes::scene_from_json(fmt::format(R"({{"version": 1, "modes": [{{"type": "surface",
        "strength_n": {{"of": "value", "nodes": [[{}, 0], [{}, {}]]}}}}]}})",
                                            level_hu - 1, level_hu + 1, strength_n),
                                "wall");
}

FeltScene felt_on(const testdata::Phantom& phantom, const modes::Scene& scene) {
  FeltScene felt{.scene = scene, .on = {}};
  felt.on.source = std::make_shared<testdata::AnalyticSource>(phantom, 0.5);
  felt.on.plan =
      std::make_shared<const modes::Plan>(modes::make_plan(scene, felt.on.source->available(), modes::Workspace{}));
  return felt;
}

ForceGroup group_of_balls() {
  ForceGroup group{.name = "balls", .against = "a ball", .world = world_of_a_ball()};
  group.truth = [](const io::Progress&) { return felt_on(testdata::make_sphere(ball_mm), wall(-480, 50)); };
  return group;
}

std::string all_of(const std::vector<ForceRowResult>& results) {
  return forces_csv(results, 1, false) + known_csv(results, 1) + pairs_csv(results, 1);
}

TEST(ForcePaths, LeadFromOutsideToTheTargetByTheRuleAndDependOnSeedAndNumberAlone) {
  PathWorld world = phantom_groups(1).front().world;
  const testdata::Phantom torso = make_torso();
  int planned = 0, other = 0;
  for (std::size_t n = 0; n < 200; ++n) {
    const auto path = plan_path(world, 7, n);
    const auto again = plan_path(world, 7, n), another = plan_path(world, 8, n);
    ASSERT_EQ(path.has_value(), again.has_value());
    if (!path) continue;
    ++planned;
    EXPECT_EQ(path->from_mm, again->from_mm);
    EXPECT_EQ(path->to_mm, again->to_mm);
    other += another && another->from_mm != path->from_mm;
    EXPECT_EQ(testdata::value_at(torso, path->from_mm), testdata::air_hu);
    EXPECT_NE(testdata::value_at(torso, path->to_mm), testdata::air_hu);
    const std::string& target = world.targets[path->target].name;
    double densest = -1e9;
    constexpr int parts = 500;
    for (int at = 0; at <= parts; ++at) {
      const double part = static_cast<double>(at) / parts;
      densest = std::max(densest, testdata::value_at(torso, (1 - part) * path->from_mm + part * path->to_mm));
    }
    EXPECT_EQ(densest > 500, target == "bone") << target << ": through bone only where bone is the target";
  }
  EXPECT_EQ(planned, 200);
  EXPECT_GT(other, 190);
}

TEST(ForcePaths, NoPathIsFoundWhereTheRuleAllowsNone) {
  PathWorld world = world_of_a_ball();
  world.most_mm = 5;
  EXPECT_FALSE(plan_path(world, 1, 0));
  world = world_of_a_ball();
  world.is_bone = [](const dvec3& at) { return glm::length(at) > 10 && glm::length(at) < 11; };
  EXPECT_FALSE(plan_path(world, 1, 0));
  world.targets.front().is_bone = true;
  EXPECT_TRUE(plan_path(world, 1, 0));
}

/// A hard wall holds with k times the depth: a ball that is smaller by d gives forces that are smaller by k d.
TEST(ForceStudy, FindsTheErrorThatMathematicsGives) {
  constexpr double smaller_mm = 0.5, k_n_per_mm = 0.4;
  ForceGroup group = group_of_balls();
  group.off_mm = [](const dvec3& at) { return std::abs(glm::length(at) - ball_mm); };
  group.rows = {
      {"the same", [](const io::Progress&) { return felt_on(testdata::make_sphere(ball_mm), wall(-480, 50)); }},
      {"smaller",
       [](const io::Progress&) { return felt_on(testdata::make_sphere(ball_mm - smaller_mm), wall(-480, 50)); }},
      {"without", [](const io::Progress&) { return felt_on(testdata::make_sphere(ball_mm), wall(5000, 50)); }}};
  const auto results = compare_forces({group}, {.paths_a_row = 24, .seed = 3});
  ASSERT_EQ(results.size(), 3U);
  const ForceErrors &same = results[0].errors, &smaller = results[1].errors, &without = results[2].errors;
  EXPECT_EQ(same.rms_n(), 0);
  EXPECT_EQ(same.largest_n(), 0);
  EXPECT_EQ(same.affected(), 0);
  EXPECT_EQ(same.first_contact_mm(0.95), 0);
  // Where both hold, on paths to near the middle; before that one holds by itself, with less.
  // A path beside the middle meets the two at places that are a little more apart.
  EXPECT_NEAR(smaller.largest_n(), k_n_per_mm * smaller_mm, 0.03);
  EXPECT_NEAR(smaller.p95_n(), k_n_per_mm * smaller_mm, 0.03);
  EXPECT_LT(smaller.rms_n(), k_n_per_mm * smaller_mm);
  EXPECT_GT(smaller.rms_n(), 0.7 * k_n_per_mm * smaller_mm);
  EXPECT_NEAR(smaller.first_contact_mm(0.5), smaller_mm, 0.06);
  EXPECT_EQ(smaller.missed(), 0U);
  EXPECT_EQ(without.missed(), results[2].paths);
  // The whole force is missing: k times the depth, at most that of the longest path.
  EXPECT_NEAR(without.largest_n(), k_n_per_mm * (ball_mm), k_n_per_mm * 4);
}

TEST(ForceStudy, OfAScanIsTheSameOnAnyNumberOfThreads) {
  ForceGroup group = group_of_balls();
  group.truth = [](const io::Progress&) { return felt_on(testdata::make_sphere(ball_mm), wall(-480, 1)); };
  group.off_mm = [](const dvec3& at) { return std::abs(glm::length(at) - ball_mm); };
  const auto volume = std::make_shared<const io::Volume>(testdata::scan(
      testdata::make_sphere(ball_mm), testdata::make_geometry({.size = glm::ivec3(48)}), {.noise = 30, .seed = 5}));
  group.rows = {{"scan", [=](const io::Progress&) { return felt_on_scan(wall(-480, 1), volume); }}};
  const auto one = all_of(compare_forces({group}, {.paths_a_row = 80, .seed = 4, .threads = 1}));
  for (const int threads : {2, 3, 7}) {
    EXPECT_EQ(all_of(compare_forces({group}, {.paths_a_row = 80, .seed = 4, .threads = threads})), one) << threads;
  }
  EXPECT_NE(all_of(compare_forces({group}, {.paths_a_row = 80, .seed = 5, .threads = 2})), one);
}

TEST(ForceStudy, NoiseRaisesTheErrorAndTheTruthLiesWithinWhatIsStated) {
  ForceGroup group = group_of_balls();
  group.truth = [](const io::Progress&) { return felt_on(testdata::make_sphere(ball_mm), wall(-480, 1)); };
  group.off_mm = [](const dvec3& at) { return std::abs(glm::length(at) - ball_mm); };
  for (const double noise : {0.0, 60.0}) {
    group.rows.push_back({"noise", [=](const io::Progress&) {
                            return felt_on_scan(wall(-480, 1), std::make_shared<const io::Volume>(testdata::scan(
                                                                   testdata::make_sphere(ball_mm),
                                                                   testdata::make_geometry({.size = glm::ivec3(48)}),
                                                                   {.noise = noise})));
                          }});
  }
  const auto results = compare_forces({group}, {.paths_a_row = 150, .seed = 2});
  EXPECT_LT(results[0].errors.rms_n(), results[1].errors.rms_n());
  for (const ForceRowResult& row : results) {
    const KnownPlaces known = row.errors.known_of_all();
    EXPECT_GT(known.contacts, 140U);
    EXPECT_GT(known.share(), 0.9);
  }
}

TEST(ForceStudy, IsCancelled) {
  ForceGroup group = group_of_balls();
  group.rows = {
      {"the same", [](const io::Progress&) { return felt_on(testdata::make_sphere(ball_mm), wall(-480, 50)); }}};
  double last = 0;
  const auto until_half = [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return done < 0.5;
  };
  EXPECT_THROW(compare_forces({group}, {.paths_a_row = 200, .seed = 1}, until_half), io::Cancelled);
}

TEST(ForceStudy, IsCancelledWhileARowIsPrepared) {
  ForceGroup group = group_of_balls();
  bool preparing = false, gone_on = false;
  group.rows = {{"slow", [&](const io::Progress& progress) {
                   preparing = true;
                   if (!progress(0.5)) throw io::Cancelled();
                   gone_on = true;
                   return felt_on(testdata::make_sphere(ball_mm), wall(-480, 50));
                 }}};
  EXPECT_THROW(compare_forces({group}, {.paths_a_row = 8, .seed = 1}, [&](double) { return !preparing; }),
               io::Cancelled);
  EXPECT_FALSE(gone_on);
}

io::Mask mask_of(const glm::ivec3& size, const std::function<bool(const glm::ivec3&)>& inside) {
  io::Geometry geometry;
  geometry.dimensions = size;
  for (int k = 0; k < size.z; ++k) geometry.slice_positions.emplace_back(0, 0, k);
  io::Mask mask = empty_mask(geometry);
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        if (inside({i, j, k})) mask.occupancy[mask.offset(i, j, k)] = io::Mask::full;
      }
    }
  }
  return mask;
}

std::size_t voxels_of(const io::Mask& mask) {
  std::size_t count = 0;
  for (const std::uint8_t part : mask.occupancy) count += part >= io::Mask::half;
  return count;
}

TEST(ForceLabels, ErosionShiftAndRaggedEdgesMoveTheEdgeByWhatTheySay) {
  const auto box =
      mask_of({24, 20, 4}, [](const glm::ivec3& at) { return at.x >= 5 && at.x < 17 && at.y >= 4 && at.y < 14; });
  ASSERT_EQ(voxels_of(box), 12U * 10 * 4);
  for (const int n : {1, 2}) {
    EXPECT_EQ(voxels_of(eroded(box, n)), static_cast<std::size_t>((12 - 2 * n) * (10 - 2 * n) * 4)) << n;
    const io::Mask moved = shifted(box, n);
    EXPECT_EQ(voxels_of(moved), voxels_of(box));
    EXPECT_TRUE(moved.inside(16 + n, 8, 1));
    EXPECT_FALSE(moved.inside(4 + n, 8, 1));
    const io::Mask rough = ragged(box, n, 5);
    EXPECT_NE(voxels_of(rough), voxels_of(box));
    for (int j = 0; j < 20; ++j) {
      for (int i = 0; i < 24; ++i) {
        if (eroded(box, n).inside(i, j, 1)) {
          EXPECT_TRUE(rough.inside(i, j, 1));
        }
        if (i < 5 - n || i >= 17 + n || j < 4 - n || j >= 14 + n) {
          EXPECT_FALSE(rough.inside(i, j, 1));
        }
      }
    }
  }
}

TEST(ForceLabels, TheBodyIsTheLargestPieceWithTheAirInIt) {
  const testdata::Phantom chest = testdata::make_chest();
  const auto volume = testdata::scan(chest, testdata::make_geometry({.size = {96, 96, 6}, .spacing = {4, 4, 4}}),
                                     {.circle_radius = 185});
  const io::Mask body = body_in(volume);
  for (const auto& [place, is_body] : {std::pair{dvec3(0, 0, 0), true},
                                       {dvec3(75, -10, 0), true},   // lung
                                       {dvec3(0, 30, 0), true},     // trachea
                                       {dvec3(0, -170, 0), false},  // before the skin
                                       {dvec3(0, 174, 0), false},   // the table
                                       {dvec3(0, 164, 0), false}}) {
    const glm::ivec3 at(glm::round(volume.geometry.to_index(place)));
    EXPECT_EQ(body.inside(at.x, at.y, at.z), is_body) << place.x << ' ' << place.y;
  }
}

}  // namespace
}  // namespace palpate::plugin
