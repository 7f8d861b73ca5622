#include "plugin/bench/filter_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene_json.h"
#include "modes/tick/haptic_step.h"
#include "solver/chain.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using glm::dvec3;

constexpr double filter_noise_hu = 60, wall_press_mm = 1, ball_radius_mm = 12, path_step_mm = 0.025;
const dvec3 outward = glm::normalize(dvec3(0.3, 0.5, 0.8));

std::shared_ptr<const io::Volume> scan_of(const testdata::Shape& shape, int size) {
  testdata::Phantom phantom;
  phantom.background = testdata::air_hu;
  phantom.bodies = {{shape, testdata::soft_tissue_hu}};
  return std::make_shared<const io::Volume>(testdata::scan(phantom, testdata::make_geometry({.size = glm::ivec3(size)}),
                                                           {.noise = filter_noise_hu, .seed = 5}));
}

struct FilteredSlide {
  double roughness_n = 0;  // rms of the force's difference from its mean, where the wall is flat
  double off_mm = 0;       // mean place of the proxy outside of the true surface
};

/// The probe goes along a path in steps of 0.025 mm; `outside` says how far a place is from the true surface, and
/// `normal` where that looks.
template <typename Path, typename Outside, typename Normal>
FilteredSlide slide_over(const std::shared_ptr<const io::Volume>& volume, int steps, const Path& path,
                         const Outside& outside, const Normal& normal) {
  static const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "strength_n": {"of": "value", "nodes": [[-490, 0], [-470, 3]]}}]})",
      "filters");
  const modes::Plan plan = modes::make_plan(scene, io::FieldSet::value | io::FieldSet::gradient, {});
  const io::VolumeFields fields(volume, plan.fields, io::default_gradient_scale_mm(volume->geometry),
                                modes::field_options(scene.sampling));
  solver::Chain chain;
  const auto scratch = std::make_unique<modes::StepScratch>();
  modes::Touch touch;
  const auto move_to = [&](const dvec3& at_mm) {
    fields.prepare(at_mm, 3);
    return modes::step(plan, fields, plan.workspace.to_device(at_mm), touch, chain, *scratch);
  };
  const dvec3 begin = path(0);
  for (double away = 4; away > 0; away -= path_step_mm) move_to(begin + away * normal(begin));
  dvec3 sum(0);
  double squares = 0, off = 0;
  for (int n = 0; n < steps; ++n) {
    const dvec3 at = path(n);
    const modes::StepResult result = move_to(at);
    const dvec3 force_n = plan.workspace.direction_to_patient(result.force_n);
    sum += force_n;
    squares += glm::dot(force_n, force_n);
    off += outside(plan.workspace.to_patient(result.proxy_m));
  }
  const dvec3 mean = sum / static_cast<double>(steps);
  return {.roughness_n = std::sqrt(std::max(0.0, squares / steps - glm::dot(mean, mean))), .off_mm = off / steps};
}

FilteredSlide on_wall(const std::shared_ptr<const io::Volume>& volume) {
  const dvec3 along = glm::normalize(glm::cross(outward, dvec3(0.1, 1, 0.2)));
  constexpr int steps = 1000, middle = steps / 2;
  return slide_over(
      volume, steps, [&](int n) { return (n - middle) * path_step_mm * along - wall_press_mm * outward; },
      [](const dvec3& p) { return glm::dot(p, outward); }, [](const dvec3&) { return outward; });
}

FilteredSlide on_ball(const std::shared_ptr<const io::Volume>& volume) {
  const dvec3 a = glm::normalize(dvec3(1, 0.4, 0.5)), b = glm::normalize(glm::cross(a, dvec3(0.2, 0.7, -0.3)));
  return slide_over(
      volume, 2500,
      [&](int n) {
        const double turn = path_step_mm / ball_radius_mm * n;
        return (ball_radius_mm - wall_press_mm) * (std::cos(turn) * a + std::sin(turn) * b);
      },
      [](const dvec3& p) { return glm::length(p) - ball_radius_mm; }, [](const dvec3& p) { return glm::normalize(p); });
}

double seconds_to_filter(const std::shared_ptr<const io::Volume>& volume, const io::Filter& filter) {
  const auto begun = std::chrono::steady_clock::now();
  (void)io::filtered(volume, filter);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

}  // namespace

std::string run_filter_study() {
  const std::array filters{
      io::Filter{},
      io::Filter{.type = io::find_filter_type("gaussian"), .sigma_mm = 0.7},
      io::Filter{.type = io::find_filter_type("gaussian"), .sigma_mm = 1.5},
      io::Filter{.type = io::find_filter_type("median"), .width = 3},
      io::Filter{.type = io::find_filter_type("median"), .width = 5},
      io::Filter{.type = io::find_filter_type("bilateral"), .sigma_mm = 1.5, .sigma_value = 2 * filter_noise_hu},
      io::Filter{.type = io::find_filter_type("non_local_means"), .sigma_value = filter_noise_hu}};
  const auto wall = scan_of(testdata::HalfSpace{outward, 0}, 48);
  const auto ball = scan_of(testdata::Ball{{0, 0, 0}, ball_radius_mm}, 40);
  const auto large = scan_of(testdata::Ball{{0, 0, 0}, 100}, 256);
  fmt::print(
      "A wall and a ball of {} mm in voxels of 1 mm, {} HU of noise, slid along {} mm deep; time for 256^3 voxels\n\n",
      ball_radius_mm, filter_noise_hu, wall_press_mm);
  fmt::print("{:<36} {:>13} {:>15} {:>15} {:>9} {:>10}\n", "filter", "roughness, N", "wall shifts, mm",
             "ball shifts, mm", "time, s", "ns a voxel");
  std::string csv = "filter,roughness_n,wall_shift_mm,ball_shift_mm,seconds,ns_a_voxel\n";
  for (const io::Filter& filter : filters) {
    const FilteredSlide flat = on_wall(io::filtered(wall, filter));
    const FilteredSlide round = on_ball(io::filtered(ball, filter));
    const double seconds = filter.type == nullptr ? 0 : seconds_to_filter(large, filter);
    const double ns = 1e9 * seconds / (256.0 * 256.0 * 256.0);
    fmt::print("{:<36} {:>13.3f} {:>15.3f} {:>15.3f} {:>9.2f} {:>10.0f}\n", io::in_words(filter), flat.roughness_n,
               flat.off_mm, round.off_mm, seconds, ns);
    csv += fmt::format("{},{},{},{},{},{}\n", io::in_words(filter), flat.roughness_n, flat.off_mm, round.off_mm,
                       seconds, ns);
  }
  return csv;
}

}  // namespace palpate::plugin
