#pragma once

/// The haptic part of one tick, without a device: from the probe's position to the proxy, the coupling's force and the
/// data for a recording. The session calls this every tick; so do the command line, the studies and the tests.
///
/// A tick (Palmerius 2007, section 2.2) samples the fields once, at the proxy of the previous tick. Every mode of the
/// plan places its primitives there. The solution of the force balance is the new proxy. If the probe has travelled
/// more than Subdivision::step_mm, the tick is cut into sub-steps at evenly spaced probe positions, and each is
/// sampled, placed and solved in full. Their number depends on the travel alone, never on the clock, so that a session
/// can be replayed.
///
/// The proxy can jump while the probe does not. When a surface yields, the proxy is up to s / k from the probe, 2.5 mm
/// for 1 N at 400 N/m, and would pass a thin tissue in one tick. So a sub-step that would move the proxy farther than
/// Subdivision::proxy_step_mm halts it on the way; the fields are sampled there, and the balance is solved again at the
/// same probe position. After Subdivision::most_halts halts in one tick the proxy is not halted any more. Every tick
/// ends in a balance that is solved in full. Without a surface that yields there is no halt.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "io/fields/field_source.h"
#include "modes/scene/scene.h"
#include "modes/tick/anchor.h"
#include "modes/tick/stopwatch.h"
#include "modes/types/mode_type.h"
#include "solver/primitive.h"
#include "solver/solver_type.h"

namespace palpate::solver {
class Chain;
}

namespace palpate::modes {

struct Plan;

/// The most primitives of a tick: every mode of a scene on both sides, twice during a change of scene.
inline constexpr std::size_t most_primitives = 2 * Scene::most_modes * PrimitiveList::most_of_a_mode;

/// Marks, in StepResult::mode_of, primitives of the scene that is being left.
inline constexpr std::uint8_t of_scene_left = 0x80;

/// The state that one tick passes to the next. Value-initialized: nothing has been touched, and the next tick starts in
/// free space.
struct Touch {
  bool started = false;
  Vec3 probe_m{0};  ///< device's frame, of the last good tick
  Vec3 proxy_m{0};
  Vec3 force_n{0};
  HeldSurfaces contact;   ///< with the surfaces that hold the proxy
  Workspace workspace;    ///< of the last tick: when it changes, the proxy stays at its place in the patient
  bool changing = false;  ///< whether the last tick was part of a change of scene
  HeldSurfaces leaving;   ///< contact with the scene that is being left
};

/// Scratch memory for one tick. Large: allocate it with the session, not in the tick.
struct StepScratch {
  std::array<solver::Primitive, most_primitives> primitives;
  std::array<std::uint8_t, most_primitives> mode_of;
  std::array<Vec3, most_primitives> shares;
  Stopwatch watch;
  StepTimes times;  ///< of the last step
};

/// The last sub-step of a tick; sub_steps, halts and capped count over all of its sub-steps. Vectors are in the
/// device's frame. The spans point into the scratch and hold until the next step.
struct StepResult {
  Vec3 proxy_m{0};
  Vec3 force_n{0};   ///< f = -k (probe - proxy), equation (1), before any safety filter; always finite
  Vec3 anchor_m{0};  ///< the place of all co-located primitives
  std::span<const solver::Primitive> primitives;
  std::span<const Vec3> shares;  ///< N: each primitive's force on the proxy
  /// For each primitive, the index of its mode in the scene; plus of_scene_left for the scene that is being left.
  std::span<const std::uint8_t> mode_of;
  io::Sample sample;                 ///< the sample at the old proxy: only the plan's fields
  HoldState hold = HoldState::none;  ///< how the surfaces hold the proxy
  /// solved; capped: the best answer, with its true bound; refused or unsuitable: a fault. Proxy and force are then
  /// those of the last good tick, and the safety filter brings the force to zero.
  solver::Outcome outcome = solver::Outcome::solved;
  const solver::SolverType* solver = nullptr;  ///< of the last sub-step; null if none found the answer
  int iterations = 0;                          ///< of the solver
  double error_bound = 0;                      ///< m
  int sub_steps = 1;                           ///< of the probe
  int halts = 0;                               ///< of the proxy
  int capped = 0;                              ///< sub-steps that hit a solver's cap
};

/// A scene with its data.
struct SceneOnData {
  const Plan* plan = nullptr;
  const io::FieldSource* source = nullptr;
};

/// A change of scene, scan, time frame or workspace that is in progress. Old and new both act. Each is sampled once a
/// sub-step at the proxy; their strengths are weighted by (1 - part) and part; stiffness and workspace are
/// interpolated. So the force follows the ramp without a step, and the proxy moves with the data.
struct SceneChange {
  SceneOnData from;
  SceneOnData to;
  double part = 0;  ///< 0 to 1, never less than in the previous tick; after 1 the next tick steps `to` alone
};

/// In the tick: does not allocate, lock, log or throw. A probe that is not finite is refused (outcome), and touch does
/// not change.
StepResult step(const Plan& plan, const io::FieldSource& source, const Vec3& probe_m, Touch& touch,
                solver::Chain& chain, StepScratch& scratch) noexcept;

/// A tick during a change. Changes do not overlap: the next one begins when this one has ended. The chain must hold the
/// exact solver, because two scenes together can need it when neither does alone.
StepResult step(const SceneChange& change, const Vec3& probe_m, Touch& touch, solver::Chain& chain,
                StepScratch& scratch) noexcept;

}  // namespace palpate::modes
