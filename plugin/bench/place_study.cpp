#include "plugin/bench/place_study.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "io/fields/boundary_uncertainty.h"
#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene_json.h"
#include "modes/tick/haptic_step.h"
#include "plugin/bench/tick_study.h"
#include "plugin/report/summary.h"
#include "solver/chain.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using glm::dvec3;

constexpr double place_radius_mm = 20, place_depth_mm = 1, place_noise_hu = 20;
constexpr double travel_mm = 0.5;  // of the probe in a tick: fast enough that sub-steps matter
constexpr int circles = 6;

struct PlaceRow {
  double off_rms_mm = 0, stated_mm = 0;
  Percentiles us;
};

PlaceRow slide_around(const std::shared_ptr<const io::Volume>& raw, const modes::Scene& scene) {
  const auto volume = io::filtered(raw, scene.filter);
  const modes::Plan plan = modes::make_plan(scene, io::FieldSet::value | io::FieldSet::gradient, {});
  const io::VolumeFields fields(volume, plan.fields, io::default_gradient_scale_mm(volume->geometry),
                                modes::field_options(scene.sampling));
  const io::ValueMethod method =
      scene.sampling.gradient == io::GradientMethod::cubic ? io::ValueMethod::cubic : scene.sampling.value;
  solver::Chain chain;
  const auto scratch = std::make_unique<modes::StepScratch>();
  std::vector<double> us;
  double squares = 0, stated = 0, count = 0, stated_count = 0;
  for (int circle = 0; circle < circles; ++circle) {
    const dvec3 a = glm::normalize(dvec3(1, 0.3 * circle - 0.7, 0.5));
    const dvec3 b = glm::normalize(glm::cross(a, dvec3(0.2, 0.7, -0.1 * circle)));
    modes::Touch touch;
    const auto move_to = [&](const dvec3& at_mm) {
      fields.prepare(at_mm, 3);
      const dvec3 probe_m = plan.workspace.to_device(at_mm);
      const std::uint64_t begun = modes::clock_count();
      modes::step(plan, fields, probe_m, touch, chain, *scratch);
      us.push_back(1e-3 * static_cast<double>(modes::clock_count() - begun) / modes::counts_per_ns());
    };
    for (double r = place_radius_mm + 3; r > place_radius_mm - place_depth_mm; r -= 0.05) move_to(r * a);
    const double turn = travel_mm / place_radius_mm;
    for (int n = 0; n * turn < 2 * std::numbers::pi; ++n) {
      move_to((place_radius_mm - place_depth_mm) * (std::cos(turn * n) * a + std::sin(turn * n) * b));
      const dvec3 proxy = plan.workspace.to_patient(touch.proxy_m);
      const double off = glm::length(proxy) - place_radius_mm;
      squares += off * off;
      count += 1;
      if (n % 8 != 0) continue;
      const double known = io::uncertainty_at(fields, volume->geometry, method, proxy, scene.filter).two_sigma_mm;
      if (!std::isfinite(known)) continue;
      stated += known;
      stated_count += 1;
    }
  }
  return {.off_rms_mm = std::sqrt(squares / count),
          .stated_mm = stated / stated_count,
          .us = percentiles_of(std::move(us))};
}

}  // namespace

std::string run_place_study() {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(place_radius_mm), testdata::make_geometry({.size = glm::ivec3(56)}),
                     {.noise = place_noise_hu, .seed = 11}));
  fmt::print("A ball of {} mm in voxels of 1 mm, {} HU of noise, slid along {} mm deep, {} mm a tick\n\n",
             place_radius_mm, place_noise_hu, place_depth_mm, travel_mm);
  fmt::print("{:<10} {:<20} {:>12} {:>14} {:>18} {:>12} {:>10}  {}\n", "value", "gradient", "sub-step, mm",
             "off, rms, mm", "stated 2 sigma, mm", "tick, us", "p99.9, us", "filter");
  std::string csv = "value,gradient,sub_step_mm,off_rms_mm,stated_two_sigma_mm,tick_median_us,tick_p999_us,filter\n";
  const auto add_row = [&](const char* value, const char* gradient, double step_mm, const char* filter) {
    const modes::Scene scene =
        modes::scene_from_json(fmt::format(R"({{"version": 1, "sampling": {{"value": "{}", "gradient": "{}"}},
          "subdivision": {{"step_mm": {}}}, "filter": {}, "modes": [{{"type": "surface",
          "strength_n": {{"of": "value", "nodes": [[-490, 0], [-470, 3]]}}}}]}})",
                                           value, gradient, step_mm, filter),
                               "place");
    const PlaceRow row = slide_around(volume, scene);
    const std::string words = io::in_words(scene.filter);
    fmt::print("{:<10} {:<20} {:>12} {:>14.3f} {:>18.3f} {:>12.2f} {:>10.2f}  {}\n", value, gradient, step_mm,
               row.off_rms_mm, row.stated_mm, row.us.median, row.us.p999, words);
    csv += fmt::format("{},{},{},{},{},{},{},{}\n", value, gradient, step_mm, row.off_rms_mm, row.stated_mm,
                       row.us.median, row.us.p999, words);
  };
  run_as_servo([&] {
    for (const char* value : {"cubic", "trilinear"}) {
      for (const char* gradient : {"gaussian", "central_differences", "cubic"}) {
        for (const double step_mm : {2.0, 0.5, 0.1}) add_row(value, gradient, step_mm, R"({"type": "none"})");
      }
    }
    for (const char* filter : {R"({"type": "gaussian", "sigma_mm": 1})", R"({"type": "median", "width": 3})",
                               R"({"type": "bilateral", "sigma_mm": 1.5, "sigma_value": 40})",
                               R"({"type": "non_local_means", "sigma_value": 20})"}) {
      for (const char* gradient : {"gaussian", "central_differences"}) add_row("cubic", gradient, 0.5, filter);
    }
  });
  return csv;
}

}  // namespace palpate::plugin
