#include "plugin/bench/bench_solvers.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/fresh_folder.h"
#include "io/quantile.h"
#include "plugin/bench/solver_entrants.h"
#include "plugin/bench/whole_tick_study.h"
#include "plugin/report/chart.h"
#include "plugin/report/text_file.h"
#include "solver/certify.h"
#include "solver/testing/reference.h"

namespace palpate::plugin {
namespace {

using solver::Family;
using solver::Outcome;
using solver::Problem;
using solver::Vec3;

struct SolversArguments {
  int cases = 300;
  std::string output;
};

/// The result of one solver for one balance.
struct Result {
  Outcome outcome = Outcome::unsuitable;
  Vec3 proxy{0};
  double bound = std::numeric_limits<double>::infinity();  // m: certified afterwards, for each solver
  double error = std::numeric_limits<double>::infinity();  // m: against the reference
  double microseconds = 0;

  bool answered() const { return outcome == Outcome::solved || outcome == Outcome::capped; }
};

/// A solver over all balances of a family.
struct FamilySummary {
  Family family = Family::allowed;
  std::string solver;
  std::size_t solved = 0, capped = 0, declined = 0;
  double bound_median = 0, bound_worst = 0, error_median = 0, error_worst = 0;  // m
  std::size_t known = 0;                                 // balances whose reference is good enough
  double time_median = 0, time_p99 = 0, time_worst = 0;  // us
};

Result run_once(const Entrant& entrant, const Problem& problem) {
  constexpr int runs = 5;  // the fastest counts: what else the machine did is not the solver's
  Result result;
  result.microseconds = std::numeric_limits<double>::infinity();
  const solver::Balance balance = problem.balance();
  std::vector<Vec3> forces(problem.primitives.size(), Vec3(0));
  for (int i = 0; i < runs; ++i) {
    entrant.prepare(problem, forces);
    const auto start = std::chrono::steady_clock::now();
    const solver::Solution solution = entrant.solve(balance, forces);
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
    result.microseconds = std::min(result.microseconds, time.count());
    result.outcome = solution.outcome;
    result.proxy = solution.proxy;
  }
  if (result.answered()) result.bound = certify(balance, result.proxy, forces).error_bound;
  return result;
}

FamilySummary summarize(Family family, const std::string& name, const std::vector<Result>& results) {
  FamilySummary summary{.family = family, .solver = name};
  std::vector<double> bounds, errors, times;
  for (const Result& result : results) {
    summary.solved += result.outcome == Outcome::solved;
    summary.capped += result.outcome == Outcome::capped;
    if (!result.answered()) {
      ++summary.declined;
      continue;
    }
    bounds.push_back(result.bound);
    if (std::isfinite(result.error)) errors.push_back(result.error);
    times.push_back(result.microseconds);
  }
  summary.bound_median = io::quantile(bounds, 0.5);
  summary.bound_worst = io::quantile(bounds, 1);
  summary.known = errors.size();
  summary.error_median = io::quantile(errors, 0.5);
  summary.error_worst = io::quantile(errors, 1);
  summary.time_median = io::quantile(times, 0.5);
  summary.time_p99 = io::quantile(times, 0.99);
  summary.time_worst = io::quantile(times, 1);
  return summary;
}

std::vector<FamilySummary> run_family(Family family, const std::vector<Entrant>& entrants, int cases) {
  std::vector<std::vector<Result>> results(entrants.size());
  for (int seed = 0; seed < cases; ++seed) {
    const Problem problem = solver::make_problem(family, static_cast<std::uint64_t>(seed));
    const solver::Balance balance = problem.balance();
    const solver::Reference reference = solve_reference(balance);
    for (std::size_t e = 0; e < entrants.size(); ++e) {
      Result result = run_once(entrants[e], problem);
      // A reference with a larger error than the exact solver promises cannot judge it.
      const double promise = promised_accuracy(balance, result.proxy, {});
      if (reference.radius < 0.1 * promise) result.error = distance_to(reference, balance, result.proxy);
      results[e].push_back(result);
    }
  }
  std::vector<FamilySummary> summaries;
  for (std::size_t e = 0; e < entrants.size(); ++e) {
    summaries.push_back(summarize(family, entrants[e].name, results[e]));
  }
  return summaries;
}

void print(const std::vector<FamilySummary>& summaries) {
  fmt::print("\n{}: m and us\n{:<18}{:>7}{:>7}{:>9}{:>7}{:>11}{:>11}{:>11}{:>11}{:>10}{:>10}{:>10}\n",
             name_of(summaries.front().family), "", "solved", "capped", "declined", "known", "error med", "worst",
             "bound med", "worst", "time med", "p99", "worst");
  for (const FamilySummary& s : summaries) {
    fmt::print("{:<18}{:>7}{:>7}{:>9}", s.solver, s.solved, s.capped, s.declined);
    if (s.solved + s.capped > 0) {
      fmt::print("{:>7}{:>11.1e}{:>11.1e}{:>11.1e}{:>11.1e}{:>10.2f}{:>10.2f}{:>10.2f}", s.known, s.error_median,
                 s.error_worst, s.bound_median, s.bound_worst, s.time_median, s.time_p99, s.time_worst);
    }
    fmt::print("\n");
  }
}

std::string csv_of(const std::vector<FamilySummary>& summaries) {
  std::string text =
      "family,solver,solved,capped,declined,known,error_median_m,error_worst_m,bound_median_m,bound_worst_m,"
      "time_median_us,time_p99_us,time_worst_us\n";
  for (const FamilySummary& s : summaries) {
    text += fmt::format("{},{},{},{},{},{}", name_of(s.family), s.solver, s.solved, s.capped, s.declined, s.known);
    text += s.solved + s.capped == 0
                ? ",,,,,,,\n"
                : fmt::format(",{:.3e},{:.3e},{:.3e},{:.3e},{:.4f},{:.4f},{:.4f}\n", s.error_median, s.error_worst,
                              s.bound_median, s.bound_worst, s.time_median, s.time_p99, s.time_worst);
  }
  return text;
}

/// One point for each family: median time against the largest error.
void draw(const std::vector<FamilySummary>& summaries, const std::vector<Entrant>& entrants,
          const std::filesystem::path& path) {
  constexpr Color palette[] = {colors::black,  colors::green,  colors::sky, colors::vermilion,
                               colors::orange, colors::purple, colors::blue};
  constexpr double floor = 1e-18;  // m: where an error of nothing is drawn
  Chart chart{.x = {.label = "median time (us); a point is a family of balances", .logarithmic = true},
              .y = {.label = "largest error against 128 bits (m)", .logarithmic = true}};
  for (std::size_t e = 0; e < entrants.size(); ++e) {
    Curve curve{
        .label = entrants[e].name, .color = palette[e % std::size(palette)], .style = Curve::Style::points, .width = 4};
    for (const FamilySummary& s : summaries) {
      // The errors of stiff and far come from their data: an ulp of 1e6 m, and of 1e12 N at 1e-3 N/m.
      if (s.solver != entrants[e].name || s.known == 0 || s.family == Family::stiff || s.family == Family::far_away) {
        continue;
      }
      curve.x.push_back(s.time_median);
      curve.y.push_back(std::max(s.error_worst, floor));
    }
    chart.curves.push_back(std::move(curve));
  }
  write_png(chart, path, 960, 640);
}

/// Median time of the exact solver against the number of primitives.
void run_counts(const std::vector<Entrant>& entrants, const std::filesystem::path& folder) {
  constexpr std::size_t counts[] = {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};
  fmt::print("\nany number of primitives, spread: median us\n{:<12}", "primitives");
  std::string csv = "primitives";
  std::vector<Curve> curves;
  for (const Entrant& entrant : entrants) {
    if (!entrant.scales) continue;
    fmt::print("{:>14}", entrant.name);
    csv += "," + entrant.name + "_us";
    curves.push_back({.label = entrant.name, .color = curves.empty() ? colors::green : colors::sky});
  }
  for (const std::size_t count : counts) {
    fmt::print("\n{:<12}", count);
    csv += fmt::format("\n{}", count);
    std::size_t column = 0;
    for (const Entrant& entrant : entrants) {
      if (!entrant.scales) continue;
      std::vector<double> times;
      for (std::uint64_t seed = 0; seed < (count > 500 ? 8 : 40); ++seed) {
        times.push_back(run_once(entrant, make_problem(Family::many, seed, count)).microseconds);
      }
      const double median = io::quantile(times, 0.5);
      fmt::print("{:>14.2f}", median);
      csv += fmt::format(",{:.4f}", median);
      curves[column].x.push_back(static_cast<double>(count));
      curves[column++].y.push_back(median);
    }
  }
  fmt::print("\n");
  if (folder.empty()) return;
  write_text(folder / "counts.csv", csv + "\n");
  write_png(Chart{.x = {.label = "primitives", .logarithmic = true},
                  .y = {.label = "median time (us)", .logarithmic = true},
                  .curves = std::move(curves)},
            folder / "counts.png", 960, 480);
}

/// The paper's Table 1 and ours: mean time, and the residual of equation (7) over k in free balance.
void run_wind_tunnel(const std::vector<Entrant>& entrants, const std::filesystem::path& folder) {
  fmt::print(
      "\nwind tunnel, 4000 ticks (the paper, in 2007: numerical 71 us and 38.0e-6 m, analytical 11 us and "
      "10.7e-14 m)\n{:<26}{:<18}{:>10}{:>10}{:>7}{:>15}{:>15}\n",
      "scene", "solver", "declined", "mean us", "free", "mean residual", "largest (m)");
  std::string csv = "scene,solver,declined,time_mean_us,ticks_in_free_balance,residual_mean_m,residual_largest_m\n";
  for (const bool surface : {false, true}) {
    const char* scene = surface ? "follow + force + surface" : "follow + force";
    for (const Entrant& entrant : entrants) {
      const WindTunnelResult r = walk_through_wind_tunnel(entrant, surface, 4000);
      fmt::print("{:<26}{:<18}{:>10}{:>10.3f}{:>7}{:>15.2e}{:>15.2e}\n", scene, entrant.name, r.declined, r.mean_us,
                 r.free, r.mean_residual_m, r.largest_residual_m);
      csv += fmt::format("{},{},{},{:.4f},{},{:.3e},{:.3e}\n", scene, entrant.name, r.declined, r.mean_us, r.free,
                         r.mean_residual_m, r.largest_residual_m);
    }
  }
  if (!folder.empty()) write_text(folder / "wind-tunnel.csv", csv);
}

void run_all(const SolversArguments& arguments, const std::filesystem::path& folder) {
  const std::vector<Entrant> entrants = solver_entrants();
  std::vector<FamilySummary> all;
  for (const Family family : solver::all_families) {
    if (family == Family::many) continue;  // descent would take minutes: see the numbers below
    const std::vector<FamilySummary> summaries = run_family(family, entrants, arguments.cases);
    print(summaries);
    all.insert(all.end(), summaries.begin(), summaries.end());
  }
  run_counts(entrants, folder);
  run_wind_tunnel(entrants, folder);
  run_whole_tick(folder);
  if (folder.empty()) return;
  write_text(folder / "solvers.csv", csv_of(all));
  draw(all, entrants, folder / "error-time.png");
}

}  // namespace

void add_bench_solvers(CLI::App& bench) {
  const auto arguments = std::make_shared<SolversArguments>();
  CLI::App* command =
      bench.add_subcommand("solvers", "Error and run time of every solver on every family of balances.");
  command->add_option("--cases", arguments->cases, "balances of each family")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "also write CSV and pictures to this new or empty folder");
  command->callback([arguments] {
    io::write_all_or_none(arguments->output, [&](const std::filesystem::path& folder) { run_all(*arguments, folder); });
  });
}

}  // namespace palpate::plugin
