/// Laws of the haptic step that hold for any scene and path: what the workspace is does not matter, nor whether a
/// travel comes in one tick or in its sub-steps, nor a change to the same scene. Tried where every part of a step has
/// something to do: surfaces that hold and give way, friction that sticks and slips, halts and sub-steps.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <vector>

#include "modes/testing/test_rig.h"

namespace palpate::modes {
namespace {

using testing::Hand;
using testing::mode_of;
using testing::scene_of;
using testing::surface;

/// Shells of soft edges around the origin, 1.5 mm apart, each higher than the one outside it, so that the proxy that
/// one lets go of jumps to the next; and a vector field.
class Shells : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override {
    return io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::vector;
  }
  io::Sample sample(const io::Vec3& p, io::FieldSet) const noexcept override {
    io::Sample sample;
    sample.inside = true;
    const double r = glm::length(p);
    double slope = 0;
    for (const auto& [radius, height] : {std::pair{20.0, 1.0}, {18.5, 2.0}, {17.0, 3.0}}) {
      const double bump = height * std::exp(-(r - radius) * (r - radius) / 0.08);
      sample.value += bump;
      slope -= 2 * (r - radius) / 0.08 * bump;
    }
    sample.gradient = r > 0 ? slope / r * p : io::Vec3(0);
    sample.vector = {-p.z, 0.3 * p.x, p.x};
    return sample;
  }
};

/// The same in another unit.
class ShellsIn final : public Shells {
 public:
  explicit ShellsIn(double unit) : unit_(unit) {}
  io::Sample sample(const io::Vec3& p, io::FieldSet wanted) const noexcept override {
    io::Sample sample = Shells::sample(p, wanted);
    sample.value *= unit_;
    sample.gradient *= unit_;
    sample.vector *= unit_;
    return sample;
  }

 private:
  double unit_;
};

Scene everything(double unit = 1) {
  Scene scene = scene_of({surface(TransferFunction({{0.1 * unit, 0}, {1 * unit, 0.7}, {3 * unit, 2}}), Datum::value),
                          mode_of("friction", TransferFunction(0.1), Datum::gradient_magnitude),
                          mode_of("follow", TransferFunction(0.05), Datum::vector_magnitude),
                          mode_of("force", TransferFunction(0.1), Datum::vector_magnitude)});
  scene.subdivision = {.step_mm = 0.1, .most = 8, .proxy_step_mm = 0.25, .most_halts = 16};
  return scene;
}

Vec3 vector(std::mt19937& random, double size) {
  std::normal_distribution<double> normal(0, size);
  const double x = normal(random), y = normal(random), z = normal(random);
  return {x, y, z};
}

/// In and out through the shells with travels of up to 0.6 mm a tick.
std::vector<Vec3> path_mm(unsigned seed) {
  std::mt19937 random(seed);
  const Vec3 axis = glm::normalize(vector(random, 1));
  std::vector<Vec3> path;
  for (int n = 0; n < 400; ++n) path.push_back((20 + 5 * std::cos(0.05 * n)) * axis + vector(random, 0.05));
  return path;
}

Workspace any_workspace(std::mt19937& random) {
  const Vec3 x = glm::normalize(vector(random, 1));
  const Vec3 y = glm::normalize(glm::cross(x, vector(random, 1)));
  Workspace workspace;
  workspace.rotation = glm::dmat3(x, y, glm::cross(x, y));
  workspace.center_mm = vector(random, 100);
  workspace.mm_per_m = std::uniform_real_distribution<double>(200, 3000)(random);
  return workspace;
}

// Between sharp edges rounding grows from tick to tick, as weather does: so each tick is begun from the same state.
constexpr double same_mm = 1e-6;
constexpr double same_n = 1e-6;

struct Met {
  int halts = 0, sub_steps = 0, held = 0, yielding = 0;
  void operator+=(const StepResult& result) {
    halts += result.halts;
    sub_steps += result.sub_steps > 1 ? 1 : 0;
    held += result.hold == HoldState::held ? 1 : 0;
    yielding += result.hold == HoldState::yielding ? 1 : 0;
  }
  void expect_all() const {
    EXPECT_GT(halts, 100);
    EXPECT_GT(sub_steps, 100);
    EXPECT_GT(held, 100);
    EXPECT_GT(yielding, 10);
  }
};

/// Turned, moved and scaled, with a stiffness that makes a mm of patient as hard as before, everything in the patient
/// is as it was: proxy, force, halts and sub-steps.
TEST(StepLaws, TheWorkspaceDoesNotMatter) {
  const Shells shells;
  const Scene scene = everything();
  Met met;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const Workspace workspace = any_workspace(random);
    Scene scaled = scene;
    scaled.stiffness_n_per_m *= workspace.mm_per_m / Workspace{}.mm_per_m;
    Hand plain(scene, shells), mapped(scaled, shells, workspace);
    for (const Vec3& probe : path_mm(seed)) {
      mapped.touch = testing::seen_in(workspace, plain.touch);
      plain.move_to(probe);
      mapped.move_to(probe);
      ASSERT_LT(glm::length(plain.proxy_mm() - mapped.proxy_mm()), same_mm) << seed;
      ASSERT_LT(glm::length(plain.force() - mapped.force()), same_n) << seed;
      ASSERT_EQ(plain.result.halts, mapped.result.halts) << seed;
      ASSERT_EQ(plain.result.sub_steps, mapped.result.sub_steps) << seed;
      met += plain.result;
    }
  }
  met.expect_all();
}

/// The same numbers in a larger or a smaller unit, by a power of two, are felt the same to the last bit.
TEST(StepLaws, TheUnitOfTheScanDoesNotMatter) {
  const Shells shells;
  Met met;
  for (const double unit : {0x1p-40, 0x1p-12, 0x1p20}) {
    const ShellsIn other_shells(unit);
    for (unsigned seed = 0; seed < 5; ++seed) {
      Hand plain(everything(), shells), other(everything(unit), other_shells);
      for (const Vec3& probe : path_mm(seed)) {
        plain.move_to(probe);
        other.move_to(probe);
        ASSERT_EQ(plain.result.proxy_m, other.result.proxy_m) << unit << ", " << seed;
        ASSERT_EQ(plain.result.force_n, other.result.force_n) << unit << ", " << seed;
        ASSERT_EQ(plain.result.halts, other.result.halts) << unit << ", " << seed;
        met += plain.result;
      }
    }
  }
  EXPECT_GT(met.held, 50);
  EXPECT_GT(met.halts, 20);
}

/// A travel in one tick is the same as its sub-steps in ticks of their own.
TEST(StepLaws, SubStepsAreTicksAtEvenlySpacedProbes) {
  const Shells shells;
  const Scene scene = everything();
  Met met;
  for (unsigned seed = 0; seed < 20; ++seed) {
    Hand whole(scene, shells), pieces(scene, shells);
    Vec3 from(0);
    bool first = true;
    for (const Vec3& probe : path_mm(seed)) {
      pieces.touch = whole.touch;
      whole.move_to(probe);
      if (first) from = probe;
      first = false;
      const int count = whole.result.sub_steps;
      int halts = 0;
      for (int i = 1; i <= count; ++i) {
        pieces.move_to(from + (probe - from) * (static_cast<double>(i) / count));
        halts += pieces.result.halts;
        // Evenly spaced ones of the most sub-steps may still be longer than one step.
        if (count < scene.subdivision.most) {
          ASSERT_EQ(pieces.result.sub_steps, 1);
        }
      }
      from = probe;
      if (count == scene.subdivision.most || whole.result.halts == scene.subdivision.most_halts) {
        continue;  // each tick has its own cap: here they may differ
      }
      ASSERT_LT(glm::length(whole.proxy_mm() - pieces.proxy_mm()), same_mm) << seed;
      ASSERT_LT(glm::length(whole.force() - pieces.force()), same_n) << seed;
      ASSERT_EQ(whole.result.halts, halts) << seed;
      met += whole.result;
    }
  }
  EXPECT_GT(met.sub_steps, 1000);
  EXPECT_GT(met.halts, 50);
}

/// No jump of a free proxy is longer than the step between two samples, in mm of the patient, whatever the workspace.
TEST(StepLaws, AHaltIsAsLongAsTheStepInThePatient) {
  const Shells shells;
  Scene scene = everything();
  scene.subdivision.most = 1;
  int halted = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    // One halt a tick, so that each tick with a halt ends one balance after it.
    scene.subdivision.most_halts = 1;
    Hand hand(scene, shells, any_workspace(random));
    for (const Vec3& probe : path_mm(seed)) {
      const Touch before = hand.touch;
      hand.move_to(probe);
      if (hand.result.halts == 0) continue;
      ++halted;
      // The sample of the last sub-step was taken where the halt left the proxy: that far from where it was.
      ASSERT_TRUE(before.started);
      const Vec3 halted_at = hand.touch.contact.scan.place_mm;
      const Vec3 was = hand.plan.workspace.to_patient(before.proxy_m);
      EXPECT_NEAR(glm::length(halted_at - was), scene.subdivision.proxy_step_mm, 1e-6) << seed;
      EXPECT_EQ(hand.touch.contact.scan.level, shells.sample(halted_at, {}).value) << "there the level starts anew";
    }
  }
  EXPECT_GT(halted, 100);
}

/// A change from a scene to itself is no change: half of each primitive and the other half are the whole.
TEST(StepLaws, AChangeToTheSameSceneIsNone) {
  const Shells shells;
  const Scene scene = everything();
  for (unsigned seed = 0; seed < 5; ++seed) {
    Hand plain(scene, shells);
    const Plan plan = make_plan(scene, shells.available(), {});
    Touch touch;
    solver::Chain chain({.capacity = most_primitives});
    const auto scratch = std::make_unique<StepScratch>();
    int n = 0;
    for (const Vec3& probe : path_mm(seed)) {
      const double part = std::min(1.0, n++ / 300.0);
      touch = plain.touch;
      touch.changing = n > 1;
      touch.leaving = touch.contact;
      const SceneOnData same{&plan, &shells};
      const StepResult result =
          step({.from = same, .to = same, .part = part}, plan.workspace.to_device(probe), touch, chain, *scratch);
      plain.move_to(probe);
      ASSERT_LT(glm::length(result.proxy_m - plain.result.proxy_m), 1e-3 * same_mm) << seed << " tick " << n;
      ASSERT_LT(glm::length(result.force_n - plain.result.force_n), same_n) << seed << " tick " << n;
    }
  }
}

/// At its beginning a change is the scene that is left, at its end the one that comes, though the other one has no
/// surface: what one of them holds is held, however fast the hand slides along it.
TEST(StepLaws, AChangeBeginsAsTheSceneThatIsLeftAndEndsAsTheOneThatComes) {
  const Shells shells;
  Scene walls = everything();
  walls.subdivision.most = 1;
  Scene no_walls = walls;
  no_walls.modes.erase(no_walls.modes.begin());
  const Plan without = make_plan(no_walls, shells.available(), {});
  solver::Chain chain({.capacity = most_primitives});
  const auto scratch = std::make_unique<StepScratch>();
  int slid = 0;
  for (const bool is_left : {true, false}) {
    for (unsigned seed = 0; seed < 5; ++seed) {
      std::mt19937 random(seed);
      const Vec3 u = glm::normalize(vector(random, 1)), v = glm::normalize(glm::cross(u, vector(random, 1)));
      Hand plain(walls, shells);
      for (int n = 0; n < 400; ++n) {
        // In and out through the shells, and round them by 0.6 mm a tick.
        const Vec3 probe = (20 + 5 * std::cos(0.05 * n)) * (std::cos(0.03 * n) * u + std::sin(0.03 * n) * v);
        Touch touch = plain.touch;
        touch.changing = true;
        touch.contact = is_left ? HeldSurfaces{} : plain.touch.contact;
        touch.leaving = is_left ? plain.touch.contact : HeldSurfaces{};
        const SceneOnData with{&plain.plan, &shells}, other{&without, &shells};
        const StepResult result =
            step({.from = is_left ? with : other, .to = is_left ? other : with, .part = is_left ? 0.0 : 1.0},
                 plain.plan.workspace.to_device(probe), touch, chain, *scratch);
        const Vec3 was = plain.proxy_mm();
        plain.move_to(probe);
        ASSERT_EQ(result.halts, plain.result.halts) << seed << " tick " << n;
        ASSERT_LT(glm::length(result.proxy_m - plain.result.proxy_m), 1e-3 * same_mm) << seed << " tick " << n;
        ASSERT_LT(glm::length(result.force_n - plain.result.force_n), same_n) << seed << " tick " << n;
        const bool is_fast = glm::distance(plain.proxy_mm(), was) > walls.subdivision.proxy_step_mm;
        slid += is_fast && plain.result.halts == 0 && plain.result.hold == HoldState::held ? 1 : 0;
      }
    }
  }
  EXPECT_GT(slid, 50);
}

}  // namespace
}  // namespace palpate::modes
