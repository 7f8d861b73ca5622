#include "plugin/bench/sphere_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene_json.h"
#include "modes/tick/haptic_step.h"
#include "plugin/bench/tick_study.h"
#include "plugin/report/summary.h"
#include "solver/chain.h"
#include "testdata/analytic.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using glm::dvec3;

constexpr double sphere_radius_mm = 50;
constexpr double edge_mm = 1;  // standard deviation of its Gaussian edge
constexpr double sphere_depth_mm = 2;
constexpr double sphere_step_mm = 0.05;  // 50 mm/s at 1 kHz

/// Sampled at the voxels' centers, rounded to 1 HU as CT does.
std::shared_ptr<const io::Volume> soft_sphere(int voxels) {
  testdata::Grid grid;
  grid.size = glm::ivec3(voxels);
  grid.spacing = dvec3(128.0 / voxels);
  auto volume = std::make_shared<io::Volume>();
  volume->geometry = testdata::make_geometry(grid);
  volume->modality = "CT";
  volume->unit = "HU";
  const testdata::AnalyticSource sphere(testdata::make_sphere(sphere_radius_mm), edge_mm);
  std::vector<std::int16_t> values;
  values.reserve(static_cast<std::size_t>(voxels) * voxels * voxels);
  for (int k = 0; k < voxels; ++k) {
    for (int j = 0; j < voxels; ++j) {
      for (int i = 0; i < voxels; ++i) {
        const double value = sphere.sample(volume->geometry.to_patient({i, j, k}), io::FieldSet::value).value;
        values.push_back(static_cast<std::int16_t>(std::lround(value)));
      }
    }
  }
  volume->voxels = std::move(values);
  return volume;
}

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

double angle_between(const dvec3& a, const dvec3& b) {
  return degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// A probe that is moved, in patient space.
class Probe {
 public:
  explicit Probe(int voxels)
      : scene_(modes::scene_from_json(R"({"version": 1, "modes": [{"type": "surface",
              "strength_n": {"of": "value", "nodes": [[-490, 0], [-470, 3]]}}]})",
                                      "sphere")),
        volume_(soft_sphere(voxels)),
        plan_(modes::make_plan(scene_, io::FieldSet::value | io::FieldSet::gradient, {})),
        fields_(volume_, plan_.fields, io::default_gradient_scale_mm(volume_->geometry)) {}

  void move_to(const dvec3& at_mm) {
    const dvec3 probe_m = plan_.workspace.to_device(at_mm);
    const std::uint64_t begun = modes::clock_count();
    modes::step(plan_, fields_, probe_m, touch_, chain_, *scratch_);
    us_.push_back(1e-3 * static_cast<double>(modes::clock_count() - begun) / modes::counts_per_ns());
  }
  /// Has the fields ready where a hand at 1 kHz would find them ready; this one is faster than any.
  void prepare(const dvec3& at_mm) { fields_.prepare(at_mm, 3); }
  /// Out of the hand: the next place is come to from nowhere, not through the sphere.
  void lift() { touch_ = {}; }
  dvec3 proxy_mm() const { return plan_.workspace.to_patient(touch_.proxy_m); }
  dvec3 force_n() const { return plan_.workspace.direction_to_patient(touch_.force_n); }
  std::vector<double> take_us() { return std::exchange(us_, {}); }

 private:
  modes::Scene scene_;
  std::shared_ptr<const io::Volume> volume_;
  modes::Plan plan_;
  io::VolumeFields fields_;
  modes::Touch touch_;
  solver::Chain chain_;
  std::unique_ptr<modes::StepScratch> scratch_ = std::make_unique<modes::StepScratch>();
  std::vector<double> us_;
};

/// Jumps of the force in a tick while the probe is at rest.
void rest(Probe& probe, const dvec3& at_mm, std::vector<double>& jumps_n) {
  dvec3 force = probe.force_n();
  for (int n = 0; n < 2000; ++n) {
    probe.move_to(at_mm);
    jumps_n.push_back(glm::length(probe.force_n() - force));
    force = probe.force_n();
  }
}

/// Along three great circles.
void slide_and_rest(Probe& probe, SphereFigures& figures) {
  std::vector<double> errors_deg, jumps_n, felt_mm;
  const dvec3 starts[] = {{0.2, 0.5, 0.9}, {1, 0, 0}, {-0.5, 0.4, 0.3}};
  for (const dvec3& start : starts) {
    const dvec3 a = glm::normalize(start);
    const dvec3 b = glm::normalize(glm::cross(a, dvec3(0.7, -0.1, 0.4)));
    for (int n = 0; n < 200; ++n) {
      const double angle = 2 * std::numbers::pi / 200 * n;
      probe.prepare(sphere_radius_mm * (std::cos(angle) * a + std::sin(angle) * b));
    }
    for (double r = sphere_radius_mm + 5; r > sphere_radius_mm; r -= 2) probe.prepare(r * a);
    // Felt: where the proxy stays on the way in.
    for (double r = sphere_radius_mm + 5; r > sphere_radius_mm - sphere_depth_mm; r -= sphere_step_mm)
      probe.move_to(r * a);
    const double felt = glm::length(probe.proxy_mm());
    felt_mm.push_back(felt);
    const double pressed = felt - sphere_depth_mm;
    for (double r = sphere_radius_mm - sphere_depth_mm; r > pressed; r -= sphere_step_mm) probe.move_to(r * a);
    const double turn = sphere_step_mm / pressed;
    const auto steps = static_cast<int>(2 * std::numbers::pi / turn);
    for (int n = 1; n <= steps; ++n) {
      const dvec3 at = pressed * (std::cos(turn * n) * a + std::sin(turn * n) * b);
      probe.move_to(at);
      const double error = angle_between(probe.force_n(), probe.proxy_mm());
      errors_deg.push_back(error);
      figures.direction_worst_deg =
          std::max(figures.direction_worst_deg, error - degrees(sphere_step_mm / sphere_radius_mm));
    }
    rest(probe, pressed * (std::cos(turn * steps) * a + std::sin(turn * steps) * b), jumps_n);
    probe.lift();
  }
  const Percentiles us = percentiles_of(probe.take_us());
  figures.felt_radius_mm = felt_mm.front();
  figures.direction_median_deg = percentiles_of(std::move(errors_deg)).median;
  figures.rest_jump_p99_n = percentiles_of(std::move(jumps_n)).p99;
  figures.tick_median_us = us.median;
  figures.tick_p999_us = us.p999;
}

}  // namespace

SphereFigures study_sphere(int voxels) {
  Probe probe(voxels);
  SphereFigures figures{.voxels = voxels};
  run_as_servo([&] { slide_and_rest(probe, figures); });
  return figures;
}

std::string run_sphere_study() {
  fmt::print(
      "A sphere of 5 cm with a Gaussian edge of 1 mm, k = 400 N/m, slid at 50 mm/s, 2 mm deep from the felt surface\n\n"
      "{:<22} {:>12} {:>14} {:>22} {:>16} {:>10} {:>10}\n",
      "", "felt at, mm", "direction, deg", "worst beyond v dt / R", "rest p99, N/ms", "tick, us", "p99.9, us");
  std::string csv =
      "voxels,felt_radius_mm,direction_median_deg,direction_worst_beyond_lag_deg,rest_jump_p99_n,tick_median_us,"
      "tick_p999_us\n";
  for (const int voxels : {128, 256}) {
    const SphereFigures f = study_sphere(voxels);
    fmt::print("{:<22} {:>12.2f} {:>14.3f} {:>22.3f} {:>16.6f} {:>10.2f} {:>10.2f}\n",
               fmt::format("Palpate, {}^3", voxels), f.felt_radius_mm, f.direction_median_deg, f.direction_worst_deg,
               f.rest_jump_p99_n, f.tick_median_us, f.tick_p999_us);
    csv += fmt::format("{},{},{},{},{},{},{}\n", voxels, f.felt_radius_mm, f.direction_median_deg,
                       f.direction_worst_deg, f.rest_jump_p99_n, f.tick_median_us, f.tick_p999_us);
  }
  fmt::print(
      "{:<22} {:>12} {:>14} {:>22} {:>16} {:>10}\n{:<22} {:>12} {:>14} {:>22} {:>16} {:>10}\n"
      "(CHAI3D's voxel haptics: measured elsewhere, not run here)\n",
      "CHAI3D, 128^3", "", "22", "", "0.34 to 0.47", "4.8", "CHAI3D, 256^3", "", "15", "", "0.34 to 0.47", "8.4");
  return csv;
}

}  // namespace palpate::plugin
