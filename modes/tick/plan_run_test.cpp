// What a plan left out is never computed, allocated or called: counted on a scan's own fields and the solvers' chain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/testing/test_rig.h"
#include "modes/tick/reach.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

using io::FieldSet;
using testing::mode_of;

/// Counts what is asked of a scan's fields.
class Counted : public io::FieldSource {
 public:
  Counted(const std::shared_ptr<const io::Volume>& volume, FieldSet wanted, const io::SliceRange& slices = {})
      : samples_by_slice(static_cast<std::size_t>(volume->geometry.dimensions.z)),
        volume_(volume),
        fields_(volume, wanted, io::default_gradient_scale_mm(volume->geometry), {.ahead = slices}) {}
  FieldSet available() const noexcept override { return fields_.available(); }
  io::Sample sample(const Vec3& position_mm, FieldSet wanted) const noexcept override {
    ++samples;
    asked = asked | wanted;
    const Vec3 index = volume_->geometry.to_index(position_mm);
    if (volume_->geometry.contains(index)) {
      ++samples_by_slice[static_cast<std::size_t>(index.z)];
    }
    return fields_.sample(position_mm, wanted);
  }
  std::size_t memory_bytes() const { return fields_.memory_bytes(); }
  void prepare_all() const { fields_.prepare({0, 0, 0}, 1000); }

  mutable int samples = 0;
  mutable FieldSet asked = FieldSet::none;
  mutable std::vector<int> samples_by_slice;  ///< by the slice below

 private:
  std::shared_ptr<const io::Volume> volume_;
  io::VolumeFields fields_;
};

std::shared_ptr<const io::Volume> ball() {
  return std::make_shared<const io::Volume>(testdata::scan(testdata::make_sphere(20), testdata::make_geometry({})));
}

/// One mode that is felt among those that are not, each of which would read another field.
Scene scene_with_little_to_feel(const Mode& felt) {
  Mode off = mode_of("tube", TransferFunction(1));
  off.enabled = false;
  Mode closed = mode_of("surface", TransferFunction(1));
  closed.gates = {{Datum::low, TransferFunction({{-1000, 0}, {1000, 1}})}, {Datum::value, TransferFunction(0.0)}};
  return testing::scene_of(
      {mode_of("friction", TransferFunction(0.0)), off, closed, mode_of("follow", TransferFunction(1)), felt}, 8);
}

struct Counts {
  Plan plan;
  std::size_t field_bytes = 0, chain_bytes = 0;
  FieldSet asked = FieldSet::none;
  int samples = 0, expected_samples = 0;
  std::set<int> modes;
  bool exact_called = false;
};

Counts count(const Scene& scene) {
  const auto volume = ball();
  Counts counts{.plan = make_plan(scene, io::fields_of(*volume), {})};
  const Counted source(volume, counts.plan.fields);
  testing::Hand hand(scene, source);
  for (int tick = 0; tick < 3000; ++tick) {
    hand.move_to({24 * std::sin(0.003 * tick), 4 * std::sin(0.02 * tick), 1});
    counts.expected_samples += hand.result.sub_steps + hand.result.halts;
    counts.modes.insert(hand.result.mode_of.begin(), hand.result.mode_of.end());
    counts.exact_called = counts.exact_called || hand.result.solver == &solver::exact_solver;
  }
  counts.asked = source.asked;
  counts.samples = source.samples;
  counts.field_bytes = source.memory_bytes();
  counts.chain_bytes = solver::Chain({.solvers = counts.plan.solvers}).memory_bytes();
  return counts;
}

TEST(PlanRun, computes_allocates_and_calls_nothing_that_was_left_out) {
  const Counts skin = count(scene_with_little_to_feel(testing::surface(TransferFunction({{20, 0}, {60, 1}}))));
  EXPECT_EQ(skin.plan.modes.size(), 1U);
  EXPECT_EQ(skin.asked, FieldSet::value | FieldSet::gradient);
  EXPECT_EQ(skin.samples, skin.expected_samples) << "each sub-step samples once";
  EXPECT_EQ(skin.modes, std::set<int>{4});
  EXPECT_FALSE(skin.exact_called);
  // Bricks: what was left out would have had its own.
  const auto volume = ball();
  const double scale_mm = io::default_gradient_scale_mm(volume->geometry);
  const io::VolumeFields everything(volume, io::fields_of(*volume), scale_mm);
  EXPECT_EQ(skin.field_bytes, io::VolumeFields(volume, FieldSet::gradient, scale_mm).memory_bytes());
  EXPECT_LT(skin.field_bytes, everything.memory_bytes());
  // The exact solver's scratch memory, which is most of the chain's.
  EXPECT_LT(2 * skin.chain_bytes, solver::Chain().memory_bytes());
}

TEST(PlanRun, keeps_no_brick_where_no_gradient_is_read_and_no_field_where_nothing_is) {
  const Counts by_value =
      count(scene_with_little_to_feel(mode_of("friction", TransferFunction({{-500, 0}, {0, 0.2}}))));
  EXPECT_EQ(by_value.asked, FieldSet::value);
  EXPECT_EQ(by_value.field_bytes, 0U);
  EXPECT_EQ(by_value.modes, std::set<int>{4});
  const Counts constant = count(scene_with_little_to_feel(mode_of("friction", TransferFunction(0.2))));
  EXPECT_EQ(constant.asked, FieldSet::none);
  EXPECT_EQ(constant.field_bytes, 0U);
}

/// A probe that is anywhere within the device's reach, with surfaces that hold the proxy off it, and a worker that
/// computes ahead: no cell of a slice that was left out is ever asked for, and none is ever kept.
TEST(PlanRun, samples_and_keeps_nothing_of_the_slices_that_were_left_out) {
  const auto volume = ball();
  const io::Geometry& g = volume->geometry;
  const Scene scene = testing::scene_of(
      {testing::surface(TransferFunction({{20, 0}, {60, 2}})),
       testing::surface(TransferFunction({{20, 0}, {60, 2}}), Datum::gradient_magnitude, Side::leaving)},
      8);
  Workspace workspace;
  workspace.center_mm = {4, -3, 10};
  const Vec3 half_extent_m(0.02, 0.006, 0.015);
  Plan plan = make_plan(scene, io::fields_of(*volume), workspace);
  leave_out_slices(g, half_extent_m, plan);
  ASSERT_GT(plan.slices.first, 0);
  ASSERT_LT(plan.slices.last, g.dimensions.z - 1);
  const Counted source(volume, plan.fields, plan.slices);
  solver::Chain chain({.solvers = plan.solvers});
  const auto scratch = std::make_unique<StepScratch>();
  Touch touch;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> part(-1, 1);
  Vec3 probe(0);
  double farthest_m = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    for (int axis = 0; axis < 3; ++axis) {
      probe[axis] = std::clamp(probe[axis] + 3e-4 * part(random), -half_extent_m[axis], half_extent_m[axis]);
    }
    const StepResult result = step(plan, source, probe, touch, chain, *scratch);
    farthest_m = std::max(farthest_m, std::abs(result.proxy_m.y) - half_extent_m.y);
  }
  EXPECT_GT(farthest_m, 0) << "the proxy was never beyond the probe's reach: too easy a walk";
  int kept = 0, of_those_left_out = 0, by_slice = 0;
  for (int slice = 0; slice < g.dimensions.z - 1; ++slice) {
    const bool in_plan = slice >= plan.slices.first && slice < plan.slices.last;
    by_slice += source.samples_by_slice[static_cast<std::size_t>(slice)];
    of_those_left_out += in_plan ? 0 : source.samples_by_slice[static_cast<std::size_t>(slice)];
  }
  EXPECT_GT(by_slice, 20000);
  EXPECT_EQ(of_those_left_out, 0);
  // What the worker may hold: everything that can be had is asked for, cell by cell.
  source.prepare_all();
  for (int slice = 0; slice < g.dimensions.z - 1; ++slice) {
    const Vec3 middle(0.5 * Vec3(g.dimensions - 1));
    const io::Sample sample = source.sample(g.to_patient({middle.x, middle.y, slice + 0.5}), FieldSet::gradient);
    const bool in_plan = slice >= plan.slices.first && slice < plan.slices.last;
    EXPECT_EQ(sample.from_brick, in_plan) << slice;
    kept += sample.from_brick ? 1 : 0;
  }
  EXPECT_EQ(kept, plan.slices.last - plan.slices.first);
  EXPECT_LT(source.memory_bytes(), Counted(volume, plan.fields).memory_bytes());
}

}  // namespace
}  // namespace palpate::modes
