#include "palpate/plugin/bench_solvers.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "palpate/plugin/chart.h"
#include "palpate/plugin/solver_entrants.h"
#include "palpate/solver/certify.h"
#include "palpate/testdata/fresh_folder.h"

namespace palpate::plugin {
namespace {

using solver::Family;
using solver::Outcome;
using solver::Problem;
using solver::Vec3;

struct SolversArguments {
  int cases = 1000;
  std::string output;
};

/// What one solver did with one balance.
struct Result {
  Outcome outcome = Outcome::unsuitable;
  Vec3 proxy{0};
  double bound = std::numeric_limits<double>::infinity();  // m: certified afterwards, whoever solved
  double error = std::numeric_limits<double>::infinity();  // m: at most; by way of the answer with the least bound
  double microseconds = 0;

  bool answered() const { return outcome == Outcome::solved || outcome == Outcome::capped; }
};

/// A solver over all balances of a family.
struct Summary {
  Family family = Family::allowed;
  std::string solver;
  std::size_t solved = 0, capped = 0, declined = 0;
  double bound_median = 0, bound_worst = 0, error_median = 0, error_worst = 0;  // m
  double reference = 0;                                  // m: the worst bound of the best answers
  double time_median = 0, time_p99 = 0, time_worst = 0;  // us
};

Result run_once(const Entrant& entrant, const Problem& problem) {
  using Clock = std::chrono::steady_clock;
  constexpr int runs = 3;  // the fastest counts: what else the machine did is not the solver's
  Result result;
  result.microseconds = std::numeric_limits<double>::infinity();
  const solver::Balance balance = problem.balance();
  std::vector<Vec3> forces(problem.primitives.size(), Vec3(0));
  for (int i = 0; i < runs; ++i) {
    entrant.prepare(problem, forces);
    const auto start = Clock::now();
    const solver::Solution solution = entrant.solve(balance, forces);
    const std::chrono::duration<double, std::micro> time = Clock::now() - start;
    result.microseconds = std::min(result.microseconds, time.count());
    result.outcome = solution.outcome;
    result.proxy = solution.proxy;
  }
  if (result.answered()) result.bound = certify(balance, result.proxy, forces).error_bound;
  return result;
}

/// Value at a fraction of the sorted values; 0 of none.
double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

Summary summarise(Family family, const std::string& name, const std::vector<Result>& results, double reference) {
  Summary summary{.family = family, .solver = name, .reference = reference};
  std::vector<double> bounds, errors, times;
  for (const Result& result : results) {
    summary.solved += result.outcome == Outcome::solved;
    summary.capped += result.outcome == Outcome::capped;
    if (!result.answered()) {
      ++summary.declined;
      continue;
    }
    bounds.push_back(result.bound);
    errors.push_back(result.error);
    times.push_back(result.microseconds);
  }
  summary.bound_median = quantile(bounds, 0.5);
  summary.bound_worst = quantile(bounds, 1);
  summary.error_median = quantile(errors, 0.5);
  summary.error_worst = quantile(errors, 1);
  summary.time_median = quantile(times, 0.5);
  summary.time_p99 = quantile(times, 0.99);
  summary.time_worst = quantile(times, 1);
  return summary;
}

std::vector<Summary> run_family(Family family, const std::vector<Entrant>& entrants, int cases) {
  std::vector<std::vector<Result>> results(entrants.size());
  double reference = 0;
  for (int seed = 0; seed < cases; ++seed) {
    const Problem problem = solver::make_problem(family, static_cast<std::uint64_t>(seed));
    Result best;
    for (std::size_t e = 0; e < entrants.size(); ++e) {
      results[e].push_back(run_once(entrants[e], problem));
      if (results[e].back().bound < best.bound) best = results[e].back();
    }
    reference = std::max(reference, best.bound);
    // Certified, though nobody's forces but the best answer's need be good.
    for (auto& of_solver : results) {
      Result& result = of_solver.back();
      result.error = std::min(result.bound, glm::distance(result.proxy, best.proxy) + best.bound);
    }
  }
  std::vector<Summary> summaries;
  for (std::size_t e = 0; e < entrants.size(); ++e) {
    summaries.push_back(summarise(family, entrants[e].name, results[e], reference));
  }
  return summaries;
}

void print(const std::vector<Summary>& summaries) {
  const Summary& first = summaries.front();
  fmt::print("\n{}: certified errors (m); the best answers are within {:.1e} m\n", name_of(first.family),
             first.reference);
  fmt::print("{:<18}{:>7}{:>7}{:>9}{:>11}{:>11}{:>11}{:>11}{:>10}{:>10}{:>10}\n", "", "solved", "capped", "declined",
             "bound med", "worst", "error med", "worst", "us med", "p99", "worst");
  for (const Summary& s : summaries) {
    fmt::print("{:<18}{:>7}{:>7}{:>9}", s.solver, s.solved, s.capped, s.declined);
    if (s.solved + s.capped > 0) {
      fmt::print("{:>11.1e}{:>11.1e}{:>11.1e}{:>11.1e}{:>10.2f}{:>10.2f}{:>10.2f}", s.bound_median, s.bound_worst,
                 s.error_median, s.error_worst, s.time_median, s.time_p99, s.time_worst);
    }
    fmt::print("\n");
  }
}

void write_csv(const std::vector<Summary>& summaries, const std::filesystem::path& path) {
  std::ofstream file(path);
  file << "family,solver,solved,capped,declined,bound_median_m,bound_worst_m,error_median_m,error_worst_m,"
          "reference_bound_m,time_median_us,time_p99_us,time_worst_us\n";
  for (const Summary& s : summaries) {
    file << fmt::format("{},{},{},{},{},", name_of(s.family), s.solver, s.solved, s.capped, s.declined);
    if (s.solved + s.capped > 0) {
      file << fmt::format("{:.3e},{:.3e},{:.3e},{:.3e},{:.3e},{:.4f},{:.4f},{:.4f}\n", s.bound_median, s.bound_worst,
                          s.error_median, s.error_worst, s.reference, s.time_median, s.time_p99, s.time_worst);
    } else {
      file << ",,,,,,,\n";
    }
  }
  if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

/// One point for each family whose exact answers are known: median time against the largest error.
void draw(const std::vector<Summary>& summaries, const std::vector<Entrant>& entrants,
          const std::filesystem::path& path) {
  constexpr Colour palette[] = {colours::black,  colours::green,  colours::sky, colours::vermilion,
                                colours::orange, colours::purple, colours::blue};
  constexpr double known = 1e-6;   // m: a family whose best answers are less certain says nothing of the solvers
  constexpr double floor = 1e-18;  // m: where an error of nothing is drawn
  Chart chart{.x = {.label = "median time (us); a point is a family of balances", .logarithmic = true},
              .y = {.label = "largest certified error (m)", .logarithmic = true}};
  for (std::size_t e = 0; e < entrants.size(); ++e) {
    Curve curve{.label = entrants[e].name,
                .colour = palette[e % std::size(palette)],
                .style = Curve::Style::points,
                .width = 4};
    for (const Summary& s : summaries) {
      if (s.solver != entrants[e].name || s.solved + s.capped == 0 || !(s.reference < known)) continue;
      curve.x.push_back(s.time_median);
      curve.y.push_back(std::max(s.error_worst, floor));
    }
    chart.curves.push_back(std::move(curve));
  }
  write_png(chart, path, 960, 640);
}

void run_all(const SolversArguments& arguments, const std::filesystem::path& folder) {
  const std::vector<Entrant> entrants = solver_entrants();
  std::vector<Summary> all;
  for (const Family family : solver::all_families) {
    const std::vector<Summary> summaries = run_family(family, entrants, arguments.cases);
    print(summaries);
    all.insert(all.end(), summaries.begin(), summaries.end());
  }
  if (folder.empty()) return;
  write_csv(all, folder / "solvers.csv");
  draw(all, entrants, folder / "error-time.png");
}

void run(const SolversArguments& arguments) {
  if (arguments.output.empty()) {
    run_all(arguments, {});
    return;
  }
  testdata::FreshFolder folder(arguments.output);
  run_all(arguments, folder.path());
  folder.commit();
}

}  // namespace

void add_bench_solvers(CLI::App& bench) {
  const auto arguments = std::make_shared<SolversArguments>();
  CLI::App* command = bench.add_subcommand("solvers", "Every solver on every family of balances: error and run time.");
  command->add_option("--cases", arguments->cases, "balances of each family")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "also write CSV and a picture to this folder; new or empty");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace palpate::plugin
