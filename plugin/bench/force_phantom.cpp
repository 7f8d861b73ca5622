#include "plugin/bench/force_phantom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "io/fields/filtered.h"
#include "modes/scene/scene_json.h"
#include "testdata/analytic.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using glm::dvec3;

constexpr double liver_hu = 120, vessel_hu = 300, cortex_hu = 700, marrow_hu = 150;
constexpr double noise_of_filters_hu = 40, noise_of_solvers_hu = 20;
const testdata::Ball skin_ball{{0.3, -0.2, 0.1}, 46};
const testdata::Ball muscle_ball{{0.3, -0.2, 0.1}, 40};
const testdata::Ball liver_ball{{15, -6, 4}, 14};
const testdata::Ball lung_ball{{-15, -8, -3}, 13};
const testdata::Ball cortex_ball{{-2, 18, 2}, 10};
const testdata::Ball marrow_ball{{-2, 18, 2}, 7.5};
const testdata::Ball vessel_ball{{2, -20, -14}, 5};

/// Each boundary at the middle of the values that it parts.
constexpr const char* middles = R"([
  {"type": "surface", "name": "skin", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1.0]]},
   "gates": [{"of": "value", "nodes": [[-555, 0], [-535, 1], [-130, 1], [-110, 0]]}]},
  {"type": "surface", "name": "muscle in fat", "strength_n": {"of": "gradient_per_mm", "nodes": [[5, 0], [12, 0.7]]},
   "gates": [{"of": "value", "nodes": [[-30, 0], [-20, 1], [55, 1], [65, 0]]}]},
  {"type": "surface", "name": "liver", "strength_n": {"of": "gradient_per_mm", "nodes": [[4, 0], [8, 0.7]]},
   "gates": [{"of": "value", "nodes": [[78, 0], [82, 1], [135, 1], [145, 0]]}]},
  {"type": "surface", "name": "vessel", "strength_n": {"of": "gradient_per_mm", "nodes": [[10, 0], [20, 0.7]]},
   "gates": [{"of": "value", "nodes": [[165, 0], [175, 1], [310, 1], [330, 0]]}]},
  {"type": "surface", "name": "bone", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 2.5]]},
   "gates": [{"of": "value", "nodes": [[360, 0], [380, 1]]}]},
  {"type": "surface", "name": "lung", "side": "leaving",
   "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1.0]]},
   "gates": [{"of": "value", "nodes": [[-415, 1], [-395, 0]]}]},
  {"type": "friction", "name": "friction", "strength_n": {"of": "value", "nodes": [[-555, 0], [-535, 0.1]]}}])";

modes::Scene scene_with(const std::string& more) {
  return modes::scene_from_json(
      fmt::format(R"({{"version": 1, "name": "torso"{}, "modes": {}}})", more.empty() ? "" : ", " + more, middles),
      "palpate-bench forces");
}

/// The phantom's value, and its gradient at the scale that a scan of 1 mm has.
class ExactFields final : public io::FieldSource {
 public:
  ExactFields() : values_(make_torso(), edge_mm), gradients_(make_torso(), gradient_mm) {}
  io::FieldSet available() const noexcept override { return io::FieldSet::value | io::FieldSet::gradient; }
  io::Sample sample(const io::Vec3& at, io::FieldSet wanted) const noexcept override {
    io::Sample sample = values_.sample(at, wanted & io::FieldSet::value);
    if (contains(wanted, io::FieldSet::gradient)) {
      sample.gradient = gradients_.sample(at, io::FieldSet::gradient).gradient;
    }
    return sample;
  }

 private:
  // Width of the value's edges: near that of voxels of 1 mm, so that strengths rise over the same distance.
  static constexpr double edge_mm = 0.6, gradient_mm = 2.0;
  testdata::AnalyticSource values_, gradients_;
};

FeltScene felt_exactly(const modes::Scene& scene) {
  FeltScene felt{.scene = scene, .on = {}, .has_known = false};
  felt.on.source = std::make_shared<ExactFields>();
  felt.on.plan =
      std::make_shared<const modes::Plan>(modes::make_plan(scene, felt.on.source->available(), modes::Workspace{}));
  return felt;
}

struct Scanned {
  std::string name;
  double noise_hu = 0, blur_mm = 0, slices_mm = 1, tilt_degrees = 0;
};

std::shared_ptr<const io::Volume> scan_of(const Scanned& how, std::uint64_t seed) {
  constexpr double edge_mm = 116;
  const double lean = how.tilt_degrees > 0 ? 40 : 0;  // tilted slices shift against each other
  testdata::Grid grid{.size = glm::ivec3(116, static_cast<int>(edge_mm + lean),
                                         static_cast<int>(std::ceil((edge_mm + lean) / how.slices_mm))),
                      .spacing = {1, 1, how.slices_mm},
                      .tilt_degrees = how.tilt_degrees};
  grid = testdata::rotated(grid, glm::normalize(dvec3(1, 2, 0.5)), 23);  // no boundary lies along the voxels
  const io::Geometry geometry = testdata::make_geometry(grid);
  if (how.blur_mm == 0) {
    return std::make_shared<const io::Volume>(
        testdata::scan(make_torso(), geometry, {.noise = how.noise_hu, .seed = seed}));
  }
  const auto sharp = std::make_shared<const io::Volume>(testdata::scan(make_torso(), geometry, {.quantised = false}));
  io::Volume volume = *io::filtered(sharp, {.type = io::find_filter_type("gaussian"), .sigma_mm = how.blur_mm});
  volume.filtered_from = nullptr;  // it is the scanner's blur, of which nobody is told
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal(0, 1);
  for (float& value : std::get<std::vector<float>>(volume.voxels)) {
    value += static_cast<float>(how.noise_hu) * normal(random);
  }
  return std::make_shared<const io::Volume>(std::move(volume));
}

ForceRow row_of(const Scanned& how, const modes::Scene& scene, std::uint64_t seed) {
  return {how.name, [=](const io::Progress& progress) { return felt_on_scan(scene, scan_of(how, seed), progress); }};
}

PathTarget target_in(const std::string& name, const testdata::Ball& ball, double inner_mm = 0) {
  return {name,
          [=](std::mt19937_64& random) {
            std::normal_distribution<double> any;
            std::uniform_real_distribution<double> even(0, 1);
            const double x = any(random), y = any(random), z = any(random);
            const double inner = inner_mm * inner_mm * inner_mm, outer = ball.radius * ball.radius * ball.radius;
            return ball.center + std::cbrt(inner + even(random) * (outer - inner)) * glm::normalize(dvec3(x, y, z));
          },
          name == "bone"};
}

double inside_mm(const testdata::Ball& ball, const dvec3& place) {
  return ball.radius - glm::distance(ball.center, place);
}

PathWorld torso_world() {
  PathWorld world;
  world.targets = {target_in("liver", liver_ball), target_in("lung", lung_ball),
                   target_in("bone", cortex_ball, marrow_ball.radius), target_in("vessel", vessel_ball)};
  world.is_outside = [](const dvec3& at) { return inside_mm(skin_ball, at) < 0; };
  world.is_bone = [](const dvec3& at) { return inside_mm(cortex_ball, at) > 0; };
  world.is_known = [](const dvec3&) { return true; };
  return world;
}

ForceGroup group_of(std::string name, std::string against, const modes::Scene& scene) {
  return {.name = std::move(name),
          .against = std::move(against),
          .world = torso_world(),
          .truth = [=](const io::Progress&) { return felt_exactly(scene); },
          .off_mm = torso_surface_mm,
          .rows = {}};
}

ForceGroup scans(std::uint64_t seed) {
  const modes::Scene scene = scene_with("");
  ForceGroup group = group_of("scan of a phantom", "the phantom itself", scene);
  for (const Scanned& how : {Scanned{"1 mm, no noise"},
                             {"1 mm, noise 10 HU", 10},
                             {"1 mm, noise 20 HU", 20},
                             {"1 mm, noise 40 HU", 40},
                             {"1 mm, noise 20 HU, blur 0.7 mm", 20, 0.7},
                             {"1 mm, noise 20 HU, blur 1.2 mm", 20, 1.2},
                             {"slices of 3 mm, noise 10 HU", 10, 0, 3},
                             {"slices of 5 mm, noise 10 HU", 10, 0, 5},
                             {"1 mm, tilt 20 degrees, noise 20 HU", 20, 0, 1, 20},
                             {"slices of 3 mm, tilt 20 degrees, noise 10 HU", 10, 0, 3, 20}}) {
    group.rows.push_back(row_of(how, scene, seed));
  }
  for (const auto& [name, sampling] : {std::pair{"trilinear values", R"("sampling": {"value": "trilinear"})"},
                                       {"central differences", R"("sampling": {"gradient": "central_differences"})"},
                                       {"gradient of the cubic value", R"("sampling": {"gradient": "cubic"})"}}) {
    group.rows.push_back(
        row_of({fmt::format("1 mm, noise 20 HU, {}", name), noise_of_solvers_hu}, scene_with(sampling), seed));
  }
  return group;
}

/// A boundary that is felt at a value which is not the middle of its two tissues.
ForceGroup starting_scene(std::uint64_t seed) {
  const modes::Scene scene = modes::load_scene("ct-abdomen");
  ForceGroup group = group_of("starting scene, ct-abdomen", "the phantom itself", scene);
  for (const Scanned& how : {Scanned{"1 mm, noise 20 HU", 20},
                             {"slices of 3 mm, noise 10 HU", 10, 0, 3},
                             {"slices of 5 mm, noise 10 HU", 10, 0, 5}}) {
    group.rows.push_back(row_of(how, scene, seed));
  }
  return group;
}

ForceGroup filters(std::uint64_t seed) {
  ForceGroup group = group_of("filters, 1 mm, noise 40 HU", "the phantom itself", scene_with(""));
  const Scanned how{"", noise_of_filters_hu};
  for (const auto& [name, filter] :
       {std::pair{"no filter", R"({"type": "none"})"},
        {"Gaussian of 1 mm", R"({"type": "gaussian", "sigma_mm": 1})"},
        {"median of 3 voxels", R"({"type": "median", "width": 3})"},
        {"bilateral of 1.5 mm, 80 HU", R"({"type": "bilateral", "sigma_mm": 1.5, "sigma_value": 80})"},
        {"non-local means, 40 HU", R"({"type": "non_local_means", "sigma_value": 40})"}}) {
    Scanned named = how;
    named.name = name;
    group.rows.push_back(row_of(named, scene_with(fmt::format(R"("filter": {})", filter)), seed));
  }
  return group;
}

/// The effect of solver and sub-steps alone, on one scan.
ForceGroup solvers(std::uint64_t seed) {
  constexpr double fast_mm_per_s = 400;  // 0.4 mm a tick: four sub-steps
  const Scanned how{"", noise_of_solvers_hu};
  ForceGroup group = group_of("solvers, 400 mm/s", "the exact solver with sub-steps on the same scan", scene_with(""));
  group.speed_mm_per_s = fast_mm_per_s;
  group.off_mm = {};  // the scan's errors are in the truth, too
  group.truth = [=](const io::Progress& progress) {
    return felt_on_scan(scene_with(R"("solvers": {"analytical": false, "exact": true})"), scan_of(how, seed), progress);
  };
  for (const auto& [name, more] :
       {std::pair{"as usual: analytical, then exact", ""},
        {"descent", R"("solvers": {"analytical": false, "exact": false, "descent": true})"},
        {"analytical alone", R"("solvers": {"analytical": true, "exact": false})"},
        {"no sub-steps", R"("subdivision": {"most": 1})"},
        {"no sub-steps, no halts: one step a tick", R"("subdivision": {"most": 1, "most_halts": 0})"}}) {
    Scanned named = how;
    named.name = name;
    group.rows.push_back(row_of(named, scene_with(more), seed));
  }
  return group;
}

}  // namespace

testdata::Phantom make_torso() {
  return {testdata::air_hu,
          {{skin_ball, testdata::fat_hu},
           {muscle_ball, testdata::soft_tissue_hu},
           {liver_ball, liver_hu},
           {lung_ball, testdata::lung_hu},
           {cortex_ball, cortex_hu},
           {marrow_ball, marrow_hu},
           {vessel_ball, vessel_hu}}};
}

double torso_surface_mm(const dvec3& place_mm) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const testdata::Body& body : make_torso().bodies) {
    nearest = std::min(nearest, std::abs(testdata::distance_to(body.shape, place_mm).signed_mm));
  }
  return nearest;
}

std::vector<ForceGroup> phantom_groups(std::uint64_t seed) {
  return {scans(seed), starting_scene(seed), filters(seed), solvers(seed)};
}

}  // namespace palpate::plugin
