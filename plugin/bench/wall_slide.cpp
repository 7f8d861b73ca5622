#include "plugin/bench/wall_slide.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "modes/scene/plan.h"
#include "modes/scene/scene_json.h"
#include "modes/tick/haptic_step.h"
#include "modes/tick/stopwatch.h"
#include "solver/chain.h"

namespace palpate::plugin {
namespace {

using glm::dvec3;

constexpr double wall_depth_mm = 1.5;
constexpr double tick_s = 1e-3;

double radius_of(Wall wall) {
  return wall == Wall::convex ? 25 : 12;
}

}  // namespace

testdata::Phantom phantom_of(Wall wall) {
  return wall == Wall::convex ? testdata::make_sphere(25) : testdata::make_shell(12, 26);
}

modes::Scene wall_scene() {
  return modes::scene_from_json(R"({"version": 1, "modes": [{"type": "surface",
      "strength_n": {"of": "value", "nodes": [[-490, 0], [-470, 3]]}}]})",
                                "wall");
}

Slide slide_on(Wall wall, const io::FieldSource& source, const modes::Scene& scene, double speed_mm_per_s) {
  const modes::Plan plan = modes::make_plan(scene, source.available(), {});
  solver::Chain chain({.solvers = plan.solvers});
  modes::Touch touch;
  const auto scratch = std::make_unique<modes::StepScratch>();
  Slide result;
  double sub_steps = 0;
  const auto move_to = [&](const dvec3& at_mm) {
    const std::uint64_t begun = modes::clock_count();
    const modes::StepResult step = modes::step(plan, source, plan.workspace.to_device(at_mm), touch, chain, *scratch);
    result.ticks_us.push_back(1e-3 * static_cast<double>(modes::clock_count() - begun) / modes::counts_per_ns());
    sub_steps += step.sub_steps + step.halts;
    result.capped += step.capped;
  };
  // Outwards from the wall towards where it pushes.
  const double outward = wall == Wall::convex ? 1 : -1;
  const double pressed = radius_of(wall) - outward * wall_depth_mm;
  const dvec3 a = glm::normalize(dvec3(0.2, 0.5, 0.9));
  const dvec3 b = glm::normalize(glm::cross(a, dvec3(0.7, -0.1, 0.4)));
  for (double away = 5; away > 0; away -= 0.01) move_to((pressed + outward * away) * a);
  move_to(pressed * a);
  const auto proxy_mm = [&] { return plan.workspace.to_patient(touch.proxy_m); };
  const double held = glm::length(proxy_mm());
  const double force_n = plan.stiffness_n_per_m * 1e-3 * std::abs(held - pressed);
  const double angle_step = speed_mm_per_s * tick_s / pressed;
  const auto ticks = static_cast<int>(4 * std::numbers::pi / angle_step);
  const double true_force_n = plan.stiffness_n_per_m * 1e-3 * wall_depth_mm;
  double squares = 0;
  result.ticks_us.clear();
  result.capped = 0;
  sub_steps = 0;
  for (int n = 1; n <= ticks; ++n) {
    const dvec3 normal = std::cos(angle_step * n) * a + std::sin(angle_step * n) * b;
    move_to(pressed * normal);
    const dvec3 force = plan.workspace.direction_to_patient(touch.force_n);
    const double angle = std::atan2(glm::length(glm::cross(force, normal)), outward * glm::dot(force, normal));
    result.worst_deg = std::max(result.worst_deg, angle * 180 / std::numbers::pi);
    const dvec3 off = force - outward * true_force_n * normal;
    squares += glm::dot(off, off);
    result.worst_force_n = std::max(result.worst_force_n, glm::length(force - outward * force_n * normal));
  }
  result.rms_true_n = std::sqrt(squares / std::max(1, ticks));
  result.drift_mm = std::abs(glm::length(proxy_mm()) - held);
  result.sub_steps = sub_steps / std::max(1, ticks);
  return result;
}

}  // namespace palpate::plugin
