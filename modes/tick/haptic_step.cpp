#include "modes/tick/haptic_step.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "modes/scene/plan.h"
#include "solver/chain.h"

namespace palpate::modes {
namespace {

// Farther than rounding moves a proxy off a plane that holds it, and nearer than anything that a hand could feel:
// within it a contact keeps its iso-value.
constexpr double contact_tolerance_m = 1e-12;

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// What a sub-step is taken with: one scene, or two while one replaces the other.
struct SubStepInput {
  SceneOnData to;
  SceneOnData from;  ///< plan null: there is none
  double part = 1;
  Workspace workspace;
  double stiffness = 0;
};

SubStepInput setting_of(const SceneChange& change) {
  const double part = std::clamp(change.part, 0.0, 1.0);
  return {.to = change.to,
          .from = change.from,
          .part = part,
          .workspace = between(change.from.plan->workspace, change.to.plan->workspace, part),
          .stiffness = change.from.plan->stiffness_n_per_m +
                       part * (change.to.plan->stiffness_n_per_m - change.from.plan->stiffness_n_per_m)};
}

/// What one scenery has placed.
struct PlacedScene {
  io::Sample sample;
  Vec3 anchor_m{0};
  std::size_t first = 0, end = 0;  ///< in the list of primitives
};

/// Where the planes of each structure's surface stand. Where the scan itself has no surface all else that is
/// co-located stands there too, so that the analytical solver stays valid.
void hold_structures(const Plan& plan, const Vec3& proxy_m, const Vec3& place_mm, HeldSurfaces& contact,
                     io::Sample& felt, std::span<Vec3> structure_anchor_m, Place& here) {
  const bool alone = !plan.holds_iso_surface || contact.scan.hold == HoldState::none;
  for (std::size_t n = 0; n < plan.structures.size(); ++n) {
    structure_anchor_m[n] = proxy_m;
    if (!plan.holds_structure[n] || !felt.inside) {
      continue;
    }
    HeldSurface& surface = contact.structure[n];
    io::Distance& distance = felt.distance[n];
    follow_level(distance.mm, distance.gradient, place_mm, surface);
    const Vec3 step_mm = anchor_step_mm(surface);
    distance.mm = level_at_anchor(surface, step_mm);
    if (surface.hold != HoldState::held) {
      continue;  // the step is zero: of most structures, in most ticks
    }
    const Vec3 step_m = here.workspace.direction_to_device(step_mm) / here.workspace.mm_per_m;
    structure_anchor_m[n] += step_m;
    if (alone) {
      here.anchor_m += step_m;
    }
  }
}

PlacedScene place(const SceneOnData& scenery, double weight, std::uint8_t mark, const Workspace& workspace,
                  const Vec3& proxy_m, HeldSurfaces& contact, PrimitiveList& list, StepScratch& scratch) {
  const Plan& plan = *scenery.plan;
  const Vec3 place_mm = workspace.to_patient(proxy_m);
  scratch.watch.lap(scratch.times.map);
  PlacedScene placed{
      .sample = scenery.source->sample(place_mm, plan.fields), .anchor_m = proxy_m, .first = list.size()};
  scratch.watch.lap(scratch.times.sample);
  io::Sample felt = placed.sample;
  if (plan.holds_iso_surface && felt.inside) {
    follow_level(felt, place_mm, contact.scan);
    const Vec3 step_mm = anchor_step_mm(contact.scan);
    felt.value = level_at_anchor(contact.scan, step_mm);
    placed.anchor_m += workspace.direction_to_device(step_mm) / workspace.mm_per_m;
  }
  std::array<Vec3, io::most_structures> structure_anchor_m;  // those of the plan's structures are set below
  Place here{felt, workspace, placed.anchor_m, structure_anchor_m};
  hold_structures(plan, proxy_m, place_mm, contact, felt, structure_anchor_m, here);
  placed.anchor_m = here.anchor_m;
  list.set_weight(weight);
  for (std::size_t i = 0; i < plan.modes.size(); ++i) {
    const ActiveMode& mode = plan.modes[i];
    if (felt.inside || !mode.co_located) {
      list.set_mode(static_cast<std::uint8_t>(i | mark));
      mode.type->place(mode, here, list);
    }
  }
  placed.end = list.size();
  scratch.watch.lap(scratch.times.modes);
  return placed;
}

/// How the surfaces of a scenery hold the proxy, of the scan (first) and of each structure.
std::array<HoldState, io::most_structures + 1> holds_of(const PlacedScene& placed, const Plan& plan,
                                                        const StepResult& result, const Vec3& proxy_m) {
  std::array<HoldState, io::most_structures + 1> holds{};
  for (std::size_t i = placed.first; i < placed.end; ++i) {
    const solver::Primitive& primitive = result.primitives[i];
    const ActiveMode& mode = plan.modes[result.mode_of[i] & (of_scene_left - 1U)];
    if (!mode.holds || primitive.type != solver::PrimitiveType::plane) {
      continue;
    }
    const int scan_or_structure = mode.structure + 1;
    HoldState& hold = holds[static_cast<std::size_t>(scan_or_structure)];
    const double distance = glm::dot(proxy_m - primitive.position, primitive.direction);
    const bool is_held = std::abs(distance) <= contact_tolerance_m;
    hold = joined(hold, is_held ? HoldState::held : (distance < 0 ? HoldState::yielding : HoldState::lifted));
  }
  return holds;
}

/// Of the scan's surface and of each structure's; returns how the proxy is held by all of them.
HoldState update_holds(const PlacedScene& placed, const Plan& plan, const StepResult& result, const Vec3& proxy_m,
                       HeldSurfaces& contact) {
  const auto holds = holds_of(placed, plan, result, proxy_m);
  HoldState all = contact.scan.hold = holds[0];
  for (std::size_t n = 0; n < plan.structures.size(); ++n) {
    contact.structure[n].hold = holds[n + 1];
    all = joined(all, holds[n + 1]);
  }
  return all;
}

bool is_answer(solver::Outcome outcome) {
  return outcome == solver::Outcome::solved || outcome == solver::Outcome::capped;
}

/// Solves the balance of the primitives in the result; false, and an outcome that says so, where there is no usable
/// answer.
bool solve(const SubStepInput& setting, const Vec3& probe_m, std::span<Vec3> shares, solver::Chain& chain, Touch& touch,
           StepResult& result) {
  const solver::Balance balance{.stiffness = setting.stiffness,
                                .probe = probe_m,
                                .previous_proxy = touch.proxy_m,
                                .primitives = result.primitives};
  const solver::Solution solution = chain.solve(balance, shares);
  result.shares = shares;
  result.outcome = solution.outcome;
  result.solver = solution.solver;
  result.iterations = solution.iterations;
  result.error_bound = solution.error_bound;
  const Vec3 force = solver::coupling_force(balance, solution.proxy);
  if (is_answer(solution.outcome) && is_finite(solution.proxy) && is_finite(force)) {
    touch.proxy_m = solution.proxy;
    touch.probe_m = probe_m;
    touch.force_n = force;
    return true;
  }
  result.outcome = is_answer(solution.outcome) ? solver::Outcome::unsuitable : solution.outcome;
  return false;
}

/// One sample, placement and solution at a probe position. Writes the result where it stands: a sample holds the
/// distances of all structures, and a tick with halts would copy it a hundred times.
void sub_step(const SubStepInput& setting, const Vec3& probe_m, Touch& touch, solver::Chain& chain,
              StepScratch& scratch, StepResult& result) {
  PrimitiveList list(scratch.primitives, scratch.mode_of);
  const PlacedScene to =
      place(setting.to, setting.part, 0, setting.workspace, touch.proxy_m, touch.contact, list, scratch);
  std::optional<PlacedScene> from;
  if (setting.from.plan != nullptr) {
    from = place(setting.from, 1 - setting.part, of_scene_left, setting.workspace, touch.proxy_m, touch.leaving, list,
                 scratch);
  }
  result.sample = to.sample;
  result.anchor_m = to.anchor_m;
  result.primitives = std::span(scratch.primitives).first(list.size());
  result.mode_of = std::span(scratch.mode_of).first(list.size());
  result.hold = HoldState::none;
  const bool solved = solve(setting, probe_m, std::span(scratch.shares).first(list.size()), chain, touch, result);
  scratch.watch.lap(scratch.times.solve);
  if (solved) {
    result.hold = update_holds(to, *setting.to.plan, result, touch.proxy_m, touch.contact);
    if (from) {
      update_holds(*from, *setting.from.plan, result, touch.proxy_m, touch.leaving);
    }
  }
}

/// Within a step modes are counted as in the plan; the caller counts as in the scene.
void name_scene_modes(const SubStepInput& setting, std::span<std::uint8_t> mode_of) {
  for (std::uint8_t& mode : mode_of) {
    const auto mark = static_cast<std::uint8_t>(mode & of_scene_left);
    const Plan& plan = mark != 0 && setting.from.plan != nullptr ? *setting.from.plan : *setting.to.plan;
    mode = static_cast<std::uint8_t>(plan.modes[mode & (of_scene_left - 1U)].scene_index | mark);
  }
}

/// The proxy stays where it is in the patient.
void follow_workspace(const Workspace& workspace, Touch& touch) {
  if (!(touch.workspace == workspace)) {
    touch.proxy_m = workspace.to_device(touch.workspace.to_patient(touch.proxy_m));
    touch.workspace = workspace;
  }
}

/// Brings a proxy that nothing holds, and that has jumped farther than the step, back to where it has gone that far.
/// The level starts anew there from the scan's value: what the smoothed gradient adds up to along a jump falls behind
/// at a sharp edge, and the next boundary would be felt inside its own.
bool halt(const Vec3& old_proxy_m, double step_m, Touch& touch) {
  const Vec3 jump = touch.proxy_m - old_proxy_m;
  const double length = glm::length(jump);
  if (length <= step_m || touch.contact.is_held() || touch.leaving.is_held()) {
    return false;
  }
  touch.proxy_m = old_proxy_m + jump * (step_m / length);
  touch.contact.release();
  touch.leaving.release();
  return true;
}

StepResult step_setting(const SubStepInput& setting, const Vec3& probe_m, Touch& touch, solver::Chain& chain,
                        StepScratch& scratch) {
  scratch.times = {};
  scratch.watch.start();
  StepResult result;
  if (!is_finite(probe_m)) {
    result.outcome = solver::Outcome::refused;
    result.proxy_m = touch.proxy_m;
    result.force_n = touch.force_n;
    return result;
  }
  if (!touch.started) {
    touch.started = true;
    touch.probe_m = touch.proxy_m = probe_m;
    touch.workspace = setting.workspace;
  }
  follow_workspace(setting.workspace, touch);
  const Vec3 from = touch.probe_m;
  const Subdivision& subdivision = setting.to.plan->subdivision;
  const double travel_mm = glm::length(probe_m - from) * setting.workspace.mm_per_m;
  const double wanted = std::ceil(travel_mm / subdivision.step_mm);
  const int sub_steps = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(subdivision.most)));
  int capped = 0;
  int halts = 0;
  for (int i = 1; i <= sub_steps;) {
    const Vec3 probe = i == sub_steps ? probe_m : from + (probe_m - from) * (static_cast<double>(i) / sub_steps);
    const Vec3 old_proxy = touch.proxy_m;
    sub_step(setting, probe, touch, chain, scratch, result);
    capped += result.outcome == solver::Outcome::capped ? 1 : 0;
    if (!is_answer(result.outcome)) {
      break;
    }
    if (halts < subdivision.most_halts &&
        halt(old_proxy, subdivision.proxy_step_mm / setting.workspace.mm_per_m, touch)) {
      ++halts;
    } else {
      ++i;
    }
  }
  name_scene_modes(setting, std::span(scratch.mode_of).first(result.mode_of.size()));
  scratch.watch.lap(scratch.times.modes);
  result.proxy_m = touch.proxy_m;
  result.force_n = touch.force_n;
  result.sub_steps = sub_steps;
  result.halts = halts;
  result.capped = capped;
  return result;
}

}  // namespace

StepResult step(const Plan& plan, const io::FieldSource& source, const Vec3& probe_m, Touch& touch,
                solver::Chain& chain, StepScratch& scratch) noexcept {
  touch.changing = false;
  const SubStepInput setting{
      .to = {&plan, &source}, .from = {}, .part = 1, .workspace = plan.workspace, .stiffness = plan.stiffness_n_per_m};
  return step_setting(setting, probe_m, touch, chain, scratch);
}

StepResult step(const SceneChange& change, const Vec3& probe_m, Touch& touch, solver::Chain& chain,
                StepScratch& scratch) noexcept {
  if (!touch.changing) {
    touch.changing = true;
    touch.leaving = touch.contact;
    // On the same data the level goes on as it is; on other data there is another surface to be met.
    if (change.from.source != change.to.source) {
      touch.contact = HeldSurfaces{};
    }
  }
  return step_setting(setting_of(change), probe_m, touch, chain, scratch);
}

}  // namespace palpate::modes
