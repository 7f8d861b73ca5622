#include "plugin/bench/ray_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "io/fields/volume_fields.h"
#include "io/quantile.h"
#include "modes/scene/defaults.h"
#include "modes/scene/suggest.h"
#include "plugin/session/scan.h"
#include "plugin/session/stroke.h"

namespace palpate::plugin {
namespace {

using glm::dvec3;

constexpr int rays = 20;
constexpr double floor_hu = 200, least_peak_hu = 300, least_bone_hu = 150, least_width_mm = 0.5, step_mm = 0.1,
                 near_mm = 2, felt_n = 0.25;
constexpr double thin_mm = 3, faint_hu = 600;

struct Passage {
  double from_mm = 0, to_mm = 0, peak_hu = 0;  // depth along the ray
};

std::vector<Passage> passages_of(const io::VolumeFields& values, const dvec3& from, const dvec3& to) {
  std::vector<Passage> passages;
  const double length = glm::distance(from, to);
  bool inside = false;
  for (double depth = 0; depth <= length; depth += step_mm) {
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

}  // namespace

void run_ray_study(const std::string& name, const std::shared_ptr<const io::Volume>& volume) {
  const modes::Suggestion suggestion = modes::suggest(volume);
  const PreparedScene felt = prepare(suggestion.scene, volume, dvec3(0.1));
  const io::VolumeFields values(volume, io::FieldSet::value, 1);
  std::vector<Kind> kinds{{"thin", [](const Passage& p) { return p.to_mm - p.from_mm < thin_mm; }, 0, 0, {}},
                          {"faint", [](const Passage& p) { return p.peak_hu < faint_hu; }, 0, 0, {}},
                          {"all", [](const Passage&) { return true; }, 0, 0, {}}};
  const auto is_to_bone = [&](std::size_t mode) {
    return std::ranges::any_of(suggestion.boundaries, [&](const modes::FoundBoundary& b) {
      return b.mode == mode && suggestion.typical[b.high] > least_bone_hu;
    });
  };
  const Box box = bounding_box(volume->geometry);
  const dvec3 middle = 0.5 * (box.low + box.high);
  std::size_t crossings = 0;
  for (int n = 0; n < rays; ++n) {
    // Points of a Fibonacci sphere.
    const double height = 1 - 2 * (n + 0.5) / rays, turn = std::numbers::pi * (3 - std::sqrt(5.0)) * n;
    const double across = std::sqrt(1 - height * height);
    const dvec3 even(across * std::cos(turn), across * std::sin(turn), height);
    const dvec3 direction = even * (box.high - box.low);  // a slab is entered from its sides
    double reach = 1e9;                                   // to the box
    for (int axis = 0; axis < 3; ++axis) {
      const double half = 0.5 * (box.high - box.low)[axis];
      if (direction[axis] != 0) reach = std::min(reach, half / std::abs(direction[axis]));
    }
    const dvec3 from = middle + 0.999 * reach * direction;
    const auto stroke = run_stroke(*felt.plan, *felt.source, from, middle, 100);
    crossings += contacts_of(stroke, *felt.plan, met_n).size();
    for (const Passage& passage : passages_of(values, from, middle)) {
      double most_n = 0;
      bool met = false;
      for (const StrokePoint& point : stroke) {
        const double depth = glm::distance(point.proxy_mm, from);
        if (depth < passage.from_mm - near_mm || depth > passage.to_mm + near_mm) continue;
        const io::Sample sample = felt.source->sample(point.proxy_mm, felt.plan->fields);
        double newtons = 0;  // of all boundaries to bone together: two kinds of bone share a place between them
        for (const modes::ActiveMode& mode : felt.plan->modes) {
          if (sample.inside && is_to_bone(mode.scene_index)) newtons += mode.strength(sample);
        }
        most_n = std::max(most_n, newtons);
        met = met || (point.boundary && is_to_bone(*point.boundary) && glm::length(point.force_n) > felt_n);
      }
      const double part = std::min(1.0, most_n / modes::defaults::bone_strength_n);
      for (Kind& kind : kinds) {
        if (!kind.is(passage)) continue;
        ++kind.there;
        kind.met += met;
        kind.parts.push_back(part);
      }
    }
  }
  fmt::print("{}: {} crossings on {} rays\n", name, crossings, rays);
  for (const Kind& kind : kinds) {
    if (kind.there == 0) continue;
    fmt::print(
        "  {:<6} bone: {:>3} of {:>3} passages felt, with {:.2f} of the strength in the median, {:.2f} at the 10th "
        "percentile\n",
        kind.name, kind.met, kind.there, io::quantile(kind.parts, 0.5), io::quantile(kind.parts, 0.1));
  }
}

}  // namespace palpate::plugin
