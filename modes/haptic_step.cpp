#include "palpate/modes/haptic_step.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "palpate/modes/plan.h"
#include "palpate/solver/chain.h"

namespace palpate::modes {
namespace {

// Farther than rounding moves a proxy off a plane that holds it, and nearer than anything that a hand could feel:
// within it a contact keeps its iso-value.
constexpr double contact_tolerance_m = 1e-12;

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Sub-steps of a frame, from the probe's travel alone.
int count_sub_steps(const Plan& plan, double travel_mm) {
  const double wanted = std::ceil(travel_mm / plan.subdivision.step_mm);
  return static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(plan.subdivision.most)));
}

/// How the surfaces of a frame hold its proxy: held on one of them goes before yielding through another.
Hold hold_of(const StepResult& result, const Plan& plan, const Vec3& proxy_m) {
  Hold hold = Hold::none;
  for (std::size_t i = 0; i < result.primitives.size(); ++i) {
    const solver::Primitive& primitive = result.primitives[i];
    if (plan.modes[result.mode_of[i]].holds && primitive.type == solver::PrimitiveType::plane) {
      const double distance = glm::dot(proxy_m - primitive.position, primitive.direction);
      if (std::abs(distance) <= contact_tolerance_m) {
        return Hold::held;
      }
      hold = distance < 0 ? Hold::yielding : std::max(hold, Hold::lifted);
    }
  }
  return hold;
}

/// One sample, placement and solution at a probe position.
StepResult sub_step(const Plan& plan, const io::FieldSource& source, const Vec3& probe_m, Touch& touch,
                    solver::Chain& chain, StepScratch& scratch) {
  StepResult result;
  const Vec3 place_mm = plan.workspace.to_patient(touch.proxy_m);
  result.sample = source.sample(place_mm, plan.fields);
  result.anchor_m = touch.proxy_m;
  io::Sample felt = result.sample;
  if (plan.holds_iso_surface && felt.inside) {
    follow_level(felt, place_mm, touch.contact);
    const Vec3 step_mm = anchor_step_mm(touch.contact);
    felt.value = level_at_anchor(touch.contact, step_mm);
    result.anchor_m += plan.workspace.direction_to_device(step_mm) / plan.workspace.mm_per_m;
  }

  PrimitiveList list(scratch.primitives, scratch.mode_of);
  const Place place{felt, plan.workspace, result.anchor_m};
  for (std::size_t i = 0; i < plan.modes.size(); ++i) {
    const ActiveMode& mode = plan.modes[i];
    if (result.sample.inside || !mode.co_located) {
      list.set_mode(static_cast<std::uint8_t>(i));
      mode.type->place(mode, place, list);
    }
  }
  result.primitives = std::span(scratch.primitives).first(list.size());
  result.mode_of = std::span(scratch.mode_of).first(list.size());
  const auto shares = std::span(scratch.shares).first(list.size());
  result.shares = shares;

  const solver::Balance balance{.stiffness = plan.stiffness_n_per_m,
                                .probe = probe_m,
                                .previous_proxy = touch.proxy_m,
                                .primitives = result.primitives};
  const solver::Solution solution = chain.solve(balance, shares);
  result.outcome = solution.outcome;
  result.solver = solution.solver;
  result.iterations = solution.iterations;
  result.error_bound = solution.error_bound;
  const bool usable = (solution.outcome == solver::Outcome::solved || solution.outcome == solver::Outcome::capped) &&
                      is_finite(solution.proxy) && is_finite(solver::coupling_force(balance, solution.proxy));
  if (!usable) {
    if (solution.outcome == solver::Outcome::solved || solution.outcome == solver::Outcome::capped) {
      result.outcome = solver::Outcome::unsuitable;
    }
    return result;
  }
  result.hold = touch.contact.hold = hold_of(result, plan, solution.proxy);
  touch.proxy_m = solution.proxy;
  touch.probe_m = probe_m;
  touch.force_n = solver::coupling_force(balance, solution.proxy);
  return result;
}

/// Solver's indices of modes are the plan's; a reader's are the scene's.
void name_scene_modes(const Plan& plan, std::span<std::uint8_t> mode_of) {
  for (std::uint8_t& mode : mode_of) {
    mode = static_cast<std::uint8_t>(plan.modes[mode].scene_index);
  }
}

}  // namespace

StepResult step(const Plan& plan, const io::FieldSource& source, const Vec3& probe_m, Touch& touch,
                solver::Chain& chain, StepScratch& scratch) noexcept {
  StepResult result;
  if (!is_finite(probe_m)) {
    result.outcome = solver::Outcome::refused;
    result.proxy_m = touch.proxy_m;
    result.force_n = touch.force_n;
    return result;
  }
  if (!touch.started) {
    touch = Touch{.started = true, .probe_m = probe_m, .proxy_m = probe_m, .contact = {}};
  }
  const Vec3 from = touch.probe_m;
  const int sub_steps = count_sub_steps(plan, glm::length(probe_m - from) * plan.workspace.mm_per_m);
  int capped = 0;
  for (int i = 1; i <= sub_steps; ++i) {
    const Vec3 probe = i == sub_steps ? probe_m : from + (probe_m - from) * (static_cast<double>(i) / sub_steps);
    result = sub_step(plan, source, probe, touch, chain, scratch);
    capped += result.outcome == solver::Outcome::capped ? 1 : 0;
    if (result.outcome == solver::Outcome::refused || result.outcome == solver::Outcome::unsuitable) {
      break;
    }
  }
  name_scene_modes(plan, std::span(scratch.mode_of).first(result.mode_of.size()));
  result.proxy_m = touch.proxy_m;
  result.force_n = touch.force_n;
  result.sub_steps = sub_steps;
  result.capped = capped;
  return result;
}

}  // namespace palpate::modes
