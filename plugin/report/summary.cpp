#include "plugin/report/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <span>

#include "device/safety/safety_filter.h"
#include "io/fields/boundary_uncertainty.h"
#include "io/quantile.h"
#include "plugin/report/held_boundary.h"
#include "plugin/session/session.h"
#include "solver/solution.h"

namespace palpate::plugin {
namespace {

constexpr double same_hold_s = 0.05;  // a shorter interruption does not end a hold: contact chatters at its edge

void extend_approaches(std::vector<Approach>& approaches, const TickRecord& tick) {
  for (std::size_t n = 0; n < approaches.size(); ++n) {
    if (tick.distance_mm[n] > approaches[n].distance_mm) {
      approaches[n].distance_mm = tick.distance_mm[n];
      approaches[n].time_s = tick.time_s;
    }
  }
}

void extend_holds(std::vector<HeldStretch>& holds, std::size_t mode, const TickRecord& tick, const modes::Plan& plan) {
  const bool goes_on = !holds.empty() && holds.back().mode == mode && tick.time_s - holds.back().end_s < same_hold_s;
  if (!goes_on) {
    holds.push_back({.mode = mode,
                     .begin_s = tick.time_s,
                     .end_s = tick.time_s,
                     .contact_mm = plan.workspace.to_patient(vector_of(tick.proxy_m)),
                     .value = tick.value});
  }
  holds.back().end_s = tick.time_s;
  holds.back().peak_n = std::max(holds.back().peak_n, glm::length(vector_of(tick.force_n)));
}

}  // namespace

double tick_us(const TickRecord& tick) {
  return 1e-3 * std::accumulate(std::begin(tick.stage_ns), std::end(tick.stage_ns), 0.0);
}

Percentiles percentiles_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) { return io::quantile_of_sorted(values, share); };
  return {.median = at(0.5), .p99 = at(0.99), .p999 = at(0.999), .largest = values.back()};
}

Summary summarize(const Recording& recording, const modes::Plan& plan) {
  Summary summary;
  summary.ticks = recording.ticks.size();
  summary.scan_frames = scan_frames_of(recording);
  summary.registered = registered_of(recording);
  if (recording.ticks.empty()) {
    return summary;
  }
  summary.duration_s = recording.ticks.back().time_s - recording.ticks.front().time_s;
  std::vector<double> times;
  times.reserve(recording.ticks.size());
  std::span<const PrimitiveRecord> shares(recording.shares);
  device::Fault fault = device::Fault::none;
  for (const std::size_t n : plan.structures) {
    summary.approaches.push_back({.structure = n, .distance_mm = -std::numeric_limits<double>::infinity()});
  }
  for (const TickRecord& tick : recording.ticks) {
    const auto own = shares.first(tick.share_count);
    shares = shares.subspan(tick.share_count);
    if (const auto mode = holding_surface(own, plan)) {
      extend_holds(summary.holds, *mode, tick, plan);
    }
    extend_approaches(summary.approaches, tick);
    switch (static_cast<solver::Outcome>(tick.outcome)) {
      case solver::Outcome::capped:
        ++summary.capped;
        break;
      case solver::Outcome::refused:
      case solver::Outcome::unsuitable:
        ++summary.refused;
        break;
      case solver::Outcome::solved:
        break;
    }
    if (tick.solver < summary.solver_ticks.size()) ++summary.solver_ticks[tick.solver];
    summary.peak_sent_n = std::max(summary.peak_sent_n, glm::length(vector_of(tick.sent_n)));
    summary.largest_error_bound_m = std::max(summary.largest_error_bound_m, tick.error_bound_m);
    summary.largest_residual_m = std::max(summary.largest_residual_m, tick.residual_n / plan.stiffness_n_per_m);
    if (fault_of(tick) != fault && fault_of(tick) != device::Fault::none) {
      summary.faults.push_back(fmt::format("at {:.3f} s: {} ({})", tick.time_s, device::name_of(fault_of(tick)),
                                           device::advice_for(fault_of(tick))));
    }
    fault = fault_of(tick);
    summary.missed += tick.missed;
    times.push_back(tick_us(tick));
  }
  summary.tick_us = percentiles_of(std::move(times));
  for (const Gap& gap : recording.gaps) {
    summary.lost += gap.ticks;
  }
  return summary;
}

std::string display_name(const modes::Scene& scene, std::size_t mode) {
  if (mode >= scene.modes.size()) {
    return fmt::format("mode {}", mode);
  }
  const modes::Mode& named = scene.modes[mode];
  if (!named.name.empty()) return named.name;
  if (named.structure.empty()) return named.type;
  return modes::reads_key(named, modes::Key::structure) ? named.structure
                                                        : fmt::format("{} {}", named.type, named.structure);
}

std::string distance_in_words(double distance_mm, const std::string& structure) {
  return fmt::format("{:.1f} mm {} {}", std::abs(distance_mm), distance_mm > 0 ? "inside" : "from", structure);
}

std::string patient_coordinates(const glm::dvec3& position_mm) {
  return fmt::format("{} {:.1f} {} {:.1f} {} {:.1f} mm", position_mm.x < 0 ? 'R' : 'L', std::abs(position_mm.x),
                     position_mm.y < 0 ? 'A' : 'P', std::abs(position_mm.y), position_mm.z < 0 ? 'F' : 'H',
                     std::abs(position_mm.z));
}

std::optional<double> known_to_mm(const io::FieldSource& source, const io::Geometry& geometry,
                                  const modes::Scene& scene, const glm::dvec3& place_mm) {
  if (!io::contains(source.available(), io::FieldSet::value | io::FieldSet::gradient)) return std::nullopt;
  const io::ValueMethod method =
      scene.sampling.gradient == io::GradientMethod::cubic ? io::ValueMethod::cubic : scene.sampling.value;
  const double mm = io::uncertainty_at(source, geometry, method, place_mm, scene.filter).two_sigma_mm;
  return std::isfinite(mm) ? std::optional(mm) : std::nullopt;
}

std::string known_to_text(const std::optional<double>& mm) {
  return mm ? fmt::format("; known to +-{:.2g} mm", *mm) : "";
}

void add_uncertainty(Summary& summary, const modes::Scene& scene, const io::FieldSource& source,
                     const io::Geometry& geometry) {
  // Of the scan's own boundaries: how well a structure was outlined the scan does not say.
  for (HeldStretch& hold : summary.holds) {
    if (!scene.modes[hold.mode].structure.empty()) continue;
    hold.known_to_mm = known_to_mm(source, geometry, scene, hold.contact_mm);
  }
}

std::string to_text(const Summary& summary, const modes::Scene& scene, const std::string& scan,
                    const std::string& device) {
  std::string text = fmt::format("Palpate session: {:.1f} s, {} ticks\n\n", summary.duration_s, summary.ticks);
  text += fmt::format("scan      {}\n", scan);
  for (const ScanFrame& frame : summary.scan_frames) {
    if (frame.count > 1) text += fmt::format("frame     {} of 0 to {}\n", frame.number, frame.count - 1);
  }
  text += fmt::format("scene     {}\ndevice    {}\n\n", scene.name, device);
  text += "What was felt\n";
  if (summary.holds.empty()) {
    text += "  nothing: no boundary pushed with more than 0.05 N\n";
  }
  for (const HeldStretch& hold : summary.holds) {
    text += fmt::format("  {:6.3f} to {:6.3f} s  {:<12} met at {}, value {:.0f}; up to {:.2f} N{}\n", hold.begin_s,
                        hold.end_s, display_name(scene, hold.mode), patient_coordinates(hold.contact_mm), hold.value,
                        hold.peak_n, known_to_text(hold.known_to_mm));
  }
  text += fmt::format("  largest force sent to the device: {:.2f} N\n\n", summary.peak_sent_n);
  if (!summary.approaches.empty()) {
    text += "How near it came to structures\n";
    for (const Approach& approach : summary.approaches) {
      text += fmt::format("  {}, at {:.3f} s\n",
                          distance_in_words(approach.distance_mm, scene.structures[approach.structure].name),
                          approach.time_s);
    }
    for (const RegisteredStructure& one : summary.registered) {
      text += fmt::format("  {} was moved by {}: the registration {}\n", one.structure, in_words(one.motion),
                          one.file_hash);
    }
    text += "\n";
  }
  text += "How it was solved\n";
  const char* before = "  ";
  const char* after = " ticks";
  for (const solver::SolverType* type : solver::solver_types()) {
    text += fmt::format("{}{} {}{}", before, type->name, summary.solver_ticks[type->number], after);
    before = ", ";
    after = "";
  }
  text += fmt::format("; work cap hit {}, refused {}\n", summary.capped, summary.refused);
  text += fmt::format("  certified error of the proxy at most {:.1e} m; residual / k at most {:.1e} m\n\n",
                      summary.largest_error_bound_m, summary.largest_residual_m);
  text += fmt::format("Time of a tick   median {:.2f} us, 99 % {:.2f} us, 99.9 % {:.2f} us, largest {:.1f} us\n",
                      summary.tick_us.median, summary.tick_us.p99, summary.tick_us.p999, summary.tick_us.largest);
  text += fmt::format("Missed ticks     {}; ticks lost to the recording {}\n", summary.missed, summary.lost);
  text += summary.faults.empty() ? "Safety           no fault\n" : "Safety\n";
  for (const std::string& fault : summary.faults) {
    text += "  " + fault + "\n";
  }
  text += "\nResearch software, not a medical device.\n";
  return text;
}

std::string to_json(const Summary& summary, const modes::Scene& scene) {
  nlohmann::json holds = nlohmann::json::array();
  for (const HeldStretch& hold : summary.holds) {
    holds.push_back({{"boundary", display_name(scene, hold.mode)},
                     {"begin_s", hold.begin_s},
                     {"end_s", hold.end_s},
                     {"contact_mm", {hold.contact_mm.x, hold.contact_mm.y, hold.contact_mm.z}},
                     {"value", hold.value},
                     {"peak_n", hold.peak_n}});
    if (hold.known_to_mm) holds.back()["known_to_mm"] = *hold.known_to_mm;
  }
  nlohmann::json structures = nlohmann::json::object();
  for (const Approach& approach : summary.approaches) {
    structures[scene.structures[approach.structure].name] = {{"largest_distance_mm", approach.distance_mm},
                                                             {"time_s", approach.time_s}};
  }
  for (const RegisteredStructure& one : summary.registered) {
    structures[one.structure]["registration"] = one.file_hash;
    structures[one.structure]["registered_by"] = in_words(one.motion);
  }
  nlohmann::json scan_frames = nlohmann::json::array();
  for (const ScanFrame& frame : summary.scan_frames) scan_frames.push_back(frame.number);
  nlohmann::json solver_frames{{"capped", summary.capped}, {"refused", summary.refused}};
  for (const solver::SolverType* type : solver::solver_types()) {
    solver_frames[std::string(type->name)] = summary.solver_ticks[type->number];
  }
  const nlohmann::json json{{"scan_frames", scan_frames},
                            {"duration_s", summary.duration_s},
                            {"frames", summary.ticks},
                            {"holds", holds},
                            {"structures", structures},
                            {"peak_sent_n", summary.peak_sent_n},
                            {"solver_frames", solver_frames},
                            {"largest_error_bound_m", summary.largest_error_bound_m},
                            {"largest_residual_m", summary.largest_residual_m},
                            {"tick_us",
                             {{"median", summary.tick_us.median},
                              {"p99", summary.tick_us.p99},
                              {"p999", summary.tick_us.p999},
                              {"largest", summary.tick_us.largest}}},
                            {"missed_ticks", summary.missed},
                            {"lost_frames", summary.lost},
                            {"faults", summary.faults}};
  return json.dump(1);
}

}  // namespace palpate::plugin
