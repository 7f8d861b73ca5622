#include "plugin/bench/hand_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <random>
#include <utility>

#include "device/simulated/simulated_stylus.h"
#include "plugin/app/running_session.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/session.h"

namespace palpate::plugin {
namespace {

/// Some slow sines along each axis.
class Drift {
 public:
  explicit Drift(std::mt19937& random) {
    std::uniform_real_distribution<double> hertz(0.1, 0.5), phase(0, 2 * glm::pi<double>());
    for (auto& axis : sines_) {
      for (auto& sine : axis) sine = {2 * glm::pi<double>() * hertz(random), phase(random)};
    }
  }
  glm::dvec3 operator()(double time) const {
    glm::dvec3 mm(0);
    for (int axis = 0; axis < 3; ++axis) {
      for (const auto& [frequency, phase] : sines_[static_cast<std::size_t>(axis)]) {
        mm[axis] += hand::drift_mm * std::sqrt(2.0 / 3) * std::sin(frequency * time + phase);
      }
    }
    return mm;
  }

 private:
  std::array<std::array<std::pair<double, double>, 3>, 3> sines_;
};

}  // namespace

void sort_for_hand(std::vector<EdgePlace>& places, const glm::dvec3& around_mm) {
  const auto slice = [](const EdgePlace& at) { return static_cast<int>(std::floor(at.place_mm.z / 2)); };
  const auto angle = [&](const EdgePlace& at) {
    return std::atan2(at.place_mm.y - around_mm.y, at.place_mm.x - around_mm.x);
  };
  std::ranges::sort(places, [&](const EdgePlace& a, const EdgePlace& b) {
    if (slice(a) != slice(b)) return slice(a) < slice(b);
    const double turn = slice(a) % 2 == 0 ? 1 : -1;
    return turn * angle(a) < turn * angle(b);
  });
}

HandTrace trace_by_hand(const std::vector<EdgePlace>& way, const std::shared_ptr<const io::Volume>& scan,
                        modes::Scene scene, bool felt, unsigned seed) {
  std::mt19937 random(seed);
  const Drift drift(random);
  std::uniform_real_distribution<double> aim(-hand::pixel_mm, hand::pixel_mm);
  device::SimulatedDevice model;
  model.hand.tremor_rms = 1e-3 * hand::tremor_mm;
  model.hand.tremor_seed = seed;
  const auto stylus = std::make_shared<device::SimulatedStylus>(model);
  const device::Specification specification = stylus->specification();
  const PreparedScene prepared = prepare(scene, scan, specification.workspace_half_extent);
  const modes::Workspace& workspace = prepared.plan->workspace;
  std::vector<device::Waypoint> waypoints;
  constexpr double step_s = 0.02, begin_s = 1;
  const auto go_to = [&](double time, const glm::dvec3& mm) {
    waypoints.push_back({.time = time, .position = workspace.to_device(mm)});
  };
  const auto aimed = [&](const EdgePlace& edge) {
    const glm::dvec3 seen = edge.place_mm + glm::dvec3(aim(random), aim(random), aim(random));
    return felt ? seen - hand::press_mm * edge.outward : seen;
  };
  // From outside, so that the edge is met on the way in.
  go_to(0, way.front().place_mm + 8.0 * way.front().outward);
  double time = begin_s;
  glm::dvec3 from = aimed(way.front());
  go_to(time, from + drift(time));
  for (std::size_t n = 1; n < way.size(); ++n) {
    const glm::dvec3 to = aimed(way[n]);
    const double length = std::max(glm::distance(way[n - 1].place_mm, way[n].place_mm), 0.1);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / (hand::speed_mm_s * step_s))));
    for (int step = 1; step <= steps; ++step) {
      time += length / hand::speed_mm_s / steps;
      go_to(time, glm::mix(from, to, static_cast<double>(step) / steps) + drift(time));
    }
    from = to;
  }
  stylus->follow(waypoints, device::PathInterpolation::linear);
  Session session(snapshot_of(scene, prepared, specification), stylus);
  HandTrace trace;
  const auto every = static_cast<int>(hand::sample_s * specification.rate);
  const auto first = static_cast<int>((begin_s + 0.1) * specification.rate);
  for (int tick = 0; tick < static_cast<int>(time * specification.rate); ++tick) {
    const TickRecord record = session.tick();
    if (tick < first || (tick - first) % every != 0) continue;
    const glm::dvec3 at = workspace.to_patient(vector_of(record.proxy_m));
    if (!trace.points_mm.empty()) trace.path_mm += glm::distance(at, trace.points_mm.back());
    trace.points_mm.push_back(at);
  }
  return trace;
}

}  // namespace palpate::plugin
