#pragma once

/// A hand for tests and benchmarks: it steps a plan through a source, in patient space.

#include <memory>

#include "modes/scene/plan.h"
#include "modes/tick/haptic_step.h"
#include "solver/analytical.h"
#include "solver/chain.h"
#include "solver/descent.h"
#include "solver/exact.h"

namespace palpate::modes::testing {

/// The coupling between hand and proxy, for scenes that set no other.
inline constexpr double stiffness_n_per_mm = 0.4;

/// Steps with probe positions of patient space; mm and N along patient axes.
class Hand {
 public:
  Hand(const Scene& scene, const io::FieldSource& source, const Workspace& workspace = {})
      : plan(make_plan(scene, source.available(), workspace)), source_(source), chain_({.solvers = plan.solvers}) {}

  const StepResult& move_to(const Vec3& probe_mm) {
    result = step(plan, source_, plan.workspace.to_device(probe_mm), touch, chain_, *scratch_);
    return result;
  }
  /// In even steps; the first is one step from here.
  void stroke(const Vec3& from_mm, const Vec3& to_mm, int steps) {
    for (int i = 1; i <= steps; ++i) {
      move_to(from_mm + (to_mm - from_mm) * (static_cast<double>(i) / steps));
    }
  }
  Vec3 force() const { return plan.workspace.direction_to_patient(result.force_n); }
  Vec3 proxy_mm() const { return plan.workspace.to_patient(result.proxy_m); }

  Plan plan;
  Touch touch;
  StepResult result;

 private:
  const io::FieldSource& source_;
  solver::Chain chain_;
  std::unique_ptr<StepScratch> scratch_ = std::make_unique<StepScratch>();
};

/// The state of a tick, converted to the frame of another workspace.
inline Touch seen_in(const Workspace& workspace, Touch touch) {
  const auto there = [&](const Vec3& here_m) { return workspace.to_device(touch.workspace.to_patient(here_m)); };
  touch.probe_m = there(touch.probe_m);
  touch.proxy_m = there(touch.proxy_m);
  touch.force_n = workspace.direction_to_device(touch.workspace.direction_to_patient(touch.force_n));
  touch.workspace = workspace;
  return touch;
}

inline Mode mode_of(const char* type, const TransferFunction& strength, Datum of = Datum::value) {
  Mode mode;
  mode.type = type;
  mode.strength_of = of;
  mode.strength_n = strength;
  return mode;
}

inline Mode surface(const TransferFunction& strength, Datum of = Datum::gradient_magnitude,
                    Side side = Side::entering) {
  Mode mode = mode_of("surface", strength, of);
  mode.side = side;
  return mode;
}

inline Scene scene_of(std::vector<Mode> modes, int most_sub_steps = 1) {
  Scene scene;
  scene.modes = std::move(modes);
  scene.subdivision.most = most_sub_steps;
  return scene;
}

/// A scene in which the hand's moves are not divided at boundaries.
inline Scene tick_by_tick(const Mode& mode) {
  Scene scene = scene_of({mode});
  scene.subdivision.most_halts = 0;
  return scene;
}

}  // namespace palpate::modes::testing
