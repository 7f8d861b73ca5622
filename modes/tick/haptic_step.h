#pragma once

/// One headless haptic frame: probe position in; proxy, coupling force and everything a recording keeps out. The
/// session calls exactly this every tick; so do the command line, the studies and the tests.
///
/// A frame (Palmerius 2007, section 2.2): sample the fields once at the proxy of the previous frame; let every mode of
/// the plan place its primitives there; solve the force balance; what results is the new proxy. If the probe has
/// travelled more than Subdivision::step_mm, the frame is cut into sub-steps at evenly spaced probe positions, each
/// sampled, placed and solved in full; their number comes from the travel alone, never from the clock, so that a
/// session can be replayed.
///
/// The proxy can jump where the probe does not: when a surface yields it is up to s / k from the probe, 2.5 mm for
/// 1 N at 400 N/m, and would pass a thin tissue, or the edge of the next one, in one frame. So a sub-step that would
/// carry it farther than Subdivision::proxy_step_mm halts it on the way, and is sampled, placed and solved again there,
/// at the same probe position; the last halt of a frame (most_halts) lets it go. Every frame still ends in a balance
/// that is solved in full, and where no surface yields there is no halt.

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
#include "solver/solution.h"

namespace palpate::solver {
class Chain;
}

namespace palpate::modes {

struct Plan;

/// The most primitives of a frame: every mode of a scene on both sides, and once more while a change of scene is ramped
/// in.
inline constexpr std::size_t most_primitives = 2 * Scene::most_modes * PrimitiveList::most_of_a_mode;

/// Marks, in StepResult::mode_of, primitives of a scene that is being left.
inline constexpr std::uint8_t of_scene_left = 0x80;

/// What one frame hands to the next. Value-initialized: nothing has been touched, and the next frame starts in free
/// space.
struct Touch {
  bool started = false;
  Vec3 probe_m{0};  ///< device's frame, of the last good frame
  Vec3 proxy_m{0};
  Vec3 force_n{0};
  HeldSurfaces contact;   ///< with the surfaces that hold the proxy
  Workspace workspace;    ///< of the last frame: the proxy stays where it is in the patient when this changes
  bool changing = false;  ///< whether the last frame was one of a change
  HeldSurfaces leaving;   ///< contact with the scene that is being left
};

/// Room for one frame. Large: allocate it with the session, not in the tick.
struct StepScratch {
  std::array<solver::Primitive, most_primitives> primitives;
  std::array<std::uint8_t, most_primitives> mode_of;
  std::array<Vec3, most_primitives> shares;
  Stopwatch watch;
  StepTimes times;  ///< of the last step
};

/// Of the last sub-step, but for sub_steps, halts and capped, which count over all of them. Vectors in the device's
/// frame. Spans view the scratch: good until the next step.
struct StepResult {
  Vec3 proxy_m{0};
  Vec3 force_n{0};   ///< f = -k (probe - proxy), equation (1), before any safety filter; always finite
  Vec3 anchor_m{0};  ///< where all co-located primitives stood
  std::span<const solver::Primitive> primitives;
  std::span<const Vec3> shares;  ///< N: each primitive's force on the proxy
  /// For each primitive, its index in the scene's modes; plus of_scene_left where it is one of the scene being left.
  std::span<const std::uint8_t> mode_of;
  io::Sample sample;                 ///< what was sampled, at the old proxy: only the plan's fields
  HoldState hold = HoldState::none;  ///< how the surfaces hold the proxy
  /// solved; capped: the best answer, with its true bound; refused or unsuitable: a fault, whose proxy and force are
  /// those of the last good frame, for the safety filter to bring to zero.
  solver::Outcome outcome = solver::Outcome::solved;
  solver::SolverKind solver = solver::SolverKind::none;
  int iterations = 0;      ///< of the solver
  double error_bound = 0;  ///< m
  int sub_steps = 1;       ///< of the probe
  int halts = 0;           ///< of the proxy
  int capped = 0;          ///< sub-steps that hit a solver's cap
};

/// A scene on its data.
struct SceneOnData {
  const Plan* plan = nullptr;
  const io::FieldSource* source = nullptr;
};

/// A change of scene, scan, time frame or workspace on its way. Both sceneries act, each sampled once a sub-step at the
/// proxy, with their strengths weighted (1 - part) and part; stiffness and workspace go from one to the other. So
/// whatever the change, the force follows the ramp and never steps, and the proxy moves with the data.
struct SceneChange {
  SceneOnData from;
  SceneOnData to;
  double part = 0;  ///< 0 to 1, never less than in the frame before; at 1 the next frame steps `to` alone
};

/// In the tick: does not allocate, lock, log or throw. A probe that is not finite is refused (outcome), and touch stays
/// as it was.
StepResult step(const Plan& plan, const io::FieldSource& source, const Vec3& probe_m, Touch& touch,
                solver::Chain& chain, StepScratch& scratch) noexcept;

/// A frame of a change. One change at a time: the next begins when this has ended. The chain has to hold the exact
/// solver, for two scenes together can need it where neither does alone.
StepResult step(const SceneChange& change, const Vec3& probe_m, Touch& touch, solver::Chain& chain,
                StepScratch& scratch) noexcept;

}  // namespace palpate::modes
