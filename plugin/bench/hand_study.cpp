#include "plugin/bench/hand_study.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene_json.h"
#include "modes/tick/haptic_step.h"
#include "solver/chain.h"
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

/// What is pressed on, from where and how.
struct Setting {
  const char* scene;
  std::shared_ptr<const io::FieldSource> source;
  glm::dvec3 center_mm;  // of the workspace: the place that is pressed
  glm::dvec3 into;       // patient: direction of pressing
  glm::dvec3 along;      // patient: direction of sliding
};

Setting flat_slab() {
  const std::vector<testdata::Layer> layers{{.depth = 0, .value = testdata::soft_tissue_hu}};
  return {.scene = surface_friction,
          .source = std::make_shared<testdata::AnalyticSource>(testdata::make_slab({0, 0, -1}, layers), 1.5),
          .center_mm = {0, 0, 0},
          .into = {0, 0, -1},
          .along = {1, 0, 0}};
}

/// Off the axis in front of the sphere, where flow and pressure gradient are oblique to each other.
Setting wind_tunnel() {
  const glm::dvec3 place{-18, 0, 14};
  return {.scene = three_modes,
          .source = std::make_shared<testdata::FlowSource>(testdata::FlowPastSphere{}),
          .center_mm = place,
          .into = -glm::normalize(place),
          .along = {0, 1, 0}};
}

struct Solvers {
  const char* name;
  solver::ChainOptions chain;
};

std::vector<Solvers> solvers() {
  return {{"analytical, exact", {.analytical = true, .exact = true, .descent = false}},
          {"exact", {.analytical = false, .exact = true, .descent = false}},
          {"descent", {.analytical = false, .exact = false, .descent = true}}};
}

struct Outcome {
  double rms_n = 0;
  double proxy_error_m = 0;
  std::size_t capped = 0;
};

Outcome run_once(const Setting& setting, bool slide, const Solvers& solvers, double stiffness, std::uint64_t seed,
                 double hold_s) {
  modes::Scene scene = modes::scene_from_json(setting.scene, "study");
  scene.stiffness_n_per_m = stiffness;
  modes::Workspace workspace;
  workspace.center_mm = setting.center_mm;
  modes::Plan plan = modes::make_plan(scene, setting.source->available(), workspace);

  device::SimulatedDevice model;
  model.hand.tremor_seed = seed;
  device::SimulatedStylus stylus(model);
  const glm::dvec3 into = workspace.direction_to_device(setting.into);
  const glm::dvec3 along = workspace.direction_to_device(setting.along);
  // The hand means to be 4 mm deep: with its own spring in series that is about 1 N at every stiffness.
  const double depth = 0.004;
  const double reach = slide ? 0.02 * hold_s : 0.0;  // 20 mm/s
  const std::vector<device::Waypoint> path{{.time = 0, .position = -0.008 * into - 0.5 * reach * along},
                                           {.time = 0.5, .position = depth * into - 0.5 * reach * along},
                                           {.time = 0.5 + hold_s, .position = depth * into + 0.5 * reach * along}};
  stylus.follow(path, device::PathInterpolation::linear);
  stylus.open();

  solver::Chain chain(solvers.chain);
  solver::Chain reference({.analytical = false, .exact = true, .descent = false});
  const auto scratch = std::make_unique<modes::StepScratch>();
  std::vector<solver::Vec3> reference_forces(modes::most_primitives);
  modes::Touch touch;
  Outcome outcome;
  const auto ticks = static_cast<int>((0.5 + hold_s) * model.rate);
  std::vector<double> force[3];
  for (int tick = 0; tick < ticks; ++tick) {
    const device::Reading reading = stylus.read();
    const modes::StepResult result = modes::step(plan, *setting.source, reading.position, touch, chain, *scratch);
    stylus.write_force(result.force_n);
    outcome.capped += static_cast<std::size_t>(result.capped);
    if (tick + model.rate < ticks) {
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      force[axis].push_back(result.force_n[axis]);
    }
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

bool is_still(const HandStudyRow& row) {
  return row.median_rms_n < 2 * row.stiffness_n_per_m * device::SimulatedDevice{}.position_step;
}

std::vector<HandStudyRow> study_hand(const HandStudyOptions& options, const std::function<void(double)>& progress) {
  std::vector<HandStudyRow> rows;
  const std::vector<Setting> settings{flat_slab(), wind_tunnel()};
  const double total = static_cast<double>(settings.size() * 2 * solvers().size() * options.stiffness_n_per_m.size());
  for (const Setting& setting : settings) {
    for (const bool slide : {false, true}) {
      for (const Solvers& chain : solvers()) {
        for (const double stiffness : options.stiffness_n_per_m) {
          HandStudyRow row{.scene = modes::scene_from_json(setting.scene, "study").name,
                           .motion = slide ? "slide" : "press",
                           .solver = chain.name,
                           .stiffness_n_per_m = stiffness};
          std::vector<double> rms;
          for (int hand = 1; hand <= options.hands; ++hand) {
            const Outcome outcome =
                run_once(setting, slide, chain, stiffness, static_cast<std::uint64_t>(hand), options.hold_s);
            rms.push_back(outcome.rms_n);
            row.proxy_error_m = std::max(row.proxy_error_m, outcome.proxy_error_m);
            row.capped += outcome.capped;
          }
          std::sort(rms.begin(), rms.end());
          row.median_rms_n = rms[rms.size() / 2];
          row.worst_rms_n = rms.back();
          rows.push_back(row);
          progress(static_cast<double>(rows.size()) / total);
        }
      }
    }
  }
  return rows;
}

}  // namespace palpate::plugin
