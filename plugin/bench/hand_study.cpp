#include "plugin/bench/hand_study.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "device/simulated/simulated_stylus.h"
#include "io/parallel.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene_json.h"
#include "modes/tick/haptic_step.h"
#include "plugin/bench/arms.h"
#include "plugin/bench/solver_entrants.h"
#include "solver/chain.h"
#include "solver/exact.h"
#include "testdata/analytic.h"
#include "testdata/flow.h"

namespace palpate::plugin {
namespace {

constexpr const char* surface_friction = R"({"version": 1, "name": "surface + friction", "modes": [
  {"type": "surface", "name": "wall", "side": "entering",
   "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 2.5]]}},
  {"type": "friction", "name": "friction", "strength_n": {"of": "value", "nodes": [[-310, 0], [-290, 0.1]]}}]})";

constexpr const char* three_modes = R"({"version": 1, "name": "follow + force + surface", "modes": [
  {"type": "follow", "name": "guide", "field": "vector", "strength_n": {"of": "vector", "nodes": [[0, 0], [1, 0.5], [2, 1]]}},
  {"type": "force", "name": "push", "field": "vector", "strength_n": {"of": "vector", "nodes": [[0, 0], [1, 0.3], [2, 0.6]]}},
  {"type": "surface", "name": "pressure", "side": "entering",
   "strength_n": {"of": "gradient_per_mm", "nodes": [[0, 0], [0.02, 1.5]]}}]})";

/// A place of a wall in patient space, mm, and the direction that presses on it (unit).
struct Spot {
  glm::dvec3 place_mm;
  glm::dvec3 into;
};

/// The surface that is pressed, and the line along which it is uniform.
struct Setting {
  const char* scene;
  std::shared_ptr<const io::FieldSource> source;
  std::function<Spot(double along_mm)> spot;  // at 0: where it is pressed, and the workspace's center
};

Setting flat_slab() {
  const std::vector<testdata::Layer> layers{{.depth = 0, .value = testdata::soft_tissue_hu}};
  return {.scene = surface_friction,
          .source = std::make_shared<testdata::AnalyticSource>(testdata::make_slab({0, 0, -1}, layers), 1.5),
          .spot = [](double along_mm) {
            return Spot{{along_mm, 0, 0}, {0, 0, -1}};
          }};
}

/// In front of the sphere, where flow and pressure gradient meet at 140 degrees; and round the axis, where all is the
/// same.
Setting wind_tunnel() {
  const auto source = std::make_shared<testdata::FlowSource>(testdata::FlowPastSphere{});
  return {.scene = three_modes, .source = source, .spot = [source](double along_mm) {
            constexpr double radius_mm = 23.6;
            const double turn = along_mm / radius_mm;
            const glm::dvec3 place{-11, radius_mm * std::sin(turn), radius_mm * std::cos(turn)};
            return Spot{place, glm::normalize(source->sample(place, io::FieldSet::gradient).gradient)};
          }};
}

struct HandOutcome {
  double rms_n = 0;
  double kept = 0;
  double proxy_error_m = 0;
  std::size_t capped = 0;
};

/// N: half of the largest force of the plan's surface at the pressed place.
double pressing_force_n(const modes::Plan& plan, const Setting& setting) {
  const io::Sample sample = setting.source->sample(setting.spot(0).place_mm, plan.fields);
  double most_n = 0;
  for (const modes::ActiveMode& mode : plan.modes) {
    if (mode.holds) most_n = std::max(most_n, mode.strength(sample));
  }
  return 0.5 * most_n;
}

constexpr double came_at_s = 0.5;

/// mm along the setting's line, at a time in s: it stays in the middle, or slides 20 mm a second through it.
double along_of(double time, bool slide, double hold_s) {
  return slide ? 20 * (std::max(time, came_at_s) - came_at_s - 0.5 * hold_s) : 0;
}

/// From patient space to axes that turn with the wall: a force that stays the same on it is constant in them.
glm::dmat3 axes_at(const Setting& setting, double along_mm) {
  const Spot spot = setting.spot(along_mm);
  const glm::dvec3 onward = setting.spot(along_mm + 0.1).place_mm - setting.spot(along_mm - 0.1).place_mm;
  const glm::dvec3 across = glm::normalize(glm::cross(spot.into, onward));
  return glm::transpose(glm::dmat3(spot.into, glm::cross(across, spot.into), across));
}

/// In half a second from 8 mm in front of the wall to the target depth `depth_m`; then it stays there or slides at 20
/// mm/s.
std::vector<device::Waypoint> path_of(const Setting& setting, const modes::Workspace& workspace, double depth_m,
                                      bool slide, double hold_s) {
  const auto waypoint = [&](double time, double depth) {
    const Spot spot = setting.spot(along_of(time, slide, hold_s));
    return device::Waypoint{
        .time = time,
        .position = workspace.to_device(spot.place_mm) + depth * workspace.direction_to_device(spot.into)};
  };
  std::vector<device::Waypoint> path{waypoint(0, -0.008)};
  for (double time = came_at_s; time < came_at_s + hold_s + 1e-9; time += 0.001)
    path.push_back(waypoint(time, depth_m));
  return path;
}

HandOutcome run_once(const Setting& setting, bool slide, const device::SimulatedDevice& model,
                     const NamedSolvers& solvers, double stiffness, double hold_s) {
  modes::Scene scene = modes::scene_from_json(setting.scene, "study");
  scene.stiffness_n_per_m = stiffness;
  modes::Workspace workspace;
  workspace.center_mm = setting.spot(0).place_mm;
  modes::Plan plan = modes::make_plan(scene, setting.source->available(), workspace);

  device::SimulatedStylus stylus(model);
  const double depth_m = pressing_force_n(plan, setting) * (1 / stiffness + 1 / model.hand.stiffness);
  stylus.follow(path_of(setting, workspace, depth_m, slide, hold_s), device::PathInterpolation::linear);
  stylus.open();

  solver::Chain chain({.solvers = solvers.solvers});
  solver::Chain reference({.solvers = {&solver::exact_solver}});
  const auto scratch = std::make_unique<modes::StepScratch>();
  std::vector<solver::Vec3> reference_forces(modes::most_primitives);
  modes::Touch touch;
  HandOutcome outcome;
  const auto ticks = static_cast<int>((0.5 + hold_s) * model.rate);
  std::vector<double> force[3];
  for (int tick = 0; tick < ticks; ++tick) {
    const device::Reading reading = stylus.read();
    const modes::StepResult result = modes::step(plan, *setting.source, reading.position, touch, chain, *scratch);
    stylus.write_force(result.force_n);
    outcome.capped += static_cast<std::size_t>(result.capped);
    if (tick + model.rate < ticks) continue;
    outcome.kept += (result.hold == modes::HoldState::held) / model.rate;
    const glm::dvec3 local =
        axes_at(setting, along_of(tick / model.rate, slide, hold_s)) * workspace.direction_to_patient(result.force_n);
    for (int axis = 0; axis < 3; ++axis) force[axis].push_back(local[axis]);
    const solver::Solution exact = reference.solve({.stiffness = stiffness,
                                                    .probe = reading.position,
                                                    .previous_proxy = result.proxy_m,
                                                    .primitives = result.primitives},
                                                   std::span(reference_forces).first(result.primitives.size()));
    if (exact.outcome == solver::Outcome::solved) {
      outcome.proxy_error_m = std::max(outcome.proxy_error_m, glm::distance(exact.proxy, result.proxy_m));
    }
  }
  stylus.close();
  for (const auto& axis : force) {
    const double rms = band_rms(axis, model.rate, 30, 500);
    outcome.rms_n += rms * rms;
  }
  outcome.rms_n = std::sqrt(outcome.rms_n);
  return outcome;
}

/// One curve of the study: what stays the same while the stiffness rises.
struct Held {
  const Setting* setting;
  bool slide;
  SimulatedArm arm;
  SimulatedHand hand;
  NamedSolvers solvers;
};

std::vector<Held> everything_held(const std::vector<Setting>& settings) {
  std::vector<Held> all;
  for (const Setting& setting : settings) {
    for (const bool slide : {false, true}) {
      for (const SimulatedArm& arm : simulated_arms()) {
        for (const SimulatedHand& hand : simulated_hands()) {
          for (const NamedSolvers& chain : solvers_to_compare()) all.push_back({&setting, slide, arm, hand, chain});
        }
      }
    }
  }
  return all;
}

HandStudyRow run_all_tremors(const Held& held, double stiffness, const HandStudyOptions& options) {
  HandStudyRow row{.scene = modes::scene_from_json(held.setting->scene, "study").name,
                   .motion = held.slide ? "slide" : "press",
                   .arm = held.arm.name,
                   .hand = held.hand.name,
                   .solver = held.solvers.name,
                   .stiffness_n_per_m = stiffness,
                   .steady_below_n = 2 * stiffness * held.arm.device.position_step};
  device::SimulatedDevice model = held.arm.device;
  model.hand = held.hand.model;
  std::vector<double> rms;
  for (int tremor = 1; tremor <= options.hands; ++tremor) {
    model.hand.tremor_seed = static_cast<std::uint64_t>(tremor);
    const HandOutcome outcome = run_once(*held.setting, held.slide, model, held.solvers, stiffness, options.hold_s);
    rms.push_back(outcome.rms_n);
    row.kept = std::min(row.kept, outcome.kept);
    row.proxy_error_m = std::max(row.proxy_error_m, outcome.proxy_error_m);
    row.capped += outcome.capped;
  }
  std::ranges::sort(rms);
  row.median_rms_n = rms[rms.size() / 2];
  row.worst_rms_n = rms.back();
  return row;
}

}  // namespace

double band_rms(const std::vector<double>& signal, double rate, double low_hz, double high_hz) {
  const std::size_t count = signal.size();
  double power = 0;
  for (std::size_t bin = 0; 2 * bin <= count; ++bin) {
    const double frequency = static_cast<double>(bin) * rate / static_cast<double>(count);
    if (frequency < low_hz || frequency > high_hz) {
      continue;
    }
    std::complex<double> sum = 0;
    for (std::size_t n = 0; n < count; ++n) {
      // The product modulo count keeps the angle small, so that its rounding does.
      const double turns = static_cast<double>(bin * n % count) / static_cast<double>(count);
      sum += std::polar(signal[n], -2 * std::numbers::pi * turns);
    }
    const bool paired = bin != 0 && 2 * bin != count;
    power += (paired ? 2 : 1) * std::norm(sum) / (static_cast<double>(count) * static_cast<double>(count));
  }
  return std::sqrt(power);
}

const std::vector<std::string>& hand_study_solvers() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const NamedSolvers& one : solvers_to_compare()) all.emplace_back(one.name);
    return all;
  }();
  return names;
}

bool is_steady(const HandStudyRow& row) {
  return row.kept >= 0.75 && row.median_rms_n < row.steady_below_n;
}

std::vector<HandStudyRow> study_hand(const HandStudyOptions& options, const std::function<void(double)>& progress) {
  const std::vector<Setting> settings{flat_slab(), wind_tunnel()};
  const std::vector<Held> all = everything_held(settings);
  std::vector<std::vector<HandStudyRow>> curves(all.size());
  const auto study = [&](std::size_t n) {
    for (const double stiffness : options.stiffness_n_per_m) {
      curves[n].push_back(run_all_tremors(all[n], stiffness, options));
      if (!is_steady(curves[n].back())) break;
    }
  };
  io::internal::parallel_for(
      all.size(), study, [&](double done) { return progress(done), true; }, 0);
  std::vector<HandStudyRow> rows;
  for (const auto& curve : curves) rows.insert(rows.end(), curve.begin(), curve.end());
  return rows;
}

}  // namespace palpate::plugin
