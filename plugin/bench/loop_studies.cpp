#include "plugin/bench/loop_studies.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>

#include "device/safety/stiffness.h"
#include "device/simulated/simulated_stylus.h"
#include "plugin/bench/arms.h"
#include "plugin/bench/creep_study.h"
#include "plugin/bench/hand_study.h"
#include "plugin/report/chart.h"
#include "plugin/report/text_file.h"

namespace palpate::plugin {
namespace {

std::function<void(double)> progress_line(const char* what) {
  if (isatty(STDERR_FILENO) == 0) {
    return [](double) {};
  }
  return [what](double done) { fmt::print(stderr, "\r{} {:3.0f} %{}", what, 100 * done, done < 1 ? "" : "\r\033[K"); };
}

void over_ticks(const LoopStudyOptions& options, const std::filesystem::path& folder) {
  fmt::print("(b) Over ticks: the probe is moved, no device, k = 400 N/m, {} s\n\n", options.seconds);
  fmt::print("{:<13} {:<18} {:>12} {:<7} {:<32} {}\n", "what", "solvers", "value", "unit", "ideal", "how");
  std::string csv = "what,solvers,value,unit,ideal,how\n";
  auto rows = study_creep(options.seconds, progress_line("over ticks"));
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.what < b.what; });
  for (const CreepStudyRow& row : rows) {
    fmt::print("{:<13} {:<18} {:>12.3g} {:<7} {:<32} {}\n", row.what, row.solver, row.value, row.unit, row.ideal,
               row.how);
    csv +=
        fmt::format("{},\"{}\",{},{},\"{}\",\"{}\"\n", row.what, row.solver, row.value, row.unit, row.ideal, row.how);
  }
  if (!folder.empty()) {
    write_text(folder / "ticks.csv", csv);
  }
}

/// N/m: the largest stiffness before the first that was not steady; 0: none.
double steady_up_to(std::span<const HandStudyRow> rows, const HandStudyRow& of, const std::string& hand) {
  double largest = 0;
  for (const HandStudyRow& row : rows) {
    const bool is_of = std::tie(row.scene, row.motion, row.arm, row.solver, row.hand) ==
                       std::tie(of.scene, of.motion, of.arm, of.solver, hand);
    if (is_of && is_steady(row)) largest = std::max(largest, row.stiffness_n_per_m);
  }
  return largest;
}

/// For each solver on each arm: the stiffness in the usual hand, and its range over the other hands. Solvers that are
/// never steady are drawn at `least`.
Chart chart_of(std::span<const HandStudyRow> rows, const HandStudyRow& of, double least, double most) {
  Chart chart{of.scene + ", " + of.motion,
              {"", false, 0.0, static_cast<double>(simulated_arms().size()), false},
              {"steady up to k (N/m)", true, 0.6 * least, 2 * most},
              {},
              {{.at = least, .label = "none", .vertical = false},
               {.at = most, .label = "the largest tried", .vertical = false}}};
  constexpr std::array palette{colors::blue, colors::orange, colors::vermilion};
  std::vector<Curve> points, reaches;
  double at = 0;
  for (const SimulatedArm& arm : simulated_arms()) {
    chart.bands.push_back({at + 0.08, at + 0.92, arm.name, {0.95, 0.95, 0.95}});
    for (std::size_t n = 0; n < hand_study_solvers().size(); ++n) {
      const std::string& solver = hand_study_solvers()[n];
      if (points.size() <= n) {
        points.push_back(
            {.label = solver, .color = palette[n % palette.size()], .style = Curve::Style::points, .width = 4});
      }
      HandStudyRow one = of;
      one.arm = arm.name;
      one.solver = solver;
      const double x = at + 0.3 + 0.2 * static_cast<double>(n);
      std::vector<double> steady;
      for (const SimulatedHand& hand : simulated_hands()) steady.push_back(steady_up_to(rows, one, hand.name));
      const auto [low, high] = std::ranges::minmax(steady);
      reaches.push_back({.label = "",
                         .x = {x, x},
                         .y = {std::max(low, least), std::max(high, least)},
                         .color = palette[n % palette.size()]});
      points[n].x.push_back(x);
      points[n].y.push_back(std::max(steady_up_to(rows, one, "usual"), least));
    }
    ++at;
  }
  chart.curves = std::move(reaches);
  chart.curves.insert(chart.curves.end(), points.begin(), points.end());
  return chart;
}

void in_the_hand(const LoopStudyOptions& options, const std::filesystem::path& folder) {
  const HandStudyOptions hand{.hands = options.hands, .hold_s = options.hold_s};
  const auto rows = study_hand(hand, progress_line("in the hand"));
  fmt::print(
      "\n(c) In the hand: up to which stiffness (N/m) the force is steady: RMS between 30 and 500 Hz below 2 k q, "
      "where q "
      "is the arm's\nposition step; median of {} tremors, the last second of {} s. Tried: {:.0f} to {:.0f} N/m.\n"
      "kept: of the last second, how long the surface held, the least of all rows up to there.\n\n",
      hand.hands, hand.hold_s, hand.stiffness_n_per_m.front(), hand.stiffness_n_per_m.back());
  fmt::print("{:<25} {:<6} {:<10} {:<6}", "scene", "motion", "arm", "hand");
  for (const std::string& solver : hand_study_solvers()) fmt::print(" {:>18}", solver);
  fmt::print(" {:>6} {:>13}\n", "kept", "proxy error m");
  std::string csv =
      "scene,motion,arm,hand,solver,stiffness_n_per_m,median_rms_n,worst_rms_n,steady_below_n,kept,proxy_error_m,"
      "capped,"
      "steady\n";
  for (const HandStudyRow& row : rows) {
    csv += fmt::format("{},{},{},{},\"{}\",{},{},{},{},{},{},{},{}\n", row.scene, row.motion, row.arm, row.hand,
                       row.solver, row.stiffness_n_per_m, row.median_rms_n, row.worst_rms_n, row.steady_below_n,
                       row.kept, row.proxy_error_m, row.capped, is_steady(row));
  }
  std::vector<HandStudyRow> scenes;  // one of each scene and motion
  for (auto row = rows.begin(); row != rows.end();) {
    const auto is_of_group = [&](const HandStudyRow& other) {
      return std::tie(other.scene, other.motion, other.arm, other.hand) ==
             std::tie(row->scene, row->motion, row->arm, row->hand);
    };
    const auto end = std::find_if_not(row, rows.end(), is_of_group);
    fmt::print("{:<25} {:<6} {:<10} {:<6}", row->scene, row->motion, row->arm, row->hand);
    double kept = 1, error_m = 0;
    for (const std::string& solver : hand_study_solvers()) {
      HandStudyRow one = *row;
      one.solver = solver;
      fmt::print(" {:>18.0f}", steady_up_to(rows, one, one.hand));
    }
    for (const HandStudyRow& one : std::span(row, end)) {
      if (is_steady(one)) kept = std::min(kept, one.kept);
      error_m = std::max(error_m, one.proxy_error_m);
    }
    fmt::print(" {:>5.0f}% {:>13.1e}\n", 100 * kept, error_m);
    if (scenes.empty() || std::tie(scenes.back().scene, scenes.back().motion) != std::tie(row->scene, row->motion)) {
      scenes.push_back(*row);
    }
    row = end;
  }
  fmt::print("\nThe arms:\n");
  for (const SimulatedArm& arm : simulated_arms()) fmt::print("  {:<10} {}\n", arm.name, arm.source);
  const device::SimulatedDevice model;
  const device::StiffnessBounds bounds = device::stiffness_bounds({.device_damping = model.arm.viscous_friction,
                                                                   .hand_damping = model.hand.damping,
                                                                   .coulomb_friction = model.arm.coulomb_friction,
                                                                   .position_step = model.position_step,
                                                                   .period = 1 / model.rate,
                                                                   .delay = model.delay});
  fmt::print(
      "Bounds of theory for one wall on the first arm: passive without a hand {:.0f} N/m, with it {:.0f}, near rest "
      "with "
      "friction {:.0f}.\nThe wind tunnel's force mode adds energy: no passivity is claimed there.\n",
      bounds.passive, bounds.held, bounds.near_rest);
  if (folder.empty()) return;
  write_text(folder / "hand.csv", csv);
  std::vector<Chart> panels;
  panels.reserve(scenes.size());
  for (const HandStudyRow& of : scenes) {
    panels.push_back(chart_of(rows, of, 0.5 * hand.stiffness_n_per_m.front(), hand.stiffness_n_per_m.back()));
  }
  write_png(panels, folder / "hand.png", 900, 280);
}

}  // namespace

void run_loop_studies(const LoopStudyOptions& options, const std::filesystem::path& folder) {
  over_ticks(options, folder);
  in_the_hand(options, folder);
}

}  // namespace palpate::plugin
