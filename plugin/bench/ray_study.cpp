#include "plugin/bench/ray_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <vector>

#include "io/bounding_box.h"
#include "io/fields/volume_fields.h"
#include "io/quantile.h"
#include "modes/scene/defaults.h"
#include "modes/scene/suggest.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/stroke.h"

namespace palpate::plugin {
namespace {

using glm::dvec3;

constexpr int rays_of_scan = 20;
constexpr double floor_hu = 200, least_peak_hu = 300, least_bone_hu = 150, least_width_mm = 0.5, ray_step_mm = 0.1,
                 near_mm = 2, felt_n = 0.25;
constexpr double thin_mm = 3, faint_hu = 600;

struct Passage {
  double from_mm = 0, to_mm = 0, peak_hu = 0;  // depth along the ray
};

std::vector<Passage> passages_of(const io::VolumeFields& values, const dvec3& from, const dvec3& to) {
  std::vector<Passage> passages;
  const double length = glm::distance(from, to);
  bool inside = false;
  for (double depth = 0; depth <= length; depth += ray_step_mm) {
    const io::Sample sample = values.sample(from + depth / length * (to - from), io::FieldSet::value);
    const bool now = sample.inside && sample.value > floor_hu;
    if (now && !inside) passages.push_back({.from_mm = depth, .to_mm = depth, .peak_hu = sample.value});
    if (now) {
      passages.back().to_mm = depth;
      passages.back().peak_hu = std::max(passages.back().peak_hu, sample.value);
    }
    inside = now;
  }
  std::erase_if(passages,
                [](const Passage& p) { return p.peak_hu < least_peak_hu || p.to_mm - p.from_mm < least_width_mm; });
  return passages;
}

struct Kind {
  const char* name;
  bool (*is)(const Passage&);
  int there = 0, met = 0;
  std::vector<double> parts;  // of the full strength
};

struct Ray {
  dvec3 from{0}, to{0};
};

/// From the sides of the box to its middle, along the points of a Fibonacci sphere.
Ray ray_of(int n, const io::Box& box) {
  const dvec3 middle = 0.5 * (box.low + box.high);
  const double height = 1 - 2 * (n + 0.5) / rays_of_scan, turn = std::numbers::pi * (3 - std::sqrt(5.0)) * n;
  const double across = std::sqrt(1 - height * height);
  const dvec3 even(across * std::cos(turn), across * std::sin(turn), height);
  const dvec3 direction = even * (box.high - box.low);  // a slab is entered from its sides
  double reach = 1e9;                                   // to the box
  for (int axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * (box.high - box.low)[axis];
    if (direction[axis] != 0) reach = std::min(reach, half / std::abs(direction[axis]));
  }
  return {middle + 0.999 * reach * direction, middle};
}

bool is_to_bone(const modes::Suggestion& suggestion, std::size_t mode) {
  return std::ranges::any_of(suggestion.boundaries, [&](const modes::FoundBoundary& b) {
    return b.mode == mode && suggestion.typical[b.high] > least_bone_hu;
  });
}

struct Felt {
  double part = 0;   // of the full strength, at most 1
  bool met = false;  // a boundary to bone held the proxy
};

Felt felt_in(const Passage& passage, const std::vector<StrokePoint>& stroke, const dvec3& from,
             const PreparedScene& scene, const modes::Suggestion& suggestion) {
  Felt felt;
  double most_n = 0;
  for (const StrokePoint& point : stroke) {
    const double depth = glm::distance(point.proxy_mm, from);
    if (depth < passage.from_mm - near_mm || depth > passage.to_mm + near_mm) continue;
    const io::Sample sample = scene.source->sample(point.proxy_mm, scene.plan->fields);
    double newtons = 0;  // of all boundaries to bone together: two kinds of bone share a place between them
    for (const modes::ActiveMode& mode : scene.plan->modes) {
      if (sample.inside && is_to_bone(suggestion, mode.scene_index)) newtons += mode.strength(sample);
    }
    most_n = std::max(most_n, newtons);
    felt.met =
        felt.met || (point.boundary && is_to_bone(suggestion, *point.boundary) && glm::length(point.force_n) > felt_n);
  }
  felt.part = std::min(1.0, most_n / modes::defaults::bone_strength_n);
  return felt;
}

void add(const Felt& felt, const Passage& passage, std::vector<Kind>& kinds) {
  for (Kind& kind : kinds) {
    if (!kind.is(passage)) continue;
    ++kind.there;
    kind.met += felt.met;
    kind.parts.push_back(felt.part);
  }
}

/// `crossings`: of each mode of the scene.
void print(const std::string& name, const modes::Suggestion& suggestion, const std::vector<std::size_t>& crossings,
           const std::vector<Kind>& kinds) {
  fmt::print("{}: {} crossings on {} rays\n", name, std::accumulate(crossings.begin(), crossings.end(), std::size_t{0}),
             rays_of_scan);
  for (const modes::FoundBoundary& boundary : suggestion.boundaries) {
    fmt::print("  {:<36} {:>4}\n", suggestion.scene.modes[boundary.mode].name, crossings[boundary.mode]);
  }
  for (const Kind& kind : kinds) {
    if (kind.there == 0) continue;
    fmt::print(
        "  {:<6} bone: {:>3} of {:>3} passages felt, with {:.2f} of the strength in the median, {:.2f} at the 10th "
        "percentile\n",
        kind.name, kind.met, kind.there, io::quantile(kind.parts, 0.5), io::quantile(kind.parts, 0.1));
  }
}

}  // namespace

void run_ray_study(const std::string& name, const std::shared_ptr<const io::Volume>& volume) {
  const modes::Suggestion suggestion = modes::suggest(volume);
  const PreparedScene scene = prepare(suggestion.scene, volume, dvec3(0.1));
  const io::VolumeFields values(volume, io::FieldSet::value, 1);
  std::vector<Kind> kinds{{"thin", [](const Passage& p) { return p.to_mm - p.from_mm < thin_mm; }, 0, 0, {}},
                          {"faint", [](const Passage& p) { return p.peak_hu < faint_hu; }, 0, 0, {}},
                          {"all", [](const Passage&) { return true; }, 0, 0, {}}};
  const io::Box box = io::bounding_box(volume->geometry);
  std::vector<std::size_t> crossings(suggestion.scene.modes.size());
  for (int n = 0; n < rays_of_scan; ++n) {
    const Ray ray = ray_of(n, box);
    const auto stroke = run_stroke(*scene.plan, *scene.source, ray.from, ray.to, 100);
    for (const Contact& contact : contacts_of(stroke, *scene.plan, met_n)) ++crossings[contact.boundary];
    if (volume->unit != "HU") continue;
    for (const Passage& passage : passages_of(values, ray.from, ray.to)) {
      add(felt_in(passage, stroke, ray.from, scene, suggestion), passage, kinds);
    }
  }
  print(name, suggestion, crossings, kinds);
}

}  // namespace palpate::plugin
