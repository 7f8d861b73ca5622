#include "modes/scene/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "modes/scene/scene_json.h"
#include "modes/testing/test_rig.h"

namespace palpate::modes {
namespace {

using io::FieldSet;

constexpr FieldSet scan = FieldSet::value | FieldSet::gradient | FieldSet::tube | FieldSet::low_high;
constexpr FieldSet flow = FieldSet::value | FieldSet::gradient | FieldSet::vector;

Mode mode(const char* type, double strength_n = 1, DirectionField field = DirectionField::vector) {
  Mode mode;
  mode.type = type;
  mode.strength_n = TransferFunction(strength_n);
  mode.direction_of = field;
  return mode;
}

Plan plan_of(std::vector<Mode> modes, FieldSet available = scan) {
  return make_plan(testing::scene_of(std::move(modes)), available, {});
}

const LeftOut* left_out(const Plan& plan, const std::string& what) {
  const auto found = std::find_if(plan.left_out.begin(), plan.left_out.end(),
                                  [&what](const LeftOut& entry) { return entry.what.find(what) == 0; });
  return found == plan.left_out.end() ? nullptr : &*found;
}

TEST(Plan, needs_the_fields_that_its_modes_read_and_says_which_it_leaves_out) {
  const Plan plan = plan_of({mode("surface"), mode("friction")});
  EXPECT_TRUE(plan.fields == (FieldSet::value | FieldSet::gradient));
  ASSERT_NE(left_out(plan, "Hessian"), nullptr);
  EXPECT_EQ(left_out(plan, "Hessian")->why, "no mode reads it");
  EXPECT_EQ(left_out(plan, "vector field"), nullptr);                 // a scan has none: nothing is saved
  EXPECT_TRUE(plan_of({mode("friction")}).fields == FieldSet::none);  // a constant strength reads nothing
  EXPECT_TRUE(plan_of({mode("force")}, flow).fields == FieldSet::vector);
}

TEST(Plan, leaves_out_modes_that_can_never_be_felt_and_says_why) {
  Mode off = mode("friction");
  off.enabled = false;
  Mode closed = mode("surface");
  closed.gates.push_back({Datum::value, TransferFunction(0.0)});
  const Plan plan = plan_of({mode("friction", 0), off, closed, mode("follow"), mode("surface")});
  ASSERT_EQ(plan.modes.size(), 1U);
  EXPECT_EQ(plan.modes[0].scene_index, 4U);
  EXPECT_EQ(left_out(plan, "friction (modes[0])")->why, "its strength is zero everywhere");
  EXPECT_EQ(left_out(plan, "friction (modes[1])")->why, "it is switched off");
  EXPECT_EQ(left_out(plan, "surface (modes[2])")->why, "its strength is zero everywhere");
  EXPECT_EQ(left_out(plan, "follow (modes[3])")->why, "there is no vector field here");
}

TEST(Plan, keeps_the_general_solver_only_where_some_tick_can_need_it) {
  const auto exact = [](std::vector<Mode> modes, FieldSet available) {
    const Plan plan = plan_of(std::move(modes), available);
    EXPECT_EQ(left_out(plan, "exact solver") == nullptr, plan.solvers.contains(solver::exact_solver));
    return plan.solvers.contains(solver::exact_solver);
  };
  Mode both = mode("surface");
  both.side = Side::both;
  EXPECT_FALSE(exact({mode("surface"), mode("friction")}, scan));
  EXPECT_FALSE(exact(
      {mode("surface"), both, mode("friction"), mode("friction"), mode("force", 1, DirectionField::gradient)}, scan));
  EXPECT_FALSE(exact({mode("follow"), mode("follow"), mode("force"), mode("friction")}, flow));
  EXPECT_FALSE(exact({mode("surface"), mode("follow", 1, DirectionField::gradient)}, flow));
  Mode point = mode("landmark");
  Mode plane = mode("landmark");
  plane.shape = Shape::plane;
  EXPECT_FALSE(exact({point, mode("force")}, flow));  // one constraint, wherever it is
  EXPECT_TRUE(exact({point, plane}, flow));
  EXPECT_TRUE(exact({point, mode("friction")}, flow));
  EXPECT_FALSE(exact({mode("tube"), mode("friction")}, scan));
  EXPECT_TRUE(exact({mode("tube"), mode("surface")}, scan));
  EXPECT_TRUE(exact({mode("surface"), mode("follow")}, flow));
  EXPECT_TRUE(exact({mode("follow"), mode("follow", 1, DirectionField::gradient)}, flow));
  EXPECT_FALSE(exact({mode("surface", 0), mode("follow")}, flow));  // what is left out needs no solver
}

TEST(Plan, says_what_its_modes_place_where_it_leaves_solvers_out) {
  Mode both = mode("surface");
  both.side = Side::both;
  Scene scene = testing::scene_of({mode("surface"), both, mode("friction"), mode("friction"), mode("friction"),
                                   mode("force", 1, DirectionField::gradient), mode("surface", 0)});
  scene.solvers.set(solver::descent_solver);
  const Plan plan = make_plan(scene, scan, {});
  for (const char* solver : {"exact solver", "descent solver"}) {
    ASSERT_NE(left_out(plan, solver), nullptr) << solver;
    EXPECT_EQ(left_out(plan, solver)->why, "1 force + 2 plane + 3 point: always analytical (section 3.1)");
  }
  EXPECT_FALSE(plan.solvers.contains(solver::exact_solver) || plan.solvers.contains(solver::descent_solver));
  EXPECT_TRUE(plan.solvers.contains(solver::analytical_solver));
  EXPECT_EQ(left_out(plan_of({}), "exact solver")->why, "no primitive: always analytical (section 3.1)");
  EXPECT_EQ(left_out(plan_of({}), "descent solver"), nullptr) << "the scene has it switched off";
}

TEST(Plan, without_the_analytical_solver_the_general_one_stays) {
  Scene scene = testing::scene_of({mode("surface")});
  scene.solvers.set(solver::analytical_solver, false);
  EXPECT_TRUE(make_plan(scene, scan, {}).solvers.contains(solver::exact_solver));
}

TEST(Plan, of_every_starting_scene_feels_something) {
  for (const std::string& name : starting_scenes()) {
    EXPECT_FALSE(make_plan(load_scene(name), scan | FieldSet::vector, {}).modes.empty()) << name;
  }
}

/// Of more structures than a tick can read: those that a mode reads only where the scan lacks another of its fields are
/// not read, and count for nothing. Each mode that is felt reads its own.
TEST(Plan, reads_no_structure_for_a_mode_that_it_leaves_out) {
  std::mt19937 random(7);
  const auto below = [&random](std::size_t count) {
    return std::uniform_int_distribution(std::size_t{0}, count - 1)(random);
  };
  int most_left_out = 0;
  for (int n = 0; n < 100; ++n) {
    Scene scene = testing::scene_of({});
    for (std::size_t s = 0; s < io::most_structures + 3; ++s) {
      scene.structures.push_back({.name = "s" + std::to_string(s), .file = "/a.dcm", .segment_number = 1});
    }
    std::set<std::size_t> expected;
    std::vector<double> strengths;  // of the modes that are felt
    for (std::size_t m = 0; m < 16; ++m) {
      const bool is_felt = below(2) == 0;
      const std::size_t count = is_felt ? io::most_structures : scene.structures.size();
      const std::size_t own = below(count), gate = below(count);
      Mode one = mode("friction");
      one.strength_of = Datum::distance;
      one.strength_structure = scene.structures[own].name;
      one.strength_n = TransferFunction({{0, 0}, {100, 100}});
      one.gates.push_back({Datum::distance, TransferFunction({{0, 0}, {100, 1}}), scene.structures[gate].name});
      if (is_felt) {
        expected.insert({own, gate});
        strengths.push_back(static_cast<double>((1 + own) * (1 + gate)) / 100);
      } else {
        one.gates.push_back({Datum::low, TransferFunction({{-1000, 0}, {1000, 1}})});
      }
      scene.modes.push_back(one);
    }
    const Plan plan = make_plan(scene, FieldSet::value | FieldSet::gradient | FieldSet::distance, {});
    EXPECT_EQ(std::set(plan.structures.begin(), plan.structures.end()), expected) << n;
    EXPECT_EQ(plan.structures.size(), expected.size()) << n;
    io::Sample sample;
    for (std::size_t k = 0; k < plan.structures.size(); ++k) {
      sample.distance[k].mm = 1 + static_cast<double>(plan.structures[k]);
    }
    ASSERT_EQ(plan.modes.size(), strengths.size()) << n;
    for (std::size_t m = 0; m < strengths.size(); ++m) {
      EXPECT_NEAR(plan.modes[m].strength(sample), strengths[m], 1e-9) << n;
    }
    int left_out_structures = 0;
    for (std::size_t s = 0; s < scene.structures.size(); ++s) {
      const bool is_left_out = left_out(plan, "structure \"s" + std::to_string(s) + "\"") != nullptr;
      EXPECT_EQ(is_left_out, !expected.contains(s)) << n << ", " << s;
      left_out_structures += is_left_out ? 1 : 0;
    }
    most_left_out = std::max(most_left_out, left_out_structures);
  }
  EXPECT_GT(most_left_out, 3) << "else all of the first eight were always read";
}

TEST(Plan, refuses_a_scene_that_is_not_valid) {
  Scene scene = testing::scene_of({mode("surface")});
  scene.stiffness_n_per_m = 0;
  EXPECT_THROW(make_plan(scene, scan, {}), std::invalid_argument);
}

TEST(Workspace, fits_the_scan_into_the_device) {
  WorkspaceSettings settings;
  settings.fit = true;
  const Vec3 low{-100, -50, 0}, high{100, 150, 300}, half{0.05, 0.04, 0.03};
  const Workspace workspace = place_workspace(settings, low, high, half);
  for (const double x : {low.x, high.x}) {
    for (const double y : {low.y, high.y}) {
      for (const double z : {low.z, high.z}) {
        const Vec3 device = workspace.to_device({x, y, z});
        EXPECT_LE(std::abs(device.x), half.x + 1e-12);
        EXPECT_LE(std::abs(device.y), half.y + 1e-12);
        EXPECT_LE(std::abs(device.z), half.z + 1e-12);
      }
    }
  }
  settings.fit = false;
  settings.scale = 2;
  EXPECT_EQ(place_workspace(settings, low, high, half).mm_per_m, 2000);
  EXPECT_EQ(place_workspace(settings, low, high, half).center_mm, Vec3(0, 50, 150));
}

}  // namespace
}  // namespace palpate::modes
