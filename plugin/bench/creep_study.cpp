#include "plugin/bench/creep_study.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>

#include "modes/scene/plan.h"
#include "modes/scene/scene_json.h"
#include "modes/tick/haptic_step.h"
#include "plugin/bench/solver_entrants.h"
#include "solver/chain.h"
#include "testdata/analytic.h"

namespace palpate::plugin {
namespace {

/// A wall of 3 N wherever there is an edge: entering denser tissue is resisted.
constexpr const char* wall = R"({"version": 1, "name": "wall", "modes": [{"type": "surface", "name": "wall",
  "side": "entering", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 3.0]]}}]})";
/// A wall of 1 N that yields, with friction.
constexpr const char* yielding = R"({"version": 1, "name": "skin", "modes": [{"type": "surface", "name": "skin",
  "side": "entering", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1.0]]}}]})";

/// The haptic loop without a device.
class Loop {
 public:
  Loop(const char* scene, std::shared_ptr<const io::FieldSource> source, const solver::SolverSet& solvers)
      : source_(std::move(source)),
        plan_(modes::make_plan(modes::scene_from_json(scene, "study"), source_->available(), modes::Workspace{})),
        chain_({.solvers = solvers}),
        scratch_(std::make_unique<modes::StepScratch>()) {}

  /// A tick with the probe there (patient, mm); the coupling's force along patient axes, N.
  glm::dvec3 move(const glm::dvec3& probe_mm) {
    const auto result = modes::step(plan_, *source_, plan_.workspace.to_device(probe_mm), touch_, chain_, *scratch_);
    proxy_mm_ = plan_.workspace.to_patient(result.proxy_m);
    return plan_.workspace.direction_to_patient(result.force_n);
  }
  const glm::dvec3& proxy_mm() const { return proxy_mm_; }

 private:
  std::shared_ptr<const io::FieldSource> source_;
  modes::Plan plan_;
  solver::Chain chain_;
  modes::Touch touch_;
  std::unique_ptr<modes::StepScratch> scratch_;
  glm::dvec3 proxy_mm_{0};
};

std::shared_ptr<const io::FieldSource> slab() {
  const std::vector<testdata::Layer> layers{{.depth = 0, .value = testdata::soft_tissue_hu}};
  return std::make_shared<testdata::AnalyticSource>(testdata::make_slab({0, 0, -1}, layers), 1.5);
}

constexpr double pressed_mm = 1.39 / 0.4;  // 1.39 N at 400 N/m

double creep(const solver::SolverSet& solvers, double seconds) {
  constexpr double radius = 10;
  Loop loop(wall, std::make_shared<testdata::AnalyticSource>(testdata::make_shell(radius, 40), 1.5), solvers);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.02);
  // From the cavity's middle outwards until the force is there, then at rest under noise.
  double depth = 0;
  while (glm::length(loop.move({depth, 0, 0})) < 1.39 && depth < 2 * radius) {
    depth += 0.01;
  }
  double begin = 0;
  double end = 0;
  const auto ticks = static_cast<int>(seconds * 1000);
  for (int n = 0; n < ticks; ++n) {
    const double force = glm::length(loop.move({depth + noise(random), noise(random), noise(random)}));
    begin += n < 500 ? force / 500 : 0;
    end += n >= ticks - 500 ? force / 500 : 0;
  }
  return 100 * (begin - end) / begin;
}

double drift(const solver::SolverSet& solvers, double seconds) {
  Loop loop(wall, slab(), solvers);
  for (double depth = -5; depth < pressed_mm; depth += 0.05) {
    loop.move({0, 0, -depth});
  }
  const double held = loop.proxy_mm().z;
  double largest = 0;
  for (int n = 0; n < static_cast<int>(seconds * 1000); ++n) {
    loop.move({0.05 * n, 0, -pressed_mm});
    largest = std::max(largest, std::abs(loop.proxy_mm().z - held));
  }
  return largest * 1e-3;
}

double hysteresis(const solver::SolverSet& solvers) {
  Loop loop(wall, slab(), solvers);
  for (double depth = -5; depth < 2; depth += 0.01) {
    loop.move({0, 0, -depth});
  }
  constexpr int steps = 200;
  std::vector<double> in;
  for (int n = 0; n <= steps; ++n) {
    in.push_back(glm::length(loop.move({0, 0, -2 - 0.01 * n})));
  }
  double largest = 0;
  for (int n = steps; n >= 0; --n) {
    largest = std::max(largest, std::abs(glm::length(loop.move({0, 0, -2 - 0.01 * n})) - in[n]));
  }
  return largest;
}

double pop_through(const solver::SolverSet& solvers) {
  Loop loop(yielding, slab(), solvers);
  double largest = 0;
  for (double depth = -5; depth < 15; depth += 0.005) {
    largest = std::max(largest, glm::length(loop.move({0, 0, -depth})));
  }
  return largest;
}

double rest_chatter(const solver::SolverSet& solvers, double seconds) {
  Loop loop(wall, std::make_shared<testdata::AnalyticSource>(testdata::make_sphere(25), 1.5), solvers);
  for (double depth = -5; depth < 2; depth += 0.05) {
    loop.move({0.3, -25 + depth, 0.1});
  }
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int n = 0; n < static_cast<int>(seconds * 1000); ++n) {
    const double force = glm::length(loop.move({0.3, -23, 0.1}));
    if (n >= 1000) {
      low = std::min(low, force);
      high = std::max(high, force);
    }
  }
  return high - low;
}

}  // namespace

std::vector<CreepStudyRow> study_creep(double seconds, const std::function<void(double)>& progress) {
  const std::vector<NamedSolvers> all = solvers_to_compare();
  std::vector<CreepStudyRow> rows;
  const auto add = [&](const NamedSolvers& solvers, const char* what, const char* how, double value, const char* unit,
                       const char* ideal) {
    rows.push_back({solvers.name, what, how, value, unit, ideal});
    progress(static_cast<double>(rows.size()) / static_cast<double>(5 * all.size()));
  };
  for (const NamedSolvers& solvers : all) {
    add(solvers, "creep", "cavity of 10 mm, 1.39 N, 0.02 mm rms of noise", creep(solvers.solvers, seconds), "% lost",
        "0");
    add(solvers, "drift", "flat slab, slide at 50 mm/s", drift(solvers.solvers, seconds), "m", "0");
    add(solvers, "hysteresis", "flat slab, 2 mm in and out", hysteresis(solvers.solvers), "N",
        "that of the yielding flank");
    add(solvers, "pop-through", "flat slab of 1 N, pushed through at 5 mm/s", pop_through(solvers.solvers), "N",
        "1, less at most k v dt = 0.002");
    add(solvers, "rest chatter", "sphere of 25 mm, probe perfectly still", rest_chatter(solvers.solvers, seconds), "N",
        "0, to the last bit");
  }
  return rows;
}

}  // namespace palpate::plugin
