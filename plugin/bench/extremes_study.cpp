#include "plugin/bench/extremes_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugin/bench/solver_entrants.h"
#include "plugin/report/text_file.h"
#include "solver/certify.h"
#include "solver/descent.h"
#include "solver/testing/problems.h"
#include "solver/testing/reference.h"

namespace palpate::plugin {
namespace {

using solver::Family;
using solver::Outcome;
using solver::Primitive;
using solver::PrimitiveType;
using solver::Problem;
using solver::Random;
using solver::Vec3;

constexpr int cases_of_each = 100;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

struct Extreme {
  std::string name;
  std::function<Problem(std::uint64_t seed)> make;
  int cases = cases_of_each;
  bool has_reference = true;
  bool for_descent = true;  ///< it takes hours over thousands of primitives
};

/// A balance of that family, changed.
template <typename Change>
std::function<Problem(std::uint64_t)> changed(Family family, Change change) {
  return [family, change](std::uint64_t seed) {
    Problem problem = solver::make_problem(family, seed);
    change(problem);
    return problem;
  };
}

void for_places(Problem& problem, const std::function<void(Vec3&)>& change) {
  change(problem.probe);
  change(problem.previous_proxy);
  for (Primitive& primitive : problem.primitives) change(primitive.position);
}

/// Two planes through the old proxy, the probe behind both; the second's direction is `turn` of the first's.
Problem two_planes(std::uint64_t seed, const std::function<Vec3(const Vec3&, const Vec3&)>& turn, double gap_m) {
  Random random(seed);
  Problem problem;
  const Vec3 q = random.unit_vector();
  const Vec3 across = glm::normalize(glm::cross(q, random.unit_vector()));
  problem.probe = problem.previous_proxy - random.uniform(0.5e-3, 3e-3) * q + random.uniform(-1e-3, 1e-3) * across;
  problem.primitives.push_back(solver::make_plane(random.uniform(0.1, 2), problem.previous_proxy, q));
  problem.primitives.push_back(
      solver::make_plane(random.uniform(0.1, 2), problem.previous_proxy + gap_m * q, turn(q, across)));
  return problem;
}

Extreme parallel_to_within(double angle) {
  return {fmt::format("planes parallel to within {:.0e}", angle), [angle](std::uint64_t seed) {
            return two_planes(
                seed, [angle](const Vec3& q, const Vec3& across) { return glm::normalize(q + angle * across); }, 0);
          }};
}

Extreme orthogonal_to_within(double angle) {
  return {fmt::format("planes orthogonal to within {:.0e}", angle), [angle](std::uint64_t seed) {
            return two_planes(
                seed, [angle](const Vec3& q, const Vec3& across) { return glm::normalize(across + angle * q); }, 0);
          }};
}

Extreme opposed(const char* name, double gap_m) {
  return {name, [gap_m](std::uint64_t seed) {
            return two_planes(
                seed, [](const Vec3& q, const Vec3&) { return -q; }, gap_m);
          }};
}

Extreme count_of(std::size_t count) {
  Extreme extreme{fmt::format("{} primitives", count), [count](std::uint64_t seed) {
                    Problem problem = solver::make_problem(Family::many, seed, std::max<std::size_t>(count, 1));
                    problem.primitives.resize(count);
                    return problem;
                  }};
  if (count > 10) {
    extreme.cases = count > 100 ? 3 : 20;
    extreme.has_reference = extreme.for_descent = false;
  }
  return extreme;
}

/// Spoils one number of a balance that is fine.
Extreme rubbish(const char* name, const std::function<void(Problem&)>& spoil) {
  return {name, changed(Family::oblique, spoil), 1, false, true};
}

std::vector<Extreme> extremes() {
  const auto scaled = [](double factor) {
    return [factor](Problem& problem) { for_places(problem, [factor](Vec3& place) { place *= factor; }); };
  };
  std::vector<Extreme> all{
      {"k = 1e-3 N/m", changed(Family::oblique, [](Problem& p) { p.stiffness = 1e-3; })},
      {"k = 1e9 N/m", changed(Family::oblique, [](Problem& p) { p.stiffness = 1e9; })},
      {"strengths x 1e12", changed(Family::spread,
                                   [](Problem& p) {
                                     for (Primitive& primitive : p.primitives) {
                                       if (primitive.type != PrimitiveType::directed_force) primitive.strength *= 1e12;
                                     }
                                   })},
      {"strengths of zero", changed(Family::spread,
                                    [](Problem& p) {
                                      for (Primitive& primitive : p.primitives) primitive.strength = 0;
                                    })},
      {"infinite strengths", changed(Family::hard, [](Problem&) {})},
      {"offsets of 1e-300 m", changed(Family::spread, scaled(1e-297))},
      {"offsets of 1e6 m", changed(Family::spread, scaled(1e9))},
      {"scene 1e6 m away",
       changed(Family::spread, [](Problem& p) { for_places(p, [](Vec3& place) { place += Vec3(1e6, -1e6, 1e6); }); })},
      parallel_to_within(1e-16),
      parallel_to_within(1e-9),
      parallel_to_within(1e-3),
      orthogonal_to_within(1e-16),
      orthogonal_to_within(1e-9),
      orthogonal_to_within(1e-3),
      {"directions 1e-15 too long", changed(Family::oblique,
                                            [](Problem& p) {
                                              for (Primitive& primitive : p.primitives) {
                                                primitive.direction *= 1 + 1e-15;
                                              }
                                            })},
      opposed("opposed planes, no gap", 0),
      opposed("opposed planes, pushing apart", -1e-3),
      opposed("opposed planes, pushing together", 1e-3),
      {"probe and old proxy on all of them",
       changed(Family::co_located, [](Problem& p) { p.probe = p.previous_proxy; })},
      {"co-located, up to ten", changed(Family::co_located, [](Problem&) {})},
      {"pull equal to the strength", changed(Family::edge, [](Problem&) {})}};
  for (const std::size_t count : {0, 1, 2, 10, 100, 10000}) all.push_back(count_of(count));
  all.push_back(rubbish("NaN strength", [](Problem& p) { p.primitives[0].strength = not_a_number; }));
  all.push_back(rubbish("infinite position", [](Problem& p) {
    p.primitives[0] = solver::make_plane(1, Vec3(0, infinity, 0), Vec3(0, 1, 0));
  }));
  all.push_back(rubbish("NaN probe", [](Problem& p) { p.probe.z = not_a_number; }));
  all.push_back(rubbish("negative strength", [](Problem& p) { p.primitives[0].strength = -1; }));
  all.push_back(rubbish("zero direction", [](Problem& p) {
    p.primitives[0] = {PrimitiveType::plane, 1, Vec3(0), Vec3(0)};
  }));
  all.push_back(rubbish("k = 0", [](Problem& p) { p.stiffness = 0; }));
  all.push_back(rubbish("k < 0", [](Problem& p) { p.stiffness = -400; }));
  all.push_back(rubbish("hard points 1 mm apart", [](Problem& p) {
    p.primitives = {solver::make_point(infinity, Vec3(0)), solver::make_point(infinity, Vec3(1e-3, 0, 0))};
  }));
  return all;
}

struct Row {
  std::string solver;
  int solved = 0, capped = 0, declined = 0, refused = 0;
  int known = 0;  ///< cases whose reference is certain to a tenth of the exact solver's promise
  double worst_error_m = 0, worst_bound_m = 0;
  int most_iterations = 0;
  std::string refusal;  ///< of the first refused case, in words
};

void count(const solver::Solution& solution, const solver::Reference* reference, const solver::Balance& balance,
           std::span<const Vec3> forces, Row& row) {
  row.most_iterations = std::max(row.most_iterations, solution.iterations);
  row.solved += solution.outcome == Outcome::solved;
  row.capped += solution.outcome == Outcome::capped;
  row.declined += solution.outcome == Outcome::unsuitable;
  if (solution.outcome == Outcome::refused) {
    ++row.refused;
    if (row.refusal.empty() && solution.rejection) row.refusal = describe(*solution.rejection);
  }
  if (solution.outcome != Outcome::solved && solution.outcome != Outcome::capped) return;
  row.worst_bound_m = std::max(row.worst_bound_m, certify(balance, solution.proxy, forces).error_bound);
  if (reference != nullptr && reference->radius < 0.1 * promised_accuracy(balance, solution.proxy, {})) {
    ++row.known;
    row.worst_error_m = std::max(row.worst_error_m, distance_to(*reference, balance, solution.proxy));
  }
}

std::vector<Row> run(const Extreme& extreme, const std::vector<Entrant>& entrants) {
  std::vector<Row> rows;
  rows.reserve(entrants.size());
  for (const Entrant& entrant : entrants) rows.push_back({.solver = entrant.name, .refusal = {}});
  for (int seed = 0; seed < extreme.cases; ++seed) {
    const Problem problem = extreme.make(static_cast<std::uint64_t>(seed));
    const solver::Balance balance = problem.balance();
    if (const auto rejection = validate(balance)) {  // as the chain does, before any solver is asked
      for (Row& row : rows) {
        ++row.refused;
        row.refusal = describe(*rejection);
      }
      continue;
    }
    const solver::Reference reference = extreme.has_reference ? solve_reference(balance) : solver::Reference{};
    for (std::size_t e = 0; e < entrants.size(); ++e) {
      if (entrants[e].type == &solver::descent_solver && !extreme.for_descent) continue;
      std::vector<Vec3> forces(problem.primitives.size(), Vec3(0));
      entrants[e].prepare(problem, forces);
      const solver::Solution solution = entrants[e].solve(balance, forces);
      count(solution, extreme.has_reference ? &reference : nullptr, balance, forces, rows[e]);
    }
  }
  return rows;
}

}  // namespace

void run_extremes(const std::filesystem::path& folder) {
  std::vector<Entrant> entrants;
  for (Entrant& entrant : solver_entrants()) {
    if (entrant.type != nullptr && !entrant.is_variant) {
      entrants.push_back(std::move(entrant));
    }
  }
  fmt::print(
      "(a) Extremes: {} seeded balances of each; error against 128 bits where they are certain, bound certified\n\n"
      "{:<36} {:<11} {:>6} {:>6} {:>8} {:>7} {:>6} {:>10} {:>10} {:>10}\n",
      cases_of_each, "what", "solver", "solved", "capped", "declined", "refused", "known", "error m", "bound m",
      "most iter.");
  std::string csv =
      "what,solver,solved,capped,declined,refused,known,worst_error_m,worst_bound_m,most_iterations,refusal\n";
  for (const Extreme& extreme : extremes()) {
    for (const Row& row : run(extreme, entrants)) {
      if (row.solved + row.capped + row.declined + row.refused == 0) continue;
      const bool answered = row.solved + row.capped > 0;
      fmt::print("{:<36} {:<11} {:>6} {:>6} {:>8} {:>7} {:>6} {:>10} {:>10} {:>10}  {}\n", extreme.name, row.solver,
                 row.solved, row.capped, row.declined, row.refused, row.known,
                 row.known > 0 ? fmt::format("{:.1e}", row.worst_error_m) : "",
                 answered ? fmt::format("{:.1e}", row.worst_bound_m) : "", row.most_iterations, row.refusal);
      csv += fmt::format("\"{}\",{},{},{},{},{},{},{},{},{},\"{}\"\n", extreme.name, row.solver, row.solved, row.capped,
                         row.declined, row.refused, row.known, row.worst_error_m, row.worst_bound_m,
                         row.most_iterations, row.refusal);
    }
  }
  fmt::print("\n");
  if (!folder.empty()) write_text(folder / "extremes.csv", csv);
}

}  // namespace palpate::plugin
