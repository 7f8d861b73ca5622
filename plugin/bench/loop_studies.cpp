#include "plugin/bench/loop_studies.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "device/safety/stiffness.h"
#include "device/simulated/simulated_stylus.h"
#include "plugin/bench/frame_study.h"
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

void over_frames(const LoopStudyOptions& options, const std::filesystem::path& folder) {
  fmt::print("(b) Over frames: the probe is moved, no device, k = 400 N/m, {} s\n\n", options.seconds);
  fmt::print("{:<13} {:<18} {:>12} {:<7} {:<32} {}\n", "what", "solvers", "value", "unit", "ideal", "how");
  std::string csv = "what,solvers,value,unit,ideal,how\n";
  auto rows = study_frames(options.seconds, progress_line("over frames"));
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.what < b.what; });
  for (const FrameStudyRow& row : rows) {
    fmt::print("{:<13} {:<18} {:>12.3g} {:<7} {:<32} {}\n", row.what, row.solver, row.value, row.unit, row.ideal,
               row.how);
    csv +=
        fmt::format("{},\"{}\",{},{},\"{}\",\"{}\"\n", row.what, row.solver, row.value, row.unit, row.ideal, row.how);
  }
  if (!folder.empty()) {
    write_text(folder / "frames.csv", csv);
  }
}

Chart chart_of(const std::string& scene, const std::string& motion, const std::vector<HandStudyRow>& rows) {
  Chart chart{scene + ", " + motion, {"stiffness k (N/m)", true}, {"RMS of the force, 30 to 500 Hz (N)", true}, {}, {}};
  constexpr std::array palette{colors::blue, colors::orange, colors::vermilion};
  Curve threshold{.label = "2 k q: still below", .x = {}, .y = {}, .color = colors::gray};
  for (const HandStudyRow& row : rows) {
    if (row.scene != scene || row.motion != motion) {
      continue;
    }
    auto curve =
        std::find_if(chart.curves.begin(), chart.curves.end(), [&](const Curve& c) { return c.label == row.solver; });
    if (curve == chart.curves.end()) {
      chart.curves.push_back(
          {.label = row.solver, .x = {}, .y = {}, .color = palette[chart.curves.size() % palette.size()]});
      curve = chart.curves.end() - 1;
    }
    curve->x.push_back(row.stiffness_n_per_m);
    curve->y.push_back(row.median_rms_n);
    if (chart.curves.size() == 1) {
      threshold.x.push_back(row.stiffness_n_per_m);
      threshold.y.push_back(2 * row.stiffness_n_per_m * device::SimulatedDevice{}.position_step);
    }
  }
  chart.curves.push_back(threshold);
  return chart;
}

void in_the_hand(const LoopStudyOptions& options, const std::filesystem::path& folder) {
  const HandStudyOptions hand{.hands = options.hands, .hold_s = options.hold_s};
  const auto rows = study_hand(hand, progress_line("in the hand"));
  fmt::print("\n(c) In the hand: default simulated device and hand, {} hands, the last second of {} s\n\n", hand.hands,
             hand.hold_s);
  fmt::print("{:<26} {:<6} {:<18} {:>7} {:>12} {:>12} {:>13} {:>7}  {}\n", "scene", "motion", "solvers", "k N/m",
             "median RMS N", "worst RMS N", "proxy error m", "capped", "still");
  std::string csv = "scene,motion,solvers,stiffness_n_per_m,median_rms_n,worst_rms_n,proxy_error_m,capped,still\n";
  std::map<std::tuple<std::string, std::string, std::string>, double> largest;
  std::map<std::tuple<std::string, std::string, std::string>, bool> rang;
  for (const HandStudyRow& row : rows) {
    fmt::print("{:<26} {:<6} {:<18} {:>7.0f} {:>12.4f} {:>12.4f} {:>13.2e} {:>7}  {}\n", row.scene, row.motion,
               row.solver, row.stiffness_n_per_m, row.median_rms_n, row.worst_rms_n, row.proxy_error_m, row.capped,
               is_still(row) ? "yes" : "no");
    csv += fmt::format("{},{},\"{}\",{},{},{},{},{},{}\n", row.scene, row.motion, row.solver, row.stiffness_n_per_m,
                       row.median_rms_n, row.worst_rms_n, row.proxy_error_m, row.capped, is_still(row));
    const auto key = std::tuple(row.scene, row.motion, row.solver);
    rang[key] = rang[key] || !is_still(row);
    if (!rang[key]) {
      largest[key] = row.stiffness_n_per_m;
    }
  }
  fmt::print("\nLargest stiffness tried below which every one was still (median RMS < 2 k q, q = {} mm):\n",
             1e3 * device::SimulatedDevice{}.position_step);
  for (const auto& [key, unused] : rang) {
    const auto found = largest.find(key);
    fmt::print("  {:<26} {:<6} {:<18} {}\n", std::get<0>(key), std::get<1>(key), std::get<2>(key),
               found == largest.end() ? std::string("none") : fmt::format("{:.0f} N/m", found->second));
  }
  const device::SimulatedDevice model;
  const device::StiffnessBounds bounds = device::stiffness_bounds({.device_damping = model.arm.viscous_friction,
                                                                   .hand_damping = model.hand.damping,
                                                                   .coulomb_friction = model.arm.coulomb_friction,
                                                                   .position_step = model.position_step,
                                                                   .period = 1 / model.rate,
                                                                   .delay = model.delay});
  fmt::print(
      "Bounds of theory for one wall: passive without a hand {:.0f} N/m, with it {:.0f}, near rest with friction "
      "{:.0f}.\nThe wind tunnel's force mode adds energy: no passivity is claimed there.\n",
      bounds.passive, bounds.held, bounds.near_rest);
  if (!folder.empty()) {
    write_text(folder / "hand.csv", csv);
    const std::array panels{chart_of(rows.front().scene, "press", rows), chart_of(rows.front().scene, "slide", rows),
                            chart_of(rows.back().scene, "press", rows), chart_of(rows.back().scene, "slide", rows)};
    write_png(panels, folder / "hand.png", 900, 360);
  }
}

}  // namespace

void run_loop_studies(const LoopStudyOptions& options, const std::filesystem::path& folder) {
  over_frames(options, folder);
  in_the_hand(options, folder);
}

}  // namespace palpate::plugin
