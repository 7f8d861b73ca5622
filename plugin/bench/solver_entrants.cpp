#include "plugin/bench/solver_entrants.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

#include "solver/descent.h"
#include "solver/exact.h"
#include "testdata/flow.h"

#ifdef PALPATE_NLOPT
#include <nlopt.h>
#endif

namespace palpate::plugin {
namespace {

using solver::Balance;
using solver::Problem;
using solver::Solution;
using solver::Vec3;
using Forces = std::span<Vec3>;

Entrant descent(std::string name, const solver::DescentOptions& options) {
  return {.name = std::move(name),
          .type = &solver::descent_solver,
          .prepare = [](const Problem&, Forces) {},
          .solve = [options](const Balance& balance, Forces forces) { return solve_descent(balance, options, forces); },
          .is_variant = true};
}

Entrant entrant_of(const solver::SolverType& type, solver::Start start) {
  constexpr std::size_t primitives = 128;
  const std::shared_ptr<solver::Scratch> scratch = type.make_scratch ? type.make_scratch(primitives) : nullptr;
  const auto tick_before = [&type, scratch, start](const Problem& problem, Forces forces) {
    if (start == solver::Start::cold) return;
    constexpr double step = 5e-5;
    Balance before = problem.balance();
    before.probe += glm::normalize(Vec3(1, -2, 0.5)) * step;
    const Solution solution = type.solve(before, forces, scratch.get(), {});
    const bool usable = solution.outcome == solver::Outcome::solved || solution.outcome == solver::Outcome::capped;
    if (!usable) std::fill(forces.begin(), forces.end(), Vec3(0));
  };
  const std::string name(type.name);
  return {.name = !type.reads_forces ? name : name + (start == solver::Start::warm ? " warm" : " cold"),
          .type = &type,
          .prepare = tick_before,
          .solve = [&type, scratch, start](
                       const Balance& balance,
                       Forces forces) { return type.solve(balance, forces, scratch.get(), {.start = start}); },
          .scales = type.solves == solver::Solves::any && !type.reads_previous_proxy,
          .is_variant = start == solver::Start::warm};
}

#ifdef PALPATE_NLOPT

/// E(x), whose minimum the proxy is; J.
double energy(const Balance& balance, const Vec3& x) {
  double sum = balance.stiffness / 2 * glm::dot(x - balance.probe, x - balance.probe);
  for (const solver::Primitive& primitive : balance.primitives) {
    const Vec3 e = primitive.position - x;
    const Vec3& q = primitive.direction;
    switch (primitive.type) {
      case solver::PrimitiveType::directed_force:
        sum -= primitive.strength * glm::dot(q, x - balance.probe);
        break;
      case solver::PrimitiveType::plane:
        sum += primitive.strength * std::max(0.0, glm::dot(q, e));
        break;
      case solver::PrimitiveType::line:
        sum += primitive.strength * glm::length(e - q * glm::dot(q, e));
        break;
      case solver::PrimitiveType::point:
        sum += primitive.strength * glm::length(e);
        break;
    }
  }
  return sum;
}

Solution solve_simplex(nlopt_opt optimizer, const Balance& balance, Forces forces) {
  Solution solution;
  solution.iterations = 0;
  for (const solver::Primitive& primitive : balance.primitives) {
    if (std::isinf(primitive.strength)) return solution;
  }
  const auto function = [](unsigned, const double* x, double*, void* data) {
    return energy(*static_cast<const Balance*>(data), {x[0], x[1], x[2]});
  };
  Balance own = balance;
  nlopt_set_min_objective(optimizer, function, &own);
  const Vec3& start = balance.previous_proxy;
  std::array<double, 3> x{start.x, start.y, start.z};
  double least = 0;
  const nlopt_result result = nlopt_optimize(optimizer, x.data(), &least);
  solution.iterations = nlopt_get_numevals(optimizer);
  solution.proxy = {x[0], x[1], x[2]};
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] = force_on(balance.primitives[i], solution.proxy);
  solution.outcome = result == NLOPT_MAXEVAL_REACHED || result < 0 ? solver::Outcome::capped : solver::Outcome::solved;
  return solution;
}

Entrant simplex() {
  // Steps of 1 mm at first and a tolerance at the last bit, as descent has.
  const std::shared_ptr<nlopt_opt_s> optimizer(nlopt_create(NLOPT_LN_NELDERMEAD, 3), nlopt_destroy);
  nlopt_set_initial_step1(optimizer.get(), 1e-3);
  nlopt_set_xtol_abs1(optimizer.get(), std::numeric_limits<double>::epsilon());
  nlopt_set_maxeval(optimizer.get(), solver::DescentOptions{}.max_iterations);
  return {.name = "Nelder-Mead",
          .prepare = [](const Problem&, Forces) {},
          .solve = [optimizer](const Balance& balance,
                               Forces forces) { return solve_simplex(optimizer.get(), balance, forces); }};
}

#endif

}  // namespace

std::vector<Entrant> solver_entrants() {
  std::vector<Entrant> entrants;
  for (const solver::SolverType* const type : solver::solver_types()) {
    entrants.push_back(entrant_of(*type, solver::Start::cold));
    if (type->reads_forces) entrants.push_back(entrant_of(*type, solver::Start::warm));
  }
  entrants.push_back(descent("descent to 1 um", {.smallest_step = 1e-6}));
  entrants.push_back(descent("descent l x 0.95", {.reduction = 0.95}));
#ifdef PALPATE_NLOPT
  entrants.push_back(simplex());
#endif
  return entrants;
}

std::vector<NamedSolvers> solvers_to_compare() {
  std::vector<NamedSolvers> all{{"", solver::SolverSet::usual()}};
  for (const solver::SolverType* const type : solver::solver_types()) {
    const std::string name(type->name);
    if (type->is_usual) all.front().name += (all.front().name.empty() ? "" : ", ") + name;
    if (type->solves == solver::Solves::any) all.push_back({name, {type}});
  }
  return all;
}

namespace {

/// The primitives at a proxy (m). Strengths in proportion to the speed, and of a surface that yields at 0.8 N.
std::vector<solver::Primitive> place_in_flow(const testdata::FlowSource& flow, const Vec3& proxy, bool surface) {
  constexpr double mm = 1e-3;
  constexpr double force_per_speed = 0.15;   // N s/m
  constexpr double follow_per_speed = 0.25;  // N s/m
  const io::Sample sample = flow.sample(proxy / mm, flow.available());
  const Vec3 velocity = sample.vector;
  const double speed = glm::length(velocity);
  std::vector<solver::Primitive> primitives;
  if (!sample.inside || speed == 0) return primitives;
  primitives.push_back(solver::make_line(follow_per_speed * speed, proxy, velocity / speed));
  primitives.push_back(solver::make_directed_force(force_per_speed * speed, velocity / speed));
  const double slope = glm::length(sample.gradient);
  if (surface && slope > 0) primitives.push_back(solver::make_plane(0.8, proxy, sample.gradient / slope));
  return primitives;
}

/// Whether a constraint holds the proxy: then equation (7) says nothing.
bool is_held(std::span<const solver::Primitive> primitives, const Vec3& proxy) {
  constexpr double near = 1e-6;  // m
  return std::any_of(primitives.begin(), primitives.end(), [&](const solver::Primitive& primitive) {
    const Vec3 e = primitive.position - proxy;
    const double along = glm::dot(e, primitive.direction);
    if (primitive.type == solver::PrimitiveType::plane) return std::abs(along) < near;
    return primitive.type == solver::PrimitiveType::line && glm::length(e - along * primitive.direction) < near;
  });
}

}  // namespace

WindTunnelResult walk_through_wind_tunnel(const Entrant& entrant, bool surface, int ticks) {
  using Clock = std::chrono::steady_clock;
  const testdata::FlowSource flow{testdata::FlowPastSphere{}};
  const Vec3 center{-0.018, 0, 0.020};
  constexpr double reach = 0.012;  // m
  WindTunnelResult result;
  Problem problem{.stiffness = 400, .probe = center, .previous_proxy = center, .primitives = {}};
  double time_us = 0;
  int solved = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    const double t = 0.001 * tick;
    problem.probe = center + reach * Vec3(std::sin(4.1 * t), std::sin(3.3 * t + 1), 0.5 * std::sin(5.3 * t + 2));
    problem.primitives = place_in_flow(flow, problem.previous_proxy, surface);
    std::vector<Vec3> forces(problem.primitives.size(), Vec3(0));
    const solver::Balance balance = problem.balance();
    constexpr int runs = 3;  // the fastest counts: what else the machine did is not the solver's
    double fastest_us = std::numeric_limits<double>::infinity();
    Solution solution;
    for (int run = 0; run < runs; ++run) {
      entrant.prepare(problem, forces);
      const auto start = Clock::now();
      solution = entrant.solve(balance, forces);
      fastest_us = std::min(fastest_us, std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    }
    if (solution.outcome != solver::Outcome::solved && solution.outcome != solver::Outcome::capped) {
      ++result.declined;
      // The walk goes on from where the proxy is.
      solver::ExactScratch scratch;
      problem.previous_proxy = solve_exact(balance, forces, scratch).proxy;
      continue;
    }
    ++solved;
    time_us += fastest_us;
    if (!is_held(problem.primitives, solution.proxy)) {
      const double missing = glm::length(residual(balance, solution.proxy)) / problem.stiffness;
      ++result.free;
      result.mean_residual_m += missing;
      result.largest_residual_m = std::max(result.largest_residual_m, missing);
    }
    problem.previous_proxy = solution.proxy;
  }
  result.mean_us = solved > 0 ? time_us / solved : 0;
  result.mean_residual_m = result.free > 0 ? result.mean_residual_m / static_cast<double>(result.free) : 0;
  return result;
}

}  // namespace palpate::plugin
